#include "slot_places.h"

namespace drape
{
void SlotPlaces::create(Device& device, const cl::Program& ordering)
{
    m_count.create(device, ordering, "orderingCount");
    m_place.create(device, ordering, "orderingPlace");
}

void SlotPlaces::resize(Device& device, std::size_t slotCount)
{
    m_slots = slotCount;
    m_blockCount.reserve(device, (slotCount + kBlock - 1) / kBlock);
}

void SlotPlaces::enqueue(Device& device, Buffer<cl_uint>& slotCounts, Buffer<cl_uint>& slotFirsts, cl_uint ranked,
                         Buffer<StepCounters>& counters)
{
    const cl_uint slots = cl_uint(m_slots);
    const std::size_t blocks = (m_slots + kBlock - 1) / kBlock;
    const std::size_t group = device.isGpu() ? kGroupGpu : kGroupCpu;
    const cl::LocalSpaceArg scratch = cl::Local(group * sizeof(cl_uint));
    if (!few())
        m_count.launch(device, blocks * group, group, slotCounts.handle(), slots, m_blockCount.handle(), scratch);
    m_place.launch(device, blocks * group, group, slotCounts.handle(), slots, ranked,
                   (few() ? slotCounts : m_blockCount).handle(), cl_uint(few() ? kBlock : 1), slotFirsts.handle(),
                   counters.handle(), scratch);
}
}  // namespace drape
