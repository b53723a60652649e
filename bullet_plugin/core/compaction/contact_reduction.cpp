#include "contact_reduction.h"

#include <algorithm>

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
constexpr std::size_t kBlockCpu = 64;  // slots of a work-item
// On a GPU: groups of about so many hits, but as many per compute unit as make it busy.
constexpr std::size_t kGroupGpu = 128;
constexpr std::size_t kHitsPerGroup = 2, kFewestGroupsPerUnit = 16, kMostGroupsPerUnit = 48;
constexpr std::size_t kMostBlockGpu = 64;  // slots, as in kernels/contact_reduction_hits.cl

std::size_t slotsPerGroup(const Device& device, std::size_t slots, std::size_t expectedHits)
{
    if (!device.isGpu()) return kBlockCpu;
    const std::size_t units = device.computeUnits();
    const std::size_t groups =
        std::clamp(expectedHits / kHitsPerGroup, kFewestGroupsPerUnit * units, kMostGroupsPerUnit * units);
    return std::clamp(slots / groups, std::size_t(1), kMostBlockGpu);
}
}  // namespace

void ContactReductionStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program reduction = load("contact_reduction");
    const bool gpu = device.isGpu();
    m_keep.create(device, load(gpu ? "contact_reduction_hits" : "contact_reduction_slots"),
                  gpu ? "reductionKeepWide" : "reductionKeep");
    m_write.create(device, reduction, "reductionWrite");
    m_writeFew.create(device, reduction, "reductionWriteFew");
}

void ContactReductionStage::resizeSlots(Device& device, std::size_t slotCount)
{
    m_slots = slotCount;
    m_slotKept.reserve(device, slotCount);
    m_keptFirst.reserve(device, slotCount);
}

void ContactReductionStage::enqueueKeep(Device& device, SlotHits hits, const ReductionBuffers& sides,
                                        std::size_t expectedHits, Buffer<StepCounters>& counters)
{
    const std::size_t group = device.isGpu() ? kGroupGpu : 1;
    const std::size_t block = slotsPerGroup(device, m_slots, expectedHits);
    m_keep.launch(device, (m_slots + block - 1) / block * group, group, hits.m_hits.handle(),
                  cl_uint(hits.m_hits.capacity()), hits.m_slotFirst.handle(), cl_uint(m_slots), cl_uint(block),
                  hits.m_members.handle(), m_kept.handle(), m_slotKept.handle(), counters.handle(),
                  sides.m_clothStart.handle(), sides.m_clothEnd.handle(), sides.m_clothTriangles.handle(),
                  sides.m_clothEdges.handle(), sides.m_cloths.handle(), sides.m_obstacles.handle(),
                  cl_uint(sides.m_clothCount), cl_uint(sides.m_obstacleCount), sides.m_thickness.handle(),
                  sides.m_tube.handle());
}

void ContactReductionStage::enqueue(Device& device, SlotHits hits, const ReductionBuffers& sides,
                                    std::size_t expectedHits, SlotPlaces& places, Buffer<Contact>& contacts,
                                    Buffer<StepCounters>& counters)
{
    enqueueKeep(device, hits, sides, expectedHits, counters);
    places.enqueue(device, m_slotKept, m_keptFirst, UINT32_MAX, counters);  // they are in order
    m_write.launch(device, listWidth(device), listGroup(device), hits.m_hits.handle(), cl_uint(hits.m_hits.capacity()),
                   hits.m_slotFirst.handle(), copyParts(device), m_kept.handle(), m_keptFirst.handle(),
                   contacts.handle(), counters.handle());
}

void ContactReductionStage::enqueueFew(Device& device, SlotHits hits, const ReductionBuffers& sides,
                                       std::size_t expectedHits, Buffer<Contact>& contacts,
                                       Buffer<StepCounters>& counters)
{
    enqueueKeep(device, hits, sides, expectedHits, counters);
    const std::size_t group = SlotPlaces::kGroupGpu;
    m_writeFew.launch(device, fewWidth(m_slots), group, hits.m_hits.handle(), cl_uint(hits.m_hits.capacity()),
                      hits.m_slotFirst.handle(), cl_uint(m_slots), cl_uint(kFewBlock), copyParts(device),
                      m_kept.handle(), m_slotKept.handle(), contacts.handle(), counters.handle(),
                      cl::Local(group * sizeof(cl_uint)));
}
}  // namespace drape
