#include "tests/support/self_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "scenes/cloth_grid.h"
#include "scenes/describe_mesh.h"
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

SelfStepCase foldedCase(int nodes, int layers, float motion, std::uint32_t seed)
{
    SelfStepCase step;
    step.m_thickness = 0.35f / float(nodes - 1);
    step.m_motion.m_name = "cloth of " + std::to_string(nodes) + " nodes a side in " + std::to_string(layers) +
                           " layers, seed " + std::to_string(seed);
    step.m_motion.m_mesh = makeClothGrid(nodes, nodes, 1.0f, 0.0f).m_mesh;
    std::vector<float>& positions = step.m_motion.m_mesh.m_positions;
    step.m_rest = positions;
    const float length = 1.0f / float(layers), gap = 0.8f * step.m_thickness;
    for (std::size_t i = 0; i < positions.size(); i += 3)
    {
        const float place = (positions[i] + 0.5f) * float(layers);  // the grid is centred
        const int layer = std::min(layers - 1, int(place + 1e-3f));
        const float along = place - float(layer);
        const bool onFold = layer > 0 && along < 1e-3f;
        positions[i] = length * (layer % 2 == 0 ? along : 1.0f - along);
        positions[i + 1] = gap * (float(layer) - (onFold ? 0.5f : 0.0f));
    }
    Random random(seed);
    disturb(positions, 0.3f * gap, random);
    step.m_motion.m_end = positions;
    disturb(step.m_motion.m_end, motion, random);
    return step;
}

std::vector<SelfStepCase> selfStepCases()
{
    std::vector<SelfStepCase> cases = {foldedCase(13, 3, 0.0f, 110), foldedCase(13, 3, 0.03f, 111),
                                       foldedCase(25, 4, 0.003f, 112), foldedCase(17, 2, 0.3f, 113)};
    for (const SelfCase& motion : selfCases())
        cases.push_back({motion, motion.m_mesh.m_positions, 0.03f});
    return cases;
}

MeshId addSelfCloth(Pipeline& pipeline, const SelfStepCase& step)
{
    MeshDescription description = describeMesh(step.m_motion.m_mesh);
    description.m_selfThickness = step.m_thickness;
    description.m_restPositions = step.m_rest.data();
    const MeshId cloth = pipeline.addCloth(description);
    const std::vector<float>& start = step.m_motion.m_mesh.m_positions;
    std::copy(start.begin(), start.end(), pipeline.clothStart(cloth));
    std::copy(step.m_motion.m_end.begin(), step.m_motion.m_end.end(), pipeline.clothEnd(cloth));
    pipeline.addSelf(cloth);
    return cloth;
}

std::vector<Contact> runSelfCase(Pipeline& pipeline, const SelfStepCase& step)
{
    addSelfCloth(pipeline, step);
    pipeline.submit();
    pipeline.finish();
    const ContactList contacts = pipeline.selfContacts();
    return {contacts.begin(), contacts.end()};
}

std::unique_ptr<Queries> makeQueries(const Settings& settings)
{
    Error error;
    std::unique_ptr<Queries> queries = Queries::create(settings, error);
    if (!queries) ADD_FAILURE() << error.text();
    return queries;
}
}  // namespace drape::test
