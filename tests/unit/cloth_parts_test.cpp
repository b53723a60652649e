// Cutting a cloth into parts: every node is in one leaf of bounded size, and adjacent groups share no node.
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <vector>

#include "bullet_plugin/core/solver/topology/cloth_parts.h"
#include "kernels/lib/geometry/vec3.h"
#include "scenes/cloth_grid.h"
#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
std::vector<Vec3> placesOf(const TriangleMesh& mesh)
{
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < mesh.vertexCount(); ++i)
        places.push_back(vec3Load(mesh.m_positions.data(), std::uint32_t(i)));
    return places;
}

// Returns true if the group is the other one or one of its parts.
bool isWithin(std::size_t group, std::size_t other)
{
    while (group > other)
        group /= 2;
    return group == other;
}

void expectLeaves(const ClothParts& parts, std::size_t nodes)
{
    ASSERT_EQ(parts.nodeCount(), nodes);
    ASSERT_EQ(parts.order().size(), nodes);
    EXPECT_EQ(std::set<int>(parts.order().begin(), parts.order().end()).size(), nodes);
    for (std::size_t leaf = 0; leaf < parts.leafCount(); ++leaf)
    {
        EXPECT_LE(parts.firstNode(leaf + 1) - parts.firstNode(leaf), ClothParts::kMostNodes);
        for (std::size_t i = parts.firstNode(leaf); i < parts.firstNode(leaf + 1); ++i)
        {
            const int node[3] = {parts.order()[i], -1, -1};
            ASSERT_EQ(parts.groupOf(node), parts.firstLeaf() + leaf);
        }
    }
    EXPECT_EQ(parts.firstNode(parts.leafCount()), nodes);
}

// Expects the smallest group that contains all three.
void expectSmallest(const ClothParts& parts, const int nodes[3])
{
    const std::size_t group = parts.groupOf(nodes);
    std::size_t held[2] = {0, 0};  // by either half
    for (int k = 0; k < 3; ++k)
    {
        const int node[3] = {nodes[k], -1, -1};
        const std::size_t leaf = parts.groupOf(node);
        ASSERT_TRUE(isWithin(leaf, group));
        for (std::size_t half = 0; half < 2; ++half)
            held[half] += isWithin(leaf, 2 * group + half) ? 1 : 0;
    }
    EXPECT_LT(held[0], 3u);
    EXPECT_LT(held[1], 3u);
}
}  // namespace

TEST(ClothParts, ContainEachNodeOnce)
{
    for (const int columns : {1, 2, 16, 17, 33, 90})
    {
        const std::vector<Vec3> places = placesOf(makeClothGrid(columns + 1, columns, 1.0f, 0.0f).m_mesh);
        ClothParts parts;
        parts.cut(places);
        expectLeaves(parts, places.size());
    }
}

TEST(ClothParts, AFaceBelongsToTheSmallestGroup)
{
    const TriangleMesh mesh = makeClothGrid(129, 120, 1.0f, 0.0f).m_mesh;
    ClothParts parts;
    parts.cut(placesOf(mesh));
    ASSERT_GE(parts.leafCount(), 8u);
    std::size_t inLeaves = 0;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    {
        const int* const nodes = &mesh.m_triangles[3 * t];
        ASSERT_NO_FATAL_FAILURE(expectSmallest(parts, nodes));
        const int turned[3] = {nodes[2], nodes[0], nodes[1]};
        EXPECT_EQ(parts.groupOf(turned), parts.groupOf(nodes));
        inLeaves += parts.groupOf(nodes) >= parts.firstLeaf() ? 1 : 0;
    }
    // Neighbours: nearly all faces of a cloth lie in one part.
    EXPECT_GT(inLeaves, mesh.triangleCount() * 8 / 10);
}

TEST(ClothParts, AcceptAnyPositions)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    std::vector<Vec3> places(9000, vec3(1, 2, 3));
    ClothParts parts;
    parts.cut(places);
    expectLeaves(parts, places.size());
    Random random(5);
    for (std::size_t i = 0; i < places.size(); i += 3)
    {
        const float x = random.uniform(-1.0f, 1.0f);
        places[i] = vec3(i % 2 == 0 ? nan : x, i % 5 == 0 ? infinity : x, i % 7 == 0 ? -infinity : x);
    }
    parts.cut(places);
    expectLeaves(parts, places.size());
    parts.cut({});
    expectLeaves(parts, 0);
    EXPECT_EQ(parts.leafCount(), 1u);
}
}  // namespace drape::test
