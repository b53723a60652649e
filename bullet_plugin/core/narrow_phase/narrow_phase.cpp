#include "narrow_phase.h"

#include <algorithm>

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
constexpr std::size_t kSortGroup = 256;       // one group sorts a slot, however large
constexpr std::size_t kSortBlockGpu = 32;     // slots that a group sorts one after the other; a CPU's take kBlock
constexpr std::size_t kReduceGroup = 64;      // as in kernels/contact_reduction.cl
constexpr std::size_t kReduceBlockCpu = 256;  // slots of such a group
// On a GPU; as many groups per compute unit as make it busy, where slots are few.
constexpr std::size_t kReduceGroupGpu = 128;
constexpr std::size_t kReduceBlockGpu = 64, kLeastReduceBlockGpu = 4, kReduceGroupsPerUnit = 16;
// Most hits of a slot that a GPU puts in order by counting lesser ones, where no reduction follows: what a group of
// compactionOrder would count in local memory, a launch more.
constexpr cl_uint kRankedGpu = 512;
constexpr cl_uint kRankedReducedGpu = 256;  // where one follows: DRAPE_HELD of kernels/contact_reduction.cl
constexpr std::size_t kBlock = 1024;        // slots per work-group, as in kernels/compaction.cl
constexpr std::size_t kFewSlots = 1 << 14;  // each group sums those before its own
// Hits up to which a GPU compacts few slots in one launch: every group looks at all hits' slots, which would cost a CPU
// more than launches do.
constexpr std::size_t kFewHits = 1 << 13;
constexpr std::size_t kFewBlock = 64;  // slots of such a group, of kPlaceGroupGpu work-items
constexpr std::size_t kPlaceGroupGpu = 256;
constexpr std::size_t kPlaceGroupCpu = 64;
// Feature tests per compute unit up to which one launch is faster than two: the continuous test takes registers, which
// leave room for few groups at a time.
constexpr std::size_t kFewTestsPerUnit = 128;
// Of a GPU's launch over the feature tests, as in kernels/narrow_phase.cl: a group shares them out by kind.
constexpr std::size_t kFeatureGroupGpu = 256;
// Of a GPU's launches of the continuous test, work-items a compute unit: as many as the test's 250 registers leave room
// for on the H200, in groups of a warp.
constexpr std::size_t kSweptItemsGpu = 256, kSweptGroupGpu = 32;

// Work-items that copy a contact together: on a GPU, whose neighbours' stores are joined, one for each of its vectors.
cl_uint copyParts(const Device& device)
{
    return device.isGpu() ? 4 : 1;
}
}  // namespace

void NarrowPhaseStage::create(Device& device, const ProgramLoader& load, bool features, bool reduces)
{
    m_reduces = reduces;
    if (features)
    {
        const cl::Program narrowPhase = load("narrow_phase");
        m_feature.create(device, device.isGpu() ? narrowPhase : load("narrow_phase_lanes"), "narrowPhaseFeature");
        m_swept.create(device, narrowPhase, "narrowPhaseSwept");
        m_few.create(device, narrowPhase, "narrowPhaseFew");
    }
    else
    {
        const cl::Program narrowPhase = load("narrow_phase_pairs");
        m_test.create(device, narrowPhase, "narrowPhaseTest");
        m_intersect.create(device, narrowPhase, "narrowPhaseIntersect");
    }
    const cl::Program compaction = load("compaction");
    m_count.create(device, compaction, "compactionCount");
    m_place.create(device, compaction, "compactionPlace");
    m_gather.create(device, compaction, "compactionGather");
    m_order.create(device, compaction, "compactionOrder");
    m_write.create(device, compaction, "compactionWrite");
    if (device.isGpu()) m_compactFew.create(device, load("compaction_few"), "compactionFew");
    if (!reduces) return;
    const cl::Program reduction = load("contact_reduction");
    m_keep.create(device, reduction, device.isGpu() ? "reductionKeepWide" : "reductionKeep");
    m_writeKept.create(device, reduction, "reductionWrite");
    m_writeKeptFew.create(device, reduction, "reductionWriteFew");
}

void NarrowPhaseStage::resizeSlots(Device& device, std::size_t slotCount)
{
    m_slots = slotCount;
    m_slotCount.reserve(device, slotCount);
    m_slotFirst.reserve(device, slotCount);
    if (m_reduces)
    {
        m_slotKept.reserve(device, slotCount);
        m_keptFirst.reserve(device, slotCount);
    }
    m_blockCount.reserve(device, (slotCount + kBlock - 1) / kBlock);
    m_slotCount.fill(device, 0, slotCount);  // every step leaves it so
    reserveHitSlots(device);
}

void NarrowPhaseStage::reserveHitSlots(Device& device)
{
    if (device.isGpu() && m_slots <= kFewSlots)
        m_hitSlots.reserve(device, m_hits.capacity());
    else
        m_hitSlots.release();
}

void NarrowPhaseStage::reserveHits(Device& device, std::size_t count)
{
    m_hits.reserve(device, count);
    m_contacts.reserve(device, DRAPE_CONTACT_HEAD + count);
    m_members.reserve(device, count);
    m_keys.reserve(device, count);
    if (m_reduces) m_kept.reserve(device, count);
    reserveHitSlots(device);
}

void NarrowPhaseStage::enqueue(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount,
                               std::size_t triangleCount, const NarrowPhaseSettings& settings,
                               Buffer<Candidate>& candidates, StepTally tally, const ReductionBuffers* reduction,
                               const SelfWork* self)
{
    const cl_uint hitCapacity = cl_uint(m_hits.capacity());
    m_test.launch(device, listWidth(device), listGroup(device), candidates.handle(), cl_uint(candidates.capacity()),
                  sides.m_clothStart.handle(), sides.m_clothEnd.handle(), sides.m_clothTriangles.handle(),
                  sides.m_clothEdges.handle(), cl_uint(nodeCount), cl_uint(triangleCount),
                  sides.m_obstaclePositions.handle(), sides.m_obstacleTriangles.handle(), sides.m_vertexCones.handle(),
                  sides.m_edgeCones.handle(), sides.m_thickness.handle(), cl_uint(settings.m_obstacleMeshes),
                  settings.m_reachScale, cl_uint(settings.m_mode), sides.m_motions.handle(),
                  cl_uint(sides.m_motionCount), m_hits.handle(), hitCapacity, m_hitSlots.handle(), m_slotCount.handle(),
                  tally.m_now.handle());
    if (self) enqueueSelfHits(device, tally, *self);
    enqueueCompaction(device, sides, tally, reduction);
}

void NarrowPhaseStage::enqueueFeatures(Device& device, NarrowPhaseBuffers sides, std::size_t nodeCount,
                                       std::size_t triangleCount, std::uint32_t mode, PatchCullStage& cull,
                                       StepTally tally, const ReductionBuffers* reduction, const SelfWork* self)
{
    PatchCullStage::Features features = cull.features();
    const auto launch = [&](Kernel& kernel, std::size_t width, std::size_t group, auto&... list)
    {
        kernel.launch(device, width, group, cull.tests().handle(), cl_uint(cull.tests().capacity()),
                      sides.m_clothStart.handle(), sides.m_clothEnd.handle(), sides.m_clothTriangles.handle(),
                      sides.m_clothEdges.handle(), cl_uint(nodeCount), cl_uint(triangleCount), cl_uint(mode),
                      sides.m_obstacleTriangles.handle(), sides.m_vertexCones.handle(), sides.m_edgeCones.handle(),
                      features.m_faces.handle(), features.m_vertices.handle(), features.m_edges.handle(),
                      features.m_faceIds.handle(), features.m_vertexIds.handle(), features.m_edgeIds.handle(),
                      sides.m_motions.handle(), m_hits.handle(), cl_uint(m_hits.capacity()), m_hitSlots.handle(),
                      m_slotCount.handle(), tally.m_now.handle(), list.handle()...);
    };
    m_sweptTests.reserve(device, cull.tests().capacity());
    const bool few = tally.m_tests <= device.computeUnits() * kFewTestsPerUnit;
    const bool gpu = device.isGpu();
    const std::size_t featureGroup = gpu ? kFeatureGroupGpu : 1;
    const std::size_t sweptGroup = gpu ? kSweptGroupGpu : listGroup(device);
    const std::size_t sweptWidth = gpu ? device.computeUnits() * kSweptItemsGpu : listWidth(device);
    if (mode == DRAPE_DISCRETE || !few) launch(m_feature, laneListWidth(device), featureGroup, m_sweptTests);
    if (mode != DRAPE_DISCRETE && !few) launch(m_swept, sweptWidth, sweptGroup, m_sweptTests);
    if (mode != DRAPE_DISCRETE && few) launch(m_few, sweptWidth, sweptGroup);
    if (self) enqueueSelfHits(device, tally, *self);
    enqueueCompaction(device, sides, tally, reduction);
}

void NarrowPhaseStage::enqueueSelf(Device& device, NarrowPhaseBuffers sides, StepTally tally, const SelfWork& self)
{
    enqueueSelfHits(device, tally, self);
    enqueueCompaction(device, sides, tally, nullptr);
}

void NarrowPhaseStage::enqueueSelfHits(Device& device, StepTally tally, const SelfWork& self)
{
    self.m_stage.enqueueContacts(device, self.m_step, hits(), tally.m_now);
}

// Where each slot's contacts begin.
void NarrowPhaseStage::enqueuePlaces(Device& device, Buffer<cl_uint>& slotCount, Buffer<cl_uint>& slotFirst,
                                     cl_uint ranked, StepTally tally)
{
    const cl_uint slots = cl_uint(m_slots);
    const std::size_t blocks = (m_slots + kBlock - 1) / kBlock;
    const std::size_t group = device.isGpu() ? kPlaceGroupGpu : kPlaceGroupCpu;
    const cl::LocalSpaceArg scratch = cl::Local(group * sizeof(cl_uint));
    const bool few = m_slots <= kFewSlots;
    if (!few) m_count.launch(device, blocks * group, group, slotCount.handle(), slots, m_blockCount.handle(), scratch);
    m_place.launch(device, blocks * group, group, slotCount.handle(), slots, ranked,
                   (few ? slotCount : m_blockCount).handle(), cl_uint(few ? kBlock : 1), slotFirst.handle(),
                   tally.m_now.handle(), scratch);
}

// Slots with more hits than `ranked`.
void NarrowPhaseStage::enqueueOrder(Device& device, cl_uint ranked, StepTally tally)
{
    const std::size_t block = device.isGpu() ? kSortBlockGpu : kBlock;
    m_order.launch(device, (m_slots + block - 1) / block * kSortGroup, kSortGroup, cl_uint(m_hits.capacity()),
                   m_slotFirst.handle(), cl_uint(m_slots), ranked, cl_uint(block), m_members.handle(), m_keys.handle(),
                   tally.m_now.handle());
}

void NarrowPhaseStage::enqueueCompaction(Device& device, NarrowPhaseBuffers sides, StepTally tally,
                                         const ReductionBuffers* reduction)
{
    if (m_hitSlots.capacity() > 0 && tally.m_hits <= kFewHits)
    {
        enqueueFewCompaction(device, sides, tally, reduction);
        return;
    }
    const cl_uint hitCapacity = cl_uint(m_hits.capacity());
    const cl_uint ranked = !device.isGpu() ? DRAPE_RANKED : reduction ? kRankedReducedGpu : kRankedGpu;
    enqueuePlaces(device, m_slotCount, m_slotFirst, ranked, tally);
    m_gather.launch(device, listWidth(device), listGroup(device), m_hits.handle(), hitCapacity, m_slotCount.handle(),
                    m_slotFirst.handle(), m_members.handle(), m_keys.handle(), tally.m_now.handle(),
                    tally.m_next.handle());
    if (tally.m_ordered) enqueueOrder(device, ranked, tally);
    if (reduction)
        enqueueReduction(device, sides, tally, *reduction);
    else
        m_write.launch(device, listWidth(device), listGroup(device), m_hits.handle(), hitCapacity, m_slotFirst.handle(),
                       cl_uint(m_slots), ranked, copyParts(device), m_members.handle(), m_keys.handle(),
                       m_contacts.handle(), tally.m_now.handle());
}

void NarrowPhaseStage::enqueueKeep(Device& device, NarrowPhaseBuffers sides, StepTally tally,
                                   const ReductionBuffers& reduction)
{
    const std::size_t group = device.isGpu() ? kReduceGroupGpu : kReduceGroup;
    const std::size_t spread = m_slots / (kReduceGroupsPerUnit * device.computeUnits());
    const std::size_t block =
        device.isGpu() ? std::clamp(spread, kLeastReduceBlockGpu, kReduceBlockGpu) : kReduceBlockCpu;
    m_keep.launch(device, (m_slots + block - 1) / block * group, group, m_hits.handle(), cl_uint(m_hits.capacity()),
                  m_slotFirst.handle(), cl_uint(m_slots), cl_uint(block), m_members.handle(), m_kept.handle(),
                  m_slotKept.handle(), tally.m_now.handle(), sides.m_clothStart.handle(), sides.m_clothEnd.handle(),
                  sides.m_clothTriangles.handle(), sides.m_clothEdges.handle(), reduction.m_cloths.handle(),
                  reduction.m_obstacles.handle(), cl_uint(reduction.m_clothCount), cl_uint(reduction.m_obstacleCount),
                  sides.m_thickness.handle(), reduction.m_tube.handle());
}

void NarrowPhaseStage::enqueueReduction(Device& device, NarrowPhaseBuffers sides, StepTally tally,
                                        const ReductionBuffers& reduction)
{
    enqueueKeep(device, sides, tally, reduction);
    enqueuePlaces(device, m_slotKept, m_keptFirst, DRAPE_RANKED, tally);
    m_writeKept.launch(device, listWidth(device), listGroup(device), m_hits.handle(), cl_uint(m_hits.capacity()),
                       m_slotFirst.handle(), copyParts(device), m_kept.handle(), m_keptFirst.handle(),
                       m_contacts.handle(), tally.m_now.handle());
}

void NarrowPhaseStage::enqueueFewCompaction(Device& device, NarrowPhaseBuffers sides, StepTally tally,
                                            const ReductionBuffers* reduction)
{
    const cl_uint hitCapacity = cl_uint(m_hits.capacity()), slots = cl_uint(m_slots), block = cl_uint(kFewBlock);
    const std::size_t group = kPlaceGroupGpu, width = (m_slots + kFewBlock - 1) / kFewBlock * group;
    const cl_uint ranked = reduction ? kRankedReducedGpu : kRankedGpu;
    const cl::LocalSpaceArg scratch = cl::Local(group * sizeof(cl_uint));
    m_compactFew.launch(device, width, group, m_hits.handle(), hitCapacity, m_hitSlots.handle(), m_slotCount.handle(),
                        m_slotFirst.handle(), slots, block, ranked, m_members.handle(), m_keys.handle(),
                        reduction ? 0u : copyParts(device), m_contacts.handle(), tally.m_now.handle(),
                        tally.m_next.handle(), scratch);
    if (!reduction) return;
    enqueueKeep(device, sides, tally, *reduction);
    m_writeKeptFew.launch(device, width, group, m_hits.handle(), hitCapacity, m_slotFirst.handle(), slots, block,
                          copyParts(device), m_kept.handle(), m_slotKept.handle(), m_contacts.handle(),
                          tally.m_now.handle(), scratch);
}

void NarrowPhaseStage::enqueueIntersect(Device& device, NarrowPhaseBuffers sides, Buffer<Candidate>& candidates,
                                        Buffer<StepCounters>& counters)
{
    m_intersect.launch(device, listWidth(device), listGroup(device), candidates.handle(),
                       cl_uint(candidates.capacity()), sides.m_clothStart.handle(), sides.m_clothTriangles.handle(),
                       sides.m_obstaclePositions.handle(), sides.m_obstacleTriangles.handle(), sides.m_motions.handle(),
                       cl_uint(sides.m_motionCount), m_intersections.handle(), cl_uint(m_intersections.capacity()),
                       counters.handle());
}
}  // namespace drape
