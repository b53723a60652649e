// Where the hits of each slot begin in a list by slots: sums over the numbers of those before (kernels/compaction.cl).
//
// Input: how many hits each slot has. Output: the first place of each, and in the step's counters how many hits there
// are and how many slots have more than so many. Cost: one launch where slots are few, else two.
#pragma once

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "kernels/shared/mesh.h"
#include "kernels/shared/slot_sums.h"

namespace drape
{
// Room for so many slots' numbers of which sums are read by whole rows.
inline std::size_t wholeRows(std::size_t slots)
{
    return (slots + DRAPE_SUMMED - 1) / DRAPE_SUMMED * DRAPE_SUMMED;
}

class SlotPlaces
{
public:
    static constexpr std::size_t kBlock = 1024;  // slots per work-group, as in kernels/compaction.cl

    void create(Device& device, const cl::Program& compaction);
    void resize(Device& device, std::size_t slotCount);

    std::size_t slotCount() const { return m_slots; }
    bool few() const { return m_slots <= kFewSlots; }
    // Returns after enqueueing. The counter of crowded slots, those with more than `ranked` hits, counts on.
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
