// Computes where the unsorted contacts of each slot (cloth feature) begin in a list ordered by slot: a prefix sum
// over the slots' counts (kernels/ordering/ordering.cl).
//
// Input: the number of contacts of each slot. Output: the first position of each slot and, in the step's counters,
// the number of contacts and of slots with more than a given number. Cost: one launch with few slots, else two.
#pragma once

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "kernels/shared/mesh.h"
#include "kernels/shared/slot_sums.h"

namespace drape
{
// Makes room for the numbers of that many slots. Sums of them are read in whole rows.
inline std::size_t wholeRows(std::size_t slots)
{
    return (slots + DRAPE_SUMMED - 1) / DRAPE_SUMMED * DRAPE_SUMMED;
}

class SlotPlaces
{
public:
    static constexpr std::size_t kBlock = 1024;  // slots per work-group, as in kernels/ordering/ordering.cl

    void create(Device& device, const cl::Program& ordering);
    void resize(Device& device, std::size_t slotCount);

    std::size_t slotCount() const { return m_slots; }
    bool few() const { return m_slots <= kFewSlots; }
    // Returns after enqueueing. Increments the counter of crowded slots, which have more than `ranked` contacts.
    void enqueue(Device& device, Buffer<cl_uint>& slotCounts, Buffer<cl_uint>& slotFirsts, cl_uint ranked,
                 Buffer<StepCounters>& counters);

private:
    static constexpr std::size_t kFewSlots = DRAPE_MOST_SUMMED;  // each group sums those before its own
    static constexpr std::size_t kGroupGpu = 256, kGroupCpu = 64;

    Kernel m_count, m_place;
    Buffer<cl_uint> m_blockCount{"cloth slots"};
    std::size_t m_slots = 0;
};
}  // namespace drape
