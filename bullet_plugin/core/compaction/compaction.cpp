#include "compaction.h"

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
constexpr std::size_t kSortGroup = 256;    // one group sorts a slot, however large
constexpr std::size_t kSortBlockGpu = 32;  // slots that a group sorts one after the other
// Maximum contacts of a slot that a GPU sorts by counting lesser ones, without a following reduction. compactionOrder
// would count the same in local memory, with one launch more.
constexpr cl_uint kRankedGpu = 512;
constexpr cl_uint kRankedReducedGpu = 256;  // with a reduction: DRAPE_HELD of kernels/contact_reduction_hits.cl

cl_uint rankedOn(const Device& device, bool reduced)
{
    if (device.isGpu()) return reduced ? kRankedReducedGpu : kRankedGpu;
    return reduced ? UINT32_MAX : DRAPE_RANKED;  // a CPU's reduction sorts all slots itself
}
}  // namespace

void CompactionStage::create(Device& device, const ProgramLoader& load, bool reduces)
{
    m_reduces = reduces;
    const cl::Program compaction = load("compaction");
    m_places.create(device, compaction);
    m_gather.create(device, compaction, "compactionGather");
    m_order.create(device, compaction, "compactionOrder");
    m_write.create(device, compaction, "compactionWrite");
    if (device.isGpu()) m_gatherFew.create(device, load("compaction_few"), "compactionGatherFew");
    if (reduces) m_reduction.create(device, load);
}

void CompactionStage::resizeSlots(Device& device, std::size_t slotCount)
{
    m_places.resize(device, slotCount);
    const bool sums = device.isGpu() && m_places.few();
    m_slotCount.reserve(device, wholeRows(slotCount));
    m_slotFirst.reserve(device, slotCount);
    if (m_reduces) m_reduction.resizeSlots(device, slotCount, sums);
    m_slotCount.fill(device, 0, slotCount);  // every step leaves it so
    if (sums)
    {
        m_slotSums.reserve(device, DRAPE_SLOT_SUMS);
        m_slotSums.fill(device, 0, DRAPE_SLOT_SUMS);
    }
    else
        m_slotSums.release();
    reserveHitPlaces(device);
}

void CompactionStage::reserveHitPlaces(Device& device)
{
    if (hasSums())
        m_hitPlaces.reserve(device, m_hits.capacity());
    else
        m_hitPlaces.release();
}

void CompactionStage::reserveHits(Device& device, std::size_t count)
{
    m_hits.reserve(device, count);
    m_contacts.reserve(device, DRAPE_CONTACT_HEAD + count);
    m_members.reserve(device, count);
    m_keys.reserve(device, count);
    if (m_reduces) m_reduction.reserveHits(device, count);
    reserveHitPlaces(device);
}

void CompactionStage::giveBackRoom()
{
    m_hits.release();
    m_contacts.release();
    m_members.release();
    m_keys.release();
    m_hitPlaces.release();
}

// Sorts the slots with more contacts than `ranked`.
void CompactionStage::enqueueOrder(Device& device, cl_uint ranked, StepTally tally)
{
    const std::size_t slots = m_places.slotCount();
    const std::size_t block = device.isGpu() ? kSortBlockGpu : SlotPlaces::kBlock;
    m_order.launch(device, (slots + block - 1) / block * kSortGroup, kSortGroup, cl_uint(m_hits.capacity()),
                   m_slotFirst.handle(), cl_uint(slots), ranked, cl_uint(block), m_members.handle(), m_keys.handle(),
                   tally.m_now.handle());
}

// Computes the first position of each slot, and lists its members.
void CompactionStage::enqueueGather(Device& device, StepTally tally, cl_uint ranked, const ReductionBuffers* reduction)
{
    const cl_uint hitCapacity = cl_uint(m_hits.capacity()), slots = cl_uint(m_places.slotCount());
    const KeptCounts kept = m_reduction.keptCounts(device.isGpu() && reduction);
    if (hasSums())
    {
        m_gatherFew.launch(device, listWidth(device, slots + tally.m_hits), listGroup(device), m_hits.handle(),
                           hitCapacity, m_hitPlaces.handle(), m_slotCount.handle(), m_slotSums.handle(), slots, ranked,
                           m_slotFirst.handle(), m_members.handle(), m_keys.handle(), kept.m_slotKept, kept.m_keptSums,
                           tally.m_now.handle(), tally.m_next.handle());
        return;
    }
    m_places.enqueue(device, m_slotCount, m_slotFirst, ranked, tally.m_now);
    m_gather.launch(device, listWidth(device), listGroup(device), m_hits.handle(), hitCapacity, m_slotCount.handle(),
                    m_slotFirst.handle(), slots, m_members.handle(), m_keys.handle(), kept.m_slotKept,
                    tally.m_now.handle(), tally.m_next.handle());
}

void CompactionStage::enqueue(Device& device, StepTally tally, const ReductionBuffers* reduction)
{
    const cl_uint hitCapacity = cl_uint(m_hits.capacity()), ranked = rankedOn(device, reduction);
    tally.m_hits = std::min(tally.m_hits, m_hits.capacity());
    enqueueGather(device, tally, ranked, reduction);
    if (tally.m_ordered && ranked != UINT32_MAX) enqueueOrder(device, ranked, tally);
    if (reduction)
        m_reduction.enqueue(device, slotHits(), *reduction, tally.m_hits, m_places, m_contacts, tally.m_now);
    else
        m_write.launch(device, listWidth(device, tally.m_hits * copyParts(device)), listGroup(device), m_hits.handle(),
                       hitCapacity, m_slotFirst.handle(), cl_uint(m_places.slotCount()), ranked, copyParts(device),
                       m_members.handle(), m_keys.handle(), m_contacts.handle(), tally.m_now.handle(),
                       m_slotCount.handle(), m_slotSums.handle());
}
}  // namespace drape
