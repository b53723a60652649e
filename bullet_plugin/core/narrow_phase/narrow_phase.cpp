#include "narrow_phase.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
constexpr std::size_t kBlock = 1024;          // slots per work-group, as in kernels/compaction.cl
constexpr std::size_t kItemsPerUnitGpu = 1024;  // work-items per compute unit that hide a GPU's latency
constexpr std::size_t kItemsPerUnitCpu = 256;   // four groups per core, so that uneven ones even out
}  // namespace

void NarrowPhaseStage::create(Device& device, const cl::Program& narrowPhase, const cl::Program& compaction)
{
    m_test.create(device, narrowPhase, "narrowPhaseTest");
    m_tie.create(device, narrowPhase, "narrowPhaseTie");
    m_win.create(device, narrowPhase, "narrowPhaseWin");
    m_intersect.create(device, narrowPhase, "narrowPhaseIntersect");
    m_count.create(device, compaction, "compactionCount");
    m_scan.create(device, compaction, "compactionScan");
    m_write.create(device, compaction, "compactionWrite");
}

void NarrowPhaseStage::resizeSlots(Device& device, std::size_t slotCount)
{
    m_slotCount = slotCount;
    m_slotRank.reserve(device, slotCount);
    m_slotFeature.reserve(device, slotCount);
    m_slotHit.reserve(device, slotCount);
    m_blockCount.reserve(device, (slotCount + kBlock - 1) / kBlock);
    clearSlots(device);
}

void NarrowPhaseStage::clearSlots(Device& device)
{
    m_slotRank.fill(device, DRAPE_NO_CONTACT, m_slotCount);
    m_slotFeature.fill(device, DRAPE_NO_CONTACT, m_slotCount);
}

std::size_t NarrowPhaseStage::listWidth(const Device& device) const
{
    return device.computeUnits() * (device.isGpu() ? kItemsPerUnitGpu : kItemsPerUnitCpu);
}

void NarrowPhaseStage::enqueue(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount, std::size_t triangleCount,
                               const NarrowPhaseSettings& settings, Buffer<Candidate>& candidates,
                               Buffer<StepCounters>& counters)
{
    const std::size_t width = listWidth(device);
    const cl_uint hitCapacity = cl_uint(m_hits.capacity());
    m_test.launch(device, width, kGroup, candidates.handle(), cl_uint(candidates.capacity()), sides.m_clothStart.handle(),
                  sides.m_clothEnd.handle(), sides.m_clothTriangles.handle(), sides.m_clothEdges.handle(),
                  cl_uint(nodeCount), cl_uint(triangleCount), sides.m_obstaclePositions.handle(),
                  sides.m_obstacleTriangles.handle(), sides.m_vertexCones.handle(), sides.m_edgeCones.handle(),
                  sides.m_thickness.handle(), cl_uint(settings.m_obstacleMeshes), settings.m_reachScale, m_hits.handle(),
                  hitCapacity, m_slotRank.handle(), counters.handle(), cl_uint(settings.m_allContacts));
    m_tie.launch(device, width, kGroup, m_hits.handle(), hitCapacity, m_slotRank.handle(), m_slotFeature.handle(),
                 counters.handle());
    m_win.launch(device, width, kGroup, m_hits.handle(), hitCapacity, m_slotRank.handle(), m_slotFeature.handle(),
                 m_slotHit.handle(), counters.handle());
    enqueueCompaction(device, counters);
}

void NarrowPhaseStage::enqueueCompaction(Device& device, Buffer<StepCounters>& counters)
{
    const cl_uint slots = cl_uint(m_slotCount);
    const std::size_t blocks = (m_slotCount + kBlock - 1) / kBlock;
    const cl::LocalSpaceArg scratch = cl::Local(kGroup * sizeof(cl_uint));
    m_count.launch(device, blocks * kGroup, kGroup, m_slotFeature.handle(), slots, m_blockCount.handle(), scratch);
    m_scan.launch(device, kGroup, kGroup, m_blockCount.handle(), cl_uint(blocks), counters.handle(), scratch);
    m_write.launch(device, blocks * kGroup, kGroup, m_slotRank.handle(), m_slotFeature.handle(), m_slotHit.handle(), slots,
                   m_blockCount.handle(), m_hits.handle(), m_contacts.handle(), cl_uint(m_contacts.capacity()), scratch);
}

void NarrowPhaseStage::enqueueIntersect(Device& device, NarrowPhaseBuffers sides, Buffer<Candidate>& candidates,
                                        Buffer<StepCounters>& counters)
{
    m_intersect.launch(device, listWidth(device), kGroup, candidates.handle(), cl_uint(candidates.capacity()),
                       sides.m_clothStart.handle(), sides.m_clothTriangles.handle(), sides.m_obstaclePositions.handle(),
                       sides.m_obstacleTriangles.handle(), m_intersections.handle(), cl_uint(m_intersections.capacity()),
                       counters.handle());
}
}  // namespace drape
