// The order of a cloth's features: groups that contain them, colours whose features share no node, and a report of
// features that find no colour.
#include "bullet_plugin/core/solver/topology/feature_order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "kernels/lib/geometry/vec3.h"
#include "scenes/cloth_grid.h"

namespace drape::test
{
namespace
{
Topology topologyOf(const TriangleMesh& mesh)
{
    return buildTopology(mesh.m_triangles.data(), mesh.m_triangles.size() / 3, mesh.m_positions.size() / 3);
}

ClothParts partsOf(const TriangleMesh& mesh)
{
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < mesh.m_positions.size(); i += 3)
        places.push_back(vec3(mesh.m_positions[i], mesh.m_positions[i + 1], mesh.m_positions[i + 2]));
    ClothParts parts;
    parts.cut(std::move(places));
    return parts;
}

// A vertex with `count` triangles around it.
TriangleMesh makeFan(int count)
{
    TriangleMesh mesh;
    mesh.m_positions = {0, 0, 0};
    for (int i = 0; i < count; ++i)
    {
        const float angle = 6.2831853f * float(i) / float(count);
        mesh.m_positions.insert(mesh.m_positions.end(), {std::cos(angle), 0, std::sin(angle)});
        mesh.m_triangles.insert(mesh.m_triangles.end(), {0, 1 + i, 1 + (i + 1) % count});
    }
    return mesh;
}

// A cloth of several leaves.
TEST(FeatureOrder, FeaturesOfOneGroupAndColourShareNoNode)
{
    const TriangleMesh mesh = makeClothGrid(65, 65, 2.0f, 0.0f).m_mesh;
    const ClothParts parts = partsOf(mesh);
    ASSERT_GT(parts.leafCount(), 1u);
    FeatureOrder order;
    order.build(parts, topologyOf(mesh));
    EXPECT_FALSE(order.anyUncoloured());
    EXPECT_EQ(order.partsRevision(), parts.revision());
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, int>> taken;
    for (const OrderedFeature& feature : order.features())
    {
        EXPECT_EQ(feature.m_group, parts.groupOf(feature.m_nodes));
        for (int k = 0; k < 3 && feature.m_nodes[k] >= 0; ++k)
            EXPECT_TRUE(taken.insert({feature.m_group, feature.m_kind, feature.m_colour, feature.m_nodes[k]}).second);
    }
}

TEST(FeatureOrder, VerticesComeFirstThenTrianglesThenEdges)
{
    const TriangleMesh mesh = makeFan(5);
    FeatureOrder order;
    order.build(partsOf(mesh), topologyOf(mesh));
    ASSERT_EQ(order.features().size(), 6u + 5u + 10u);
    EXPECT_EQ(order.firstTriangle(), 6u);
    EXPECT_EQ(order.firstEdge(), 11u);
    EXPECT_EQ(order.features()[5].m_kind, kNodeFeature);
    EXPECT_EQ(order.features()[6].m_kind, kFaceFeature);
    EXPECT_EQ(order.features()[11].m_kind, kEdgeFeature);
}

TEST(FeatureOrder, MoreTrianglesAtAVertexThanColoursAreReported)
{
    for (const int count : {60, 70})
    {
        const TriangleMesh mesh = makeFan(count);
        FeatureOrder order;
        order.build(partsOf(mesh), topologyOf(mesh));
        EXPECT_EQ(order.anyUncoloured(), count > int(kColours)) << count;
    }
}
}  // namespace
}  // namespace drape::test
