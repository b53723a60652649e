// Exact numbers of a mesh's pairs that no traversal visits.
#include <gtest/gtest.h>

#include <cmath>

#include "bullet_plugin/core/queries/query_mesh.h"
#include "bullet_plugin/core/queries/leaf_pair_count.h"
#include "scenes/cloth_grid.h"
#include "scenes/describe_mesh.h"
#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
std::uint64_t countedOneByOne(const QueryMesh& a, const QueryMesh& b, std::uint32_t kind)
{
    std::uint64_t count = 0;
    leafPairsOnHost(a.tree(), b.tree(), kind, [&](const Candidate&) { ++count; });
    return count;
}

// Makes loose triangles, a fan or a cloth, crumpled or shrunk to a crowd, sometimes with a vertex that is not finite.
TriangleMesh randomMesh(std::uint32_t seed)
{
    Random random(seed);
    TriangleMesh mesh;
    const int size = 2 + int(random.below(20));
    switch (random.below(3))
    {
        case 0:
            mesh = soupCase(2 * size, 1, false, seed).m_cloth;
            break;
        case 1:
            mesh = makeClothGrid(2 + size / 4, 2 + size / 3, 1.0f, 0.0f).m_mesh;
            break;
        default:
            mesh.m_positions = {0, 0, 0};
            for (int i = 0; i <= 2 * size; ++i)
            {
                mesh.m_positions.insert(mesh.m_positions.end(), {random.uniform(-1, 1), random.uniform(-1, 1), 0});
                if (i > 0) mesh.m_triangles.insert(mesh.m_triangles.end(), {0, i, i + 1});
            }
    }
    const float scale = random.below(2) ? 0.01f : 1.0f;
    for (float& coordinate : mesh.m_positions)
        coordinate *= scale;
    disturb(mesh.m_positions, random.below(2) ? 0.0f : 0.1f, random);
    // Spoils one of the first vertices, often the middle of a fan.
    if (random.below(3) == 0) mesh.m_positions[3 * random.below(3)] = NAN;
    return mesh;
}
}  // namespace

TEST(LeafPairCount, EqualsThePairsVisited)
{
    std::size_t some = 0, apart = 0;
    for (std::uint32_t seed = 1300; seed < 1420; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const TriangleMesh meshes[2] = {randomMesh(seed), randomMesh(seed + 1000)};
        QueryMesh a = makeQueryMesh(describeMesh(meshes[0]), meshes[0].m_positions.data());
        QueryMesh b = makeQueryMesh(describeMesh(meshes[1]), meshes[1].m_positions.data());
        const float radius = seed % 2 ? 0.0f : 0.05f;
        a.refit(radius);
        b.refit(radius);
        for (std::uint32_t kind : {DRAPE_WALK_OTHER, DRAPE_WALK_SELF, DRAPE_WALK_SELF_APART})
        {
            SCOPED_TRACE("kind " + std::to_string(kind));
            const QueryMesh& other = kind == DRAPE_WALK_OTHER ? b : a;
            const std::uint64_t count = countedOneByOne(a, other, kind);
            EXPECT_EQ(countLeafPairs(a.tree(), other.tree(), kind), count);
            EXPECT_EQ(leafPairsBeyond(a.tree(), other.tree(), kind, count), 0u);
            if (count > 0)
            {
                EXPECT_EQ(leafPairsBeyond(a.tree(), other.tree(), kind, count - 1), count);
            }
            some += count > 0;
            apart += kind == DRAPE_WALK_SELF_APART && count > 0;
        }
    }
    EXPECT_GT(some, 240u);
    EXPECT_GT(apart, 40u);
}

TEST(LeafPairCount, EmptyMeshesHaveNone)
{
    const TriangleMesh nothing, one = looseTriangles({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const QueryMesh none = makeQueryMesh(describeMesh(nothing), nothing.m_positions.data());
    QueryMesh some = makeQueryMesh(describeMesh(one), one.m_positions.data());
    some.refit(0);
    EXPECT_EQ(countLeafPairs(some.tree(), none.tree(), DRAPE_WALK_OTHER), 0u);
    EXPECT_EQ(countLeafPairs(none.tree(), some.tree(), DRAPE_WALK_OTHER), 0u);
    EXPECT_EQ(countLeafPairs(none.tree(), none.tree(), DRAPE_WALK_SELF), 0u);
    EXPECT_EQ(countLeafPairs(some.tree(), some.tree(), DRAPE_WALK_SELF_APART), 0u);
}
}  // namespace drape::test
