// Ordering sorts a step's unsorted contacts into canonical order (kernels/shared/contact.h).
//
// Input: hits() filled, each slot's number of contacts, and the total in the step's counters. Output: contacts(), and
// their number in the counters; the slots' numbers and the next step's counters are left zero. Guarantee: the host's
// contacts, bit for bit. A full list still counts its demand, and the step must run again with a larger one. Cost:
// two or three launches on a GPU with few slots, else three to five.
#pragma once

#include <cstdint>

#include "hit_buffers.h"
#include "slot_places.h"

namespace drape
{
// Counters of the step and of the next step. m_ordered: a separate launch sorts slots with too many contacts for the
// last launch. Without it the step must run again if the counters show such slots. m_hits: expected number of
// contacts; affects speed alone.
struct StepTally
{
    Buffer<StepCounters>& m_now;
    Buffer<StepCounters>& m_next;
    bool m_ordered = true;
    std::size_t m_hits = SIZE_MAX;
};

class OrderingStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Makes room for the slots of a cloth side: its nodes, faces and edges.
    void resizeSlots(Device& device, std::size_t slotCount);
    // Reserves memory for a list of unsorted contacts and as many sorted ones.
    void reserveHits(Device& device, std::size_t count);
    std::size_t hitCapacity() const { return m_hits.capacity(); }
    // Releases the memory of both lists; reserve it again before use.
    void giveBackRoom();

    // Buffers for the unsorted contacts of the stages before.
    HitBuffers hits() { return {m_hits, m_hitPlaces, m_slotCount, m_slotSums}; }
    // Contacts, behind a head of DRAPE_CONTACT_HEAD elements that holds the step's counters.
    Buffer<Contact>& contacts() { return m_contacts; }

    // Returns after enqueueing.
    void enqueue(Device& device, StepTally tally);

private:
    // Returns whether slots are few on a GPU, so that every work-item sums for itself.
    bool hasSums() { return m_slotSums.capacity() > 0; }
    void enqueueGather(Device& device, StepTally tally, cl_uint ranked);
    void enqueueOrder(Device& device, StepTally tally, cl_uint ranked);
    void reserveHitPlaces(Device& device);

    SlotPlaces m_places;
    Kernel m_gather, m_gatherFew, m_order, m_write;
    Buffer<Contact> m_hits{"step hits"}, m_contacts{"step contacts"};
    Buffer<cl_uint> m_hitPlaces{"step hits"}, m_slotSums{"cloth slots"};  // on a GPU, where slots are few
    Buffer<cl_uint> m_slotCount{"cloth slots"}, m_slotFirst{"cloth slots"};
    Buffer<cl_uint> m_members{"step hits"}, m_keys{"step hits"};
};
}  // namespace drape
