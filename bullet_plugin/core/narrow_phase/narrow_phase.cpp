#include "narrow_phase.h"

#include <algorithm>

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
// Feature tests per compute unit up to which one launch is faster than two: the continuous test takes registers, which
// leave room for few groups at a time.
constexpr std::size_t kFewTestsPerUnit = 128;
// Maximum tests that a single launch processes, as a multiple of that number. If a step is suddenly larger, it is worth
// running again with two launches.
constexpr std::size_t kMostOfSmall = 16;
// Group size of a GPU's launch over the feature tests, as in kernels/narrow_phase/narrow_phase.cl: a group divides them
// by kind.
constexpr std::size_t kFeatureGroupGpu = 256;
// Work-items per compute unit, and group size, of a GPU's launches of the continuous test. The test's 250 registers
// leave room for that many on the H200, in groups of a warp.
constexpr std::size_t kSweptItemsGpu = 256, kSweptGroupGpu = 32;
}  // namespace

void NarrowPhaseStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program narrowPhase = load("narrow_phase/narrow_phase");
    m_feature.create(device, device.isGpu() ? narrowPhase : load("narrow_phase/narrow_phase_simd"));
    m_swept.create(device, narrowPhase);
    m_small.create(device, narrowPhase);
}

void NarrowPhaseStage::enqueue(Device& device, const Input& input, FeatureTestList& tests, Expected expected,
                               UnsortedContacts& contacts, Buffer<StepCounters>& counters)
{
    FeatureValues values = {input.m_cloths.m_layout,
                            input.m_obstacles.m_layout,
                            input.m_patches.m_layout,
                            cl_uint(tests.capacity()),
                            input.m_mode,
                            cl_uint(std::min(expected.m_mostSwept, std::size_t(CL_UINT_MAX))),
                            cl_uint(contacts.capacity()),
                            contacts.sums()};
    const auto launch = [&](auto& kernel, std::size_t width, std::size_t group, const auto&... swept)
    {
        kernel.launch(device, width, group, values, tests.m_tests, input.m_cloths.m_nodes, input.m_cloths.m_topology,
                      input.m_obstacles.m_geometry, input.m_patches.m_patches, input.m_motions, contacts.m_contacts,
                      contacts.m_ranks, contacts.m_featureCounts, counters, swept...);
    };
    tests.m_swept.reserve(device, tests.capacity());
    const bool few = expected.m_tests <= device.computeUnits() * kFewTestsPerUnit;
    const bool one = input.m_mode != DRAPE_DISCRETE && few;
    m_mostTests = one ? device.computeUnits() * kFewTestsPerUnit * kMostOfSmall : SIZE_MAX;
    const bool gpu = device.isGpu();
    const std::size_t sweptGroup = gpu ? kSweptGroupGpu : listGroup(device);
    const std::size_t sweptWidth = gpu ? device.computeUnits() * kSweptItemsGpu : listWidth(device);
    if (one)
    {
        values.m_most = cl_uint(m_mostTests);
        launch(m_small, sweptWidth, sweptGroup);
        return;
    }
    launch(m_feature, laneListWidth(device), gpu ? kFeatureGroupGpu : 1, tests.m_swept);
    if (input.m_mode != DRAPE_DISCRETE) launch(m_swept, sweptWidth, sweptGroup, tests.m_swept);
}
}  // namespace drape
