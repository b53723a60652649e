#include "ordering.h"

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
constexpr std::size_t kSortGroup = 256;    // one group sorts a slot, however large
constexpr std::size_t kSortBlockGpu = 32;  // slots that a group sorts one after the other
// Maximum contacts of a slot that a GPU sorts by counting lesser ones. orderingOrder would count the same in local
// memory, with one launch more.
constexpr cl_uint kRankedGpu = 512;
}  // namespace

void OrderingStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program ordering = load("ordering/ordering");
    m_places.create(device, ordering);
    m_gather.create(device, ordering, "orderingGather");
    m_order.create(device, ordering, "orderingOrder");
    m_write.create(device, ordering, "orderingWrite");
    if (device.isGpu()) m_gatherFew.create(device, load("ordering/ordering_small"), "orderingGatherFew");
}

void OrderingStage::resizeSlots(Device& device, std::size_t slotCount)
{
    m_places.resize(device, slotCount);
    const bool sums = device.isGpu() && m_places.few();
    m_slotCount.reserve(device, wholeRows(slotCount));
    m_slotFirst.reserve(device, slotCount);
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

void OrderingStage::reserveHitPlaces(Device& device)
{
    if (hasSums())
        m_hitPlaces.reserve(device, m_hits.capacity());
    else
        m_hitPlaces.release();
}

void OrderingStage::reserveHits(Device& device, std::size_t count)
{
    m_hits.reserve(device, count);
    m_contacts.reserve(device, DRAPE_CONTACT_HEAD + count);
    m_members.reserve(device, count);
    m_keys.reserve(device, count);
    reserveHitPlaces(device);
}

void OrderingStage::giveBackRoom()
{
    m_hits.release();
    m_contacts.release();
    m_members.release();
    m_keys.release();
    m_hitPlaces.release();
}

// Sorts the slots with more contacts than `ranked`.
void OrderingStage::enqueueOrder(Device& device, StepTally tally, cl_uint ranked)
{
    const std::size_t slots = m_places.slotCount();
    const std::size_t block = device.isGpu() ? kSortBlockGpu : SlotPlaces::kBlock;
    m_order.launch(device, (slots + block - 1) / block * kSortGroup, kSortGroup, cl_uint(m_hits.capacity()),
                   m_slotFirst.handle(), cl_uint(slots), ranked, cl_uint(block), m_members.handle(), m_keys.handle(),
                   tally.m_now.handle());
}

// Computes the first position of each slot, and lists its members.
void OrderingStage::enqueueGather(Device& device, StepTally tally, cl_uint ranked)
{
    const cl_uint hitCapacity = cl_uint(m_hits.capacity()), slots = cl_uint(m_places.slotCount());
    if (hasSums())
    {
        m_gatherFew.launch(device, listWidth(device, slots + tally.m_hits), listGroup(device), m_hits.handle(),
                           hitCapacity, m_hitPlaces.handle(), m_slotCount.handle(), m_slotSums.handle(), slots, ranked,
                           m_slotFirst.handle(), m_members.handle(), m_keys.handle(), tally.m_now.handle(),
                           tally.m_next.handle());
        return;
    }
    m_places.enqueue(device, m_slotCount, m_slotFirst, ranked, tally.m_now);
    m_gather.launch(device, listWidth(device), listGroup(device), m_hits.handle(), hitCapacity, m_slotCount.handle(),
                    m_slotFirst.handle(), m_members.handle(), m_keys.handle(), tally.m_now.handle(),
                    tally.m_next.handle());
}

void OrderingStage::enqueue(Device& device, StepTally tally)
{
    const cl_uint ranked = device.isGpu() ? kRankedGpu : DRAPE_RANKED;
    tally.m_hits = std::min(tally.m_hits, m_hits.capacity());
    enqueueGather(device, tally, ranked);
    if (tally.m_ordered) enqueueOrder(device, tally, ranked);
    m_write.launch(device, listWidth(device, tally.m_hits * copyParts(device)), listGroup(device), m_hits.handle(),
                   cl_uint(m_hits.capacity()), m_slotFirst.handle(), cl_uint(m_places.slotCount()), ranked,
                   copyParts(device), m_members.handle(), m_keys.handle(), m_contacts.handle(), tally.m_now.handle(),
                   m_slotCount.handle(), m_slotSums.handle());
}
}  // namespace drape
