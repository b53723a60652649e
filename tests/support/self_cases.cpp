#include "tests/support/self_cases.h"

#include <gtest/gtest.h>

#include <limits>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/cases.h"

namespace drape::test
{
SelfCase soupSelfCase(int triangles, std::uint32_t seed)
{
    SelfCase motion;
    motion.m_name = "soup of " + std::to_string(triangles) + ", seed " + std::to_string(seed);
    motion.m_mesh = makeSoup(1.0f, 0.2f, triangles, seed);
    motion.m_end = motion.m_mesh.m_positions;
    Random random(seed);
    disturb(motion.m_end, 0.2f, random);
    return motion;
}

SelfCase crumpledCase(int nodes, std::uint32_t seed)
{
    SelfCase motion;
    motion.m_name = "cloth of " + std::to_string(nodes) + " nodes a side, seed " + std::to_string(seed);
    motion.m_mesh = makeClothGrid(nodes, nodes, 1.0f, 0.0f).m_mesh;
    motion.m_end = motion.m_mesh.m_positions;
    Random random(seed);
    disturb(motion.m_end, 2.0f / float(nodes), random);
    return motion;
}

std::vector<SelfCase> selfCases()
{
    std::vector<SelfCase> cases = {soupSelfCase(1, 100), soupSelfCase(2, 101), soupSelfCase(151, 102),
                                   crumpledCase(2, 103), crumpledCase(9, 104), crumpledCase(24, 105)};
    SelfCase none;
    none.m_name = "no triangles";
    none.m_mesh.m_positions = none.m_end = {0, 0, 0, 1, 0, 0};
    cases.push_back(none);
    // Features of the bad node's neighbours must still be found.
    SelfCase bad = crumpledCase(9, 106);
    bad.m_name += ", a node is NaN";
    bad.m_end[3 * 40 + 1] = std::numeric_limits<float>::quiet_NaN();
    cases.push_back(bad);
    return cases;
}

std::unique_ptr<Queries> makeQueries(const Settings& settings)
{
    Error error;
    std::unique_ptr<Queries> queries = Queries::create(settings, error);
    if (!queries) ADD_FAILURE() << error.text();
    return queries;
}
}  // namespace drape::test
