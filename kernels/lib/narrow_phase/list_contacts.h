// Lists unsorted contacts of a step (ContactSink). For kernels only.
#ifndef DRAPE_LIB_LIST_CONTACTS_H
#define DRAPE_LIB_LIST_CONTACTS_H

#include "../ordering/feature_sums.h"
#include "../step_data/step_views.h"

#ifndef DRAPE_CPU_KERNELS
// Vectors per contact. A listed contact is aligned to one; a narrower store costs a GPU's memory more.
#define DRAPE_CONTACT_QUARTERS 4
typedef char ContactFits[sizeof(Contact) == DRAPE_CONTACT_QUARTERS * sizeof(uint4) ? 1 : -1];

// Copies a contact; `parts` neighbouring work-items do so together, each some quarters of it.
static void copyContact(__global Contact* to, __global const Contact* from, const uint parts)
{
    for (uint k = get_global_id(0) % parts; k < DRAPE_CONTACT_QUARTERS; k += parts)
        ((__global uint4*)to)[k] = ((__global const uint4*)from)[k];
}

static void storeListed(__global Contact* to, const Contact* from)
{
    __global uint4* quarters = (__global uint4*)to;
    const float *n = from->m_normal, *p = from->m_point, *w = from->m_weights;
    quarters[0] = (uint4)(from->m_featureIndex, from->m_kind, from->m_clothFeature, from->m_obstacleFeature);
    quarters[1] = as_uint4((float4)(n[0], n[1], n[2], from->m_gap1));
    quarters[2] = as_uint4((float4)(p[0], p[1], p[2], from->m_gap0));
    quarters[3] = as_uint4((float4)(w[0], w[1], w[2], from->m_time));
}

// sums: position of the sums behind the features' numbers; 0 where they are not kept.
static ContactSink contactSink(__global Contact* contacts, const uint capacity, __global uint* ranks,
                               __global uint* featureCounts, const uint sums, __global StepCounters* counters)
{
    ContactSink sink;
    sink.m_contacts = contacts;
    sink.m_capacity = capacity;
    sink.m_ranks = sums > 0 ? ranks : 0;
    sink.m_featureCounts = featureCounts;
    sink.m_sums = sums > 0 ? featureCounts + sums : 0;
    sink.m_found = &counters->m_contactsFound;
    return sink;
}
#else
static void storeListed(Contact* to, const Contact* from)
{
    *to = *from;
}
#endif

static void listContact(const ContactSink* sink, const Contact* contact)
{
    const uint index = atomic_inc(sink->m_found);
    if (index >= sink->m_capacity) return;
    const uint before = atomic_inc(sink->m_featureCounts + contact->m_featureIndex);
    storeListed(sink->m_contacts + index, contact);
    if (!sink->m_ranks) return;
    sink->m_ranks[index] = before;
    addToSums(sink->m_sums, contact->m_featureIndex, 1);
}

// Lists several contacts at once, on a CPU: its cores take turns at the list's length, and an atomic waits for the
// stores before it.
static void listContacts(const ContactSink* sink, const Contact* contacts, const uint count)
{
    const uint first = count > 0 ? atomic_add(sink->m_found, count) : 0;
    const uint listed = first < sink->m_capacity ? min(count, sink->m_capacity - first) : 0;
    for (uint i = 0; i < listed; ++i)
        atomic_inc(sink->m_featureCounts + contacts[i].m_featureIndex);
    for (uint i = 0; i < listed; ++i)
        storeListed(sink->m_contacts + first + i, contacts + i);
}

#endif
