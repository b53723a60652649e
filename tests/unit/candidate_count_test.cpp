// Exact numbers of candidates that are not listed.
#include <gtest/gtest.h>

#include "bullet_plugin/core/broad_phase/candidate_count.h"
#include "tests/support/cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
std::vector<std::uint64_t> countedOneByOne(const Side& cloth, const Side& obstacle, const std::vector<float>& thickness)
{
    std::vector<std::uint64_t> counts(cloth.m_pool.meshCount(), 0);
    for (const Candidate& candidate : bruteForceCandidates(cloth, obstacle, thickness))
        ++counts[cloth.m_pool.triangles()[candidate.m_cloth].m_mesh];
    return counts;
}
}  // namespace

// Three cloths and two obstacles, crossing, crowded and apart, with pairs that are not tested.
TEST(CandidateCount, EqualsTheListedPairs)
{
    for (std::uint32_t seed = 1200; seed < 1230; ++seed)
    {
        Random random(seed);
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::vector<TriangleMesh> meshes[2];
        for (int i = 0; i < 5; ++i)
        {
            TriangleMesh mesh = soupCase(1 + int(random.below(60)), 1, false, seed + std::uint32_t(i)).m_cloth;
            // The mesh is shrunk to a crowd, or not.
            const float scale = random.below(2) ? 0.01f : 1.0f;
            for (float& coordinate : mesh.m_positions)
                coordinate *= scale;
            if (random.below(3) == 0) mesh.m_positions[random.below(9)] = NAN;
            meshes[i % 2 == 0 ? 0 : 1].push_back(mesh);
        }
        Side cloth = makeSide(meshes[0]), obstacle = makeSide(meshes[1]);
        refitSide(cloth, {0.02f, 0.1f, 0.02f});
        refitSide(obstacle, {0.0f, 0.0f});
        std::vector<float> thickness(6, 0.1f);
        thickness[random.below(6)] = -1.0f;
        EXPECT_EQ(countCandidates(cloth.broadPhase(), obstacle.broadPhase(), thickness, 3, 2),
                  countedOneByOne(cloth, obstacle, thickness));
    }
}

TEST(CandidateCount, EmptySides)
{
    Side some = makeSide({looseTriangles({0, 0, 0, 1, 0, 0, 0, 1, 0})}), none = makeSide({});
    refitSide(some, {0.1f});
    EXPECT_EQ(countCandidates(some.broadPhase(), none.broadPhase(), {}, 1, 0), std::vector<std::uint64_t>({0}));
    EXPECT_TRUE(countCandidates(none.broadPhase(), some.broadPhase(), {}, 0, 1).empty());
}
}  // namespace drape::test
