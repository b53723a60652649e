#include "contact_reduction.h"

#include <algorithm>

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
constexpr std::size_t kBlockCpu = 64;  // slots of a work-item
// On a GPU: groups take the slots of so many members, so that there are so many groups per compute unit or more.
constexpr std::size_t kGroupGpu = 128;
constexpr std::size_t kGroupsPerUnit = 8;
constexpr std::size_t kLeastShareGpu = 4, kMostShareGpu = 64;  // the latter as in kernels/contact_reduction_hits.cl
}  // namespace

void ContactReductionStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program reduction = load("contact_reduction");
    const bool gpu = device.isGpu();
    m_keep.create(device, load(gpu ? "contact_reduction_hits" : "contact_reduction_slots"),
                  gpu ? "reductionKeepWide" : "reductionKeep");
    m_write.create(device, reduction, "reductionWrite");
    if (gpu) m_writeFew.create(device, reduction, "reductionWriteFew");
}

void ContactReductionStage::resizeSlots(Device& device, std::size_t slotCount, bool sums)
{
    m_slots = slotCount;
    m_slotKept.reserve(device, wholeRows(slotCount));
    if (sums)
    {
        m_keptSums.reserve(device, DRAPE_SLOT_SUMS);
        m_keptFirst.release();
    }
    else
    {
        m_keptSums.release();
        m_keptFirst.reserve(device, slotCount);
    }
}

KeptCounts ContactReductionStage::keptCounts(bool reduces)
{
    if (!reduces) return {};
    return {m_slotKept.handle(), m_keptSums.handle()};
}

void ContactReductionStage::enqueueKeep(Device& device, SlotHits hits, const ReductionBuffers& sides,
                                        std::size_t expectedHits, Buffer<StepCounters>& counters)
{
    const auto launch = [&](std::size_t groups, std::size_t group, std::size_t share, const auto&... sums)
    {
        m_keep.launch(device, groups * group, group, hits.m_hits.handle(), cl_uint(hits.m_hits.capacity()),
                      hits.m_slotFirst.handle(), cl_uint(m_slots), cl_uint(share), hits.m_members.handle(),
                      m_kept.handle(), m_slotKept.handle(), counters.handle(), sides.m_clothStart.handle(),
                      sides.m_clothEnd.handle(), sides.m_clothTriangles.handle(), sides.m_clothEdges.handle(),
                      sides.m_cloths.handle(), sides.m_obstacles.handle(), cl_uint(sides.m_clothCount),
                      cl_uint(sides.m_obstacleCount), sides.m_thickness.handle(), sides.m_tube.handle(), sums...);
    };
    if (!device.isGpu())
    {
        launch((m_slots + kBlockCpu - 1) / kBlockCpu, 1, kBlockCpu);
        return;
    }
    const std::size_t fewest = kGroupsPerUnit * device.computeUnits();
    const std::size_t share = std::clamp(expectedHits / fewest, kLeastShareGpu, kMostShareGpu);
    launch(std::max(fewest, (expectedHits + expectedHits / 8) / share), kGroupGpu, share, m_keptSums.handle());
}

void ContactReductionStage::enqueue(Device& device, SlotHits hits, const ReductionBuffers& sides,
                                    std::size_t expectedHits, SlotPlaces& places, Buffer<Contact>& contacts,
                                    Buffer<StepCounters>& counters)
{
    enqueueKeep(device, hits, sides, expectedHits, counters);
    const std::size_t width = listWidth(device, expectedHits * copyParts(device));
    if (m_keptSums.capacity() > 0)
    {
        m_writeFew.launch(device, width, listGroup(device), hits.m_hits.handle(), cl_uint(hits.m_hits.capacity()),
                          hits.m_slotFirst.handle(), cl_uint(m_slots), copyParts(device), m_kept.handle(),
                          m_slotKept.handle(), m_keptSums.handle(), contacts.handle(), counters.handle(),
                          hits.m_slotCount.handle(), hits.m_slotSums.handle());
        return;
    }
    places.enqueue(device, m_slotKept, m_keptFirst, UINT32_MAX, counters);  // they are in order
    m_write.launch(device, width, listGroup(device), hits.m_hits.handle(), cl_uint(hits.m_hits.capacity()),
                   hits.m_slotFirst.handle(), copyParts(device), m_kept.handle(), m_keptFirst.handle(),
                   contacts.handle(), counters.handle());
}
}  // namespace drape
