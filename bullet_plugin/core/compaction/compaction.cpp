#include "compaction.h"

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
constexpr std::size_t kSortGroup = 256;    // one group sorts a slot, however large
constexpr std::size_t kSortBlockGpu = 32;  // slots that a group sorts one after the other
// Most hits of a slot that a GPU puts in order by counting lesser ones, where no reduction follows: what a group of
// compactionOrder would count in local memory, a launch more.
constexpr cl_uint kRankedGpu = 512;
constexpr cl_uint kRankedReducedGpu = 256;  // where one follows: DRAPE_HELD of kernels/contact_reduction_hits.cl
// Hits up to which a GPU compacts few slots in one launch: every group looks at all hits' slots, which would cost a CPU
// more than launches do.
constexpr std::size_t kFewHits = 1 << 13;

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
    if (device.isGpu()) m_few.create(device, load("compaction_few"), "compactionFew");
    if (reduces) m_reduction.create(device, load);
}

void CompactionStage::resizeSlots(Device& device, std::size_t slotCount)
{
    m_places.resize(device, slotCount);
    m_slotCount.reserve(device, slotCount);
    m_slotFirst.reserve(device, slotCount);
    if (m_reduces) m_reduction.resizeSlots(device, slotCount);
    m_slotCount.fill(device, 0, slotCount);  // every step leaves it so
    reserveHitSlots(device);
}

void CompactionStage::reserveHitSlots(Device& device)
{
    if (device.isGpu() && m_places.few())
        m_hitSlots.reserve(device, m_hits.capacity());
    else
        m_hitSlots.release();
}

void CompactionStage::reserveHits(Device& device, std::size_t count)
{
    m_hits.reserve(device, count);
    m_contacts.reserve(device, DRAPE_CONTACT_HEAD + count);
    m_members.reserve(device, count);
    m_keys.reserve(device, count);
    if (m_reduces) m_reduction.reserveHits(device, count);
    reserveHitSlots(device);
}

// Slots with more hits than `ranked`.
void CompactionStage::enqueueOrder(Device& device, cl_uint ranked, StepTally tally)
{
    const std::size_t slots = m_places.slotCount();
    const std::size_t block = device.isGpu() ? kSortBlockGpu : SlotPlaces::kBlock;
    m_order.launch(device, (slots + block - 1) / block * kSortGroup, kSortGroup, cl_uint(m_hits.capacity()),
                   m_slotFirst.handle(), cl_uint(slots), ranked, cl_uint(block), m_members.handle(), m_keys.handle(),
                   tally.m_now.handle());
}

void CompactionStage::enqueue(Device& device, StepTally tally, const ReductionBuffers* reduction)
{
    if (m_hitSlots.capacity() > 0 && tally.m_hits <= kFewHits)
    {
        enqueueFew(device, tally, reduction);
        return;
    }
    const cl_uint hitCapacity = cl_uint(m_hits.capacity()), ranked = rankedOn(device, reduction);
    m_places.enqueue(device, m_slotCount, m_slotFirst, ranked, tally.m_now);
    m_gather.launch(device, listWidth(device), listGroup(device), m_hits.handle(), hitCapacity, m_slotCount.handle(),
                    m_slotFirst.handle(), m_members.handle(), m_keys.handle(), tally.m_now.handle(),
                    tally.m_next.handle());
    if (tally.m_ordered && ranked != UINT32_MAX) enqueueOrder(device, ranked, tally);
    if (reduction)
        m_reduction.enqueue(device, slotHits(), *reduction, tally.m_hits, m_places, m_contacts, tally.m_now);
    else
        m_write.launch(device, listWidth(device), listGroup(device), m_hits.handle(), hitCapacity, m_slotFirst.handle(),
                       cl_uint(m_places.slotCount()), ranked, copyParts(device), m_members.handle(), m_keys.handle(),
                       m_contacts.handle(), tally.m_now.handle());
}

void CompactionStage::enqueueFew(Device& device, StepTally tally, const ReductionBuffers* reduction)
{
    const std::size_t slots = m_places.slotCount(), group = SlotPlaces::kGroupGpu;
    m_few.launch(device, fewWidth(slots), group, m_hits.handle(), cl_uint(m_hits.capacity()), m_hitSlots.handle(),
                 m_slotCount.handle(), m_slotFirst.handle(), cl_uint(slots), cl_uint(kFewBlock),
                 rankedOn(device, reduction), m_members.handle(), m_keys.handle(), reduction ? 0u : copyParts(device),
                 m_contacts.handle(), tally.m_now.handle(), tally.m_next.handle(), cl::Local(group * sizeof(cl_uint)));
    if (reduction) m_reduction.enqueueFew(device, slotHits(), *reduction, tally.m_hits, m_contacts, tally.m_now);
}
}  // namespace drape
