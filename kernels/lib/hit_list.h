// The list of a step's hits, in no particular order: compaction.cl brings them into the canonical one. For OpenCL C only.
#ifndef DRAPE_LIB_HIT_LIST_H
#define DRAPE_LIB_HIT_LIST_H

#include "../shared/contact.h"
#include "../shared/mesh.h"

// What a kernel that finds hits writes. slotCount counts those of each slot that are in the list; it and counters->m_listed
// must be zero before the step's first such kernel. m_listed counts on when the list is full.
#define DRAPE_HIT_ARGUMENTS \
    __global Contact *restrict hits, const uint hitCapacity, __global volatile uint *slotCount, __global StepCounters *counters
#define DRAPE_HIT_LIST                                            \
    {                                                             \
        hits, hitCapacity, slotCount, &counters->m_listed         \
    }

typedef struct HitList
{
    __global Contact* m_hits;
    uint m_capacity;
    __global volatile uint* m_slotCount;
    __global volatile uint* m_count;
} HitList;

static void listHit(const HitList* list, const Contact* contact)
{
    const uint place = atomic_inc(list->m_count);
    if (place >= list->m_capacity) return;
    atomic_inc(list->m_slotCount + contact->m_slot);  // before the stores: on a CPU it would wait for them
    list->m_hits[place] = *contact;
}

#endif
