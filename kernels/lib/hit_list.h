// A step's list of unsorted contacts; ordering sorts it into canonical order. For kernels only.
#ifndef DRAPE_LIB_HIT_LIST_H
#define DRAPE_LIB_HIT_LIST_H

#include "../shared/contact.h"
#include "../shared/mesh.h"
#include "slot_sums.h"

// Outputs of a kernel that finds contacts. slotCount: number of listed contacts per slot. slotSums: sums of
// slotCount. hitPlaces: per contact, the number of its slot's contacts before it. The last two exist where slots are
// few on a GPU; elsewhere both are null. slotCount, slotSums and counters->m_contactsFound must be zero before the step's
// first such kernel. m_contactsFound counts on when the list is full.
#define DRAPE_HIT_ARGUMENTS                                                                                           \
    __global Contact *restrict hits, const uint hitCapacity, __global uint *restrict hitPlaces,                       \
        __global volatile uint *slotCount, __global volatile uint *slotSums, __global StepCounters *counters
#define DRAPE_HIT_LIST                                                         \
    {                                                                          \
        hits, hitCapacity, hitPlaces, slotCount, slotSums, &counters->m_contactsFound \
    }

typedef struct HitList
{
    __global Contact* m_hits;
    uint m_capacity;
    __global uint* m_hitPlaces;
    __global volatile uint* m_slotCount;
    __global volatile uint* m_slotSums;
    __global volatile uint* m_count;
} HitList;

#ifndef DRAPE_CPU_KERNELS
// Vectors per contact. A listed contact is aligned to one; a narrower store costs a GPU's memory more.
#define DRAPE_CONTACT_QUARTERS 4
typedef char ContactFits[sizeof(Contact) == DRAPE_CONTACT_QUARTERS * sizeof(uint4) ? 1 : -1];

// Copies a contact; `parts` neighbouring work-items do so together, each some quarters of it.
static void copyHit(__global Contact* to, __global const Contact* from, const uint parts)
{
    for (uint k = get_global_id(0) % parts; k < DRAPE_CONTACT_QUARTERS; k += parts)
        ((__global uint4*)to)[k] = ((__global const uint4*)from)[k];
}

static void storeHit(__global Contact* to, const Contact* from)
{
    __global uint4* quarters = (__global uint4*)to;
    const float *n = from->m_normal, *p = from->m_point, *w = from->m_weights;
    quarters[0] = (uint4)(from->m_slot, from->m_kind, from->m_clothFeature, from->m_obstacleFeature);
    quarters[1] = as_uint4((float4)(n[0], n[1], n[2], from->m_gap1));
    quarters[2] = as_uint4((float4)(p[0], p[1], p[2], from->m_gap0));
    quarters[3] = as_uint4((float4)(w[0], w[1], w[2], from->m_time));
}
#else
static void storeHit(Contact* to, const Contact* from)
{
    *to = *from;
}
#endif

static void listHit(const HitList* list, const Contact* contact)
{
    const uint place = atomic_inc(list->m_count);
    if (place >= list->m_capacity) return;
    const uint before = atomic_inc(list->m_slotCount + contact->m_slot);
    storeHit(list->m_hits + place, contact);
    if (!list->m_hitPlaces) return;
    list->m_hitPlaces[place] = before;
    addToSums(list->m_slotSums, contact->m_slot, 1);
}

// Lists several contacts at once, on a CPU: its cores take turns at the list's length, and an atomic waits for the
// stores before it.
static void listHits(const HitList* list, const Contact* contacts, const uint count)
{
    const uint first = count > 0 ? atomic_add(list->m_count, count) : 0;
    const uint listed = first < list->m_capacity ? min(count, list->m_capacity - first) : 0;
    for (uint i = 0; i < listed; ++i) atomic_inc(list->m_slotCount + contacts[i].m_slot);
    for (uint i = 0; i < listed; ++i) storeHit(list->m_hits + first + i, contacts + i);
}

#endif
