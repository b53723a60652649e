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
constexpr std::size_t kMostOfFew = 16;
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
    m_feature.create(device, device.isGpu() ? narrowPhase : load("narrow_phase/narrow_phase_simd"),
                     "narrowPhaseFeature");
    m_swept.create(device, narrowPhase, "narrowPhaseSwept");
    m_few.create(device, narrowPhase, "narrowPhaseFew");
}

void NarrowPhaseStage::enqueueFeatures(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount,
                                       std::size_t triangleCount, std::uint32_t mode, PatchCullStage& cull,
                                       Expected expected, HitBuffers hits, Buffer<StepCounters>& counters)
{
    PatchCullStage::Features features = cull.features();
    const auto launch = [&](Kernel& kernel, std::size_t width, std::size_t group, const auto&... list)
    {
        kernel.launch(device, width, group, cull.tests().handle(), cl_uint(cull.tests().capacity()),
                      sides.m_clothStart.handle(), sides.m_clothEnd.handle(), sides.m_clothTriangles.handle(),
                      sides.m_clothEdges.handle(), cl_uint(nodeCount), cl_uint(triangleCount), cl_uint(mode),
                      sides.m_obstacleTriangles.handle(), sides.m_vertexCones.handle(), sides.m_edgeCones.handle(),
                      features.m_faces.handle(), features.m_vertices.handle(), features.m_edges.handle(),
                      features.m_faceIds.handle(), features.m_vertexIds.handle(), features.m_edgeIds.handle(),
                      sides.m_motions.handle(), hits.m_hits.handle(), cl_uint(hits.m_hits.capacity()),
                      hits.m_hitPlaces.handle(), hits.m_slotCount.handle(), hits.m_slotSums.handle(), counters.handle(),
                      list...);
    };
    const cl_uint mostSwept = cl_uint(std::min(expected.m_mostSwept, std::size_t(CL_UINT_MAX)));
    m_sweptTests.reserve(device, cull.tests().capacity());
    const bool few = expected.m_tests <= device.computeUnits() * kFewTestsPerUnit;
    const bool one = mode != DRAPE_DISCRETE && few;
    m_mostTests = one ? device.computeUnits() * kFewTestsPerUnit * kMostOfFew : SIZE_MAX;
    const bool gpu = device.isGpu();
    const std::size_t featureGroup = gpu ? kFeatureGroupGpu : 1;
    const std::size_t sweptGroup = gpu ? kSweptGroupGpu : listGroup(device);
    const std::size_t sweptWidth = gpu ? device.computeUnits() * kSweptItemsGpu : listWidth(device);
    if (!one) launch(m_feature, laneListWidth(device), featureGroup, m_sweptTests.handle());
    if (mode != DRAPE_DISCRETE && !few) launch(m_swept, sweptWidth, sweptGroup, m_sweptTests.handle(), mostSwept);
    if (one) launch(m_few, sweptWidth, sweptGroup, cl_uint(m_mostTests));
}
}  // namespace drape
