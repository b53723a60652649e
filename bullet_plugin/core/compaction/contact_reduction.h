// Leaves out the contacts that others imply (kernels/lib/contact_reduction.h), as a part of compaction. Host and device
// keep the same.
//
// Input: a step's hits by slots, where both sides are, and how far nodes may be from their ways. Output: the contacts
// that stay, in canonical order, and their number in the step's counters. Cost on a device: two launches where slots
// are few on a GPU, else three or four.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "bullet_plugin/core/threads/thread_team.h"
#include "kernels/lib/contact_reduction.h"
#include "slot_places.h"

namespace drape
{
// slotCount: of the cloth side. The contacts are in canonical order, and those that stay are.
void reduceOnHost(std::vector<Contact>& contacts, const ReductionView& view, std::size_t slotCount,
                  ThreadTeam& threads);

// What it reads of the sides.
struct ReductionBuffers
{
    Buffer<float>& m_clothStart;
    Buffer<float>& m_clothEnd;
    Buffer<Triangle>& m_clothTriangles;
    Buffer<Edge>& m_clothEdges;
    Buffer<MeshFirsts>& m_cloths;
    Buffer<MeshFirsts>& m_obstacles;
    std::size_t m_clothCount;
    std::size_t m_obstacleCount;
    Buffer<float>& m_thickness;
    Buffer<float>& m_tube;
};

// A step's hits by slots: those of a slot stand in members from its first place on. On a GPU slots with more than 256
// of them are in order, which the others need not be.
struct SlotHits
{
    Buffer<Contact>& m_hits;
    Buffer<cl_uint>& m_slotFirst;
    Buffer<cl_uint>& m_members;
    Buffer<cl_uint>& m_slotCount;  // left zero for the next step where there are sums, as these
    Buffer<cl_uint>& m_slotSums;
};

// How many hits of each slot stay, and sums over these where slots are few on a GPU. There both must be zero before.
struct KeptCounts
{
    cl::Buffer m_slotKept;
    cl::Buffer m_keptSums;
};

class ContactReductionStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // sums: whether slots are few, on a GPU.
    void resizeSlots(Device& device, std::size_t slotCount, bool sums);
    void reserveHits(Device& device, std::size_t count) { m_kept.reserve(device, count); }

    // Handles of what is to be zero before, null where nothing is.
    KeptCounts keptCounts(bool reduces);
    // Returns after enqueueing. expectedHits: about as many; speed alone depends on it. places: of these slots.
    void enqueue(Device& device, SlotHits hits, const ReductionBuffers& sides, std::size_t expectedHits,
                 SlotPlaces& places, Buffer<Contact>& contacts, Buffer<StepCounters>& counters);

private:
    void enqueueKeep(Device& device, SlotHits hits, const ReductionBuffers& sides, std::size_t expectedHits,
                     Buffer<StepCounters>& counters);

    Kernel m_keep, m_write, m_writeFew;
    Buffer<cl_uint> m_kept{"step hits"};
    Buffer<cl_uint> m_slotKept{"cloth slots"}, m_keptFirst{"cloth slots"}, m_keptSums{"cloth slots"};
    std::size_t m_slots = 0;
};
}  // namespace drape
