// Ordering sorts a step's unsorted contacts into canonical order (kernels/shared/contact.h).
//
// Input: unsorted contacts, each feature's number of them, and the total in the step's counters. Output: contacts(),
// and their number in the counters; the features' numbers and the next step's counters are left zero. Guarantee: the
// host's contacts, bit for bit. A full list still counts its demand, and the step must run again with a larger one.
// Cost: two or three launches on a GPU with few features, else three to five.
#pragma once

#include <cstdint>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "bullet_plugin/core/lists/unsorted_contacts.h"
#include "kernels/ordering/ordering_bindings.h"

namespace drape
{
// Counters of the step and of the next step. m_ordered: a separate launch sorts features with too many contacts for the
// last launch. Without it the step must run again if the counters show such features. m_contacts: expected number of
// contacts; affects speed alone.
struct StepTally
{
    Buffer<StepCounters>& m_now;
    Buffer<StepCounters>& m_next;
    bool m_ordered = true;
    std::size_t m_contacts = SIZE_MAX;
};

class OrderingStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Makes room for the cloth features' positions.
    void resizeFeatures(Device& device, std::size_t features);
    // Makes room for as many contacts as the unsorted list has.
    void reserve(Device& device, std::size_t count);
    // Releases the contacts' memory; reserve it again before use.
    void release();

    // Contacts, behind a head of DRAPE_CONTACT_HEAD elements that holds the step's counters.
    Buffer<Contact>& contacts() { return m_contacts; }

    // Returns after enqueueing.
    void enqueue(Device& device, UnsortedContacts& unsorted, StepTally tally);

private:
    void enqueuePositions(Device& device, const OrderingValues& step, UnsortedContacts& unsorted, StepTally tally);
    void enqueueGather(Device& device, const OrderingValues& step, UnsortedContacts& unsorted, StepTally tally);
    void enqueueSort(Device& device, const OrderingValues& step, StepTally tally);

    BoundKernel<kernels::orderingCount> m_count;
    BoundKernel<kernels::orderingPlace> m_place;
    BoundKernel<kernels::orderingGather> m_gather;
    BoundKernel<kernels::orderingGatherSmall> m_gatherSmall;
    BoundKernel<kernels::orderingSort> m_sort;
    BoundKernel<kernels::orderingWrite> m_write;
    Buffer<Contact> m_contacts{"step contacts"};
    Buffer<cl_uint> m_firsts{"cloth features"}, m_blockCounts{"cloth features"};
    Buffer<cl_uint> m_members{"unsorted contacts"}, m_keys{"unsorted contacts"};
};
}  // namespace drape
