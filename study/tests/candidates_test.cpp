// Broad phase against the truth: every pair of triangles that comes within the thickness during the step is a
// candidate.
#include <gtest/gtest.h>

#include "bullet_plugin/core/ordering/canonical_order.h"
#include "study/traversal/host_traversal.h"
#include "tests/support/cases.h"
#include "tests/support/oracle.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
struct Pairs
{
    std::size_t m_near = 0, m_missed = 0;
};

void cornersAt(const Side& side, std::uint32_t triangle, double time, Vector3 corners[3])
{
    for (int i = 0; i < 3; ++i)
    {
        const std::uint32_t vertex = side.m_pool.triangles()[triangle].m_vertices[i];
        corners[i] = (1 - time) * position(side.m_start, vertex) + time * position(side.m_end, vertex);
    }
}

// Returns a lower bound that avoids most of the distances: the gap of the boxes.
bool boxesApart(const Vector3 a[3], const Vector3 b[3], double reach)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const double lowA = std::min({a[0][axis], a[1][axis], a[2][axis]}),
                     highA = std::max({a[0][axis], a[1][axis], a[2][axis]});
        const double lowB = std::min({b[0][axis], b[1][axis], b[2][axis]}),
                     highB = std::max({b[0][axis], b[1][axis], b[2][axis]});
        if (lowA - highB > reach || lowB - highA > reach) return true;
    }
    return false;
}

// Times at which the motion is looked at. Nearness at one of them is enough to require the pair.
Pairs checkCandidates(const Side& cloth, const Side& obstacle, double thickness,
                      const std::vector<Candidate>& candidates)
{
    Pairs pairs;
    for (std::uint32_t i = 0; i < cloth.m_pool.triangles().size(); ++i)
    {
        for (std::uint32_t j = 0; j < obstacle.m_pool.triangles().size(); ++j)
        {
            Vector3 b[3];
            cornersAt(obstacle, j, 0, b);
            for (double time : {0.0, 0.25, 0.5, 0.75, 1.0})
            {
                Vector3 a[3];
                cornersAt(cloth, i, time, a);
                if (boxesApart(a, b, thickness) || triangleDistance(a, b) > thickness) continue;
                ++pairs.m_near;
                pairs.m_missed += !contains(candidates, i, j);
                break;
            }
        }
    }
    return pairs;
}

void expectNoneMissed(const StepCase& step, std::size_t leastNear)
{
    SCOPED_TRACE(step.trace());
    Side cloth = makeSide({step.m_cloth}), obstacle = makeSide({step.m_obstacle});
    cloth.m_end = step.m_end;
    refitSide(cloth, {step.m_thickness});
    refitSide(obstacle, {0.0f});
    std::vector<Candidate> candidates;
    const Hierarchy clothTree = {cloth.m_nodes, cloth.m_layout.root(), cloth.m_order},
                    obstacleTree = {obstacle.m_nodes, obstacle.m_layout.root(), obstacle.m_order};
    HostTraversal traversal(Traversal::Full);
    traversal.setTopology(clothTree, obstacleTree);
    traversal.run({clothTree, cloth.m_pool.triangles()}, {obstacleTree, obstacle.m_pool.triangles()},
                  {step.m_thickness}, 1, candidates);
    sortCandidates(candidates);
    const Pairs pairs = checkCandidates(cloth, obstacle, step.m_thickness, candidates);
    EXPECT_EQ(pairs.m_missed, 0u);
    EXPECT_GE(pairs.m_near, leastNear);
    EXPECT_GE(candidates.size(), pairs.m_near);
}
}  // namespace

TEST(CandidatesOracle, RandomSoupsMissNothing)
{
    for (std::uint32_t seed = 200; seed < 206; ++seed)
    {
        expectNoneMissed(soupCase(150, 200, false, seed), 50);
        expectNoneMissed(soupCase(150, 200, true, seed), 50);
    }
}

TEST(CandidatesOracle, ClothsOverShapesMissNothing)
{
    for (const char* shape : {"sphere", "bowl", "stairs", "torus", "terrain"})
    {
        expectNoneMissed(drapedCase(shape, 15, 0.02f, 210), 100);
        expectNoneMissed(fallingCase(shape, 15, 0.02f, 211), 100);
    }
}

TEST(CandidatesOracle, FarAndTinyMissNothing)
{
    for (float scale : {1e-6f, 1e6f})
    {
        StepCase step = fallingCase("sphere", 10, 0.02f, 220);
        for (std::vector<float>* positions : {&step.m_cloth.m_positions, &step.m_end, &step.m_obstacle.m_positions})
        {
            for (float& coordinate : *positions)
                coordinate *= scale;
        }
        step.m_thickness *= scale;
        expectNoneMissed(step, 50);
    }
    StepCase step = fallingCase("sphere", 10, 0.02f, 221);
    for (std::vector<float>* positions : {&step.m_cloth.m_positions, &step.m_end, &step.m_obstacle.m_positions})
    {
        translate(*positions, 1e5f, -1e5f, 1e5f);  // an ulp is 8 mm
    }
    expectNoneMissed(step, 50);
}
}  // namespace drape::test
