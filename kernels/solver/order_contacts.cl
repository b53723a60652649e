// Sorts a step's contacts into the buckets of their groups, kinds and colours, as sweeps visit them, and begins their
// bounding planes. Also sorts the nodes' paths by the leaves of their cloths.
//
// The contacts of a feature stay adjacent and in their order. Where a feature's contacts are in their bucket depends on
// the order of work-items, and no result depends on it.
#define DRAPE_NODE_SPACE __global
#include "../lib/geometry/vec3.h"
#include "../lib/solver/acting_contact.h"
#include "../lib/solver/closing_sweeps.h"
#include "solver_bindings.h"

// Maximum contacts of a feature, see DRAPE_ROUND_TAG().
#define DRAPE_MOST_RANKS 0xffffu

static uint contactCount(__global const Contact* contacts)
{
    return ((__global const StepCounters*)contacts)->m_contactsStored;
}

// Contacts of one feature, which are adjacent.
typedef struct Run
{
    uint m_bucket;
    uint m_count;
} Run;

// Returns the run that begins at the index; an empty one if none does, or if no cloth of the step has the feature.
static Run runAt(__global const SolveFeature* features, __global const Contact* contacts, const uint index,
                 const uint count)
{
    __global const Contact* first = contacts + DRAPE_CONTACT_HEAD + index;
    Run run;
    run.m_bucket = features[first->m_featureIndex].m_bucket;
    run.m_count = 0;
    if (run.m_bucket == DRAPE_NO_BUCKET) return run;
    if (index > 0 && first[-1].m_featureIndex == first->m_featureIndex) return run;
    while (index + run.m_count < count && first[run.m_count].m_featureIndex == first->m_featureIndex)
        ++run.m_count;
    return run;
}

__kernel void takePaths(DRAPE_ORDER_CONTACTS)
{
    __global const NodePath* given = (__global const NodePath*)(input + layout.m_givenPaths);
    __global const Vec3* accelerations = (__global const Vec3*)(input + layout.m_givenAccelerations);
    __global const Vec3* supports = (__global const Vec3*)(input + layout.m_givenSupports);
    __global const uint* nodeOrder = (__global const uint*)(topology + layout.m_nodeOrder);
    for (uint i = get_global_id(0); i < layout.m_nodeCount; i += get_global_size(0))
    {
        ((__global NodePath*)(work + layout.m_paths))[i] = given[nodeOrder[i]];
        ((__global Vec3*)(work + layout.m_accelerations))[i] = accelerations[nodeOrder[i]];
        ((__global Vec3*)(work + layout.m_supports))[i] = supports[nodeOrder[i]];
    }
}

__kernel void countContacts(DRAPE_ORDER_CONTACTS)
{
    __global const SolveFeature* features = (__global const SolveFeature*)(topology + layout.m_features);
    __global const uint* cloths = (__global const uint*)(topology + layout.m_bucketCloths);
    __global SolveBucket* buckets = (__global SolveBucket*)(work + layout.m_buckets);
    __global SolveProgress* progress = (__global SolveProgress*)(work + layout.m_progress);
    const uint count = contactCount(contacts);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const Run run = runAt(features, contacts, i, count);
        if (run.m_count == 0) continue;
        __global SolveProgress* cloth = progress + cloths[run.m_bucket];
        atomic_add(&buckets[run.m_bucket].m_count, run.m_count);
        atomic_add(&cloth->m_blocks, (run.m_count + DRAPE_BLOCK_CONTACTS - 1) / DRAPE_BLOCK_CONTACTS);
        if (run.m_count > DRAPE_MOST_RANKS) cloth->m_refused = 1;
    }
}

__kernel void placeBuckets(DRAPE_ORDER_CONTACTS)
{
    __global SolveBucket* buckets = (__global SolveBucket*)(work + layout.m_buckets);
    for (uint i = get_global_id(0); i < layout.m_bucketCount; i += get_global_size(0))
        if (buckets[i].m_count > 0)
            buckets[i].m_first = atomic_add((__global uint*)(work + layout.m_total), buckets[i].m_count);
}

__kernel void gatherContacts(DRAPE_ORDER_CONTACTS)
{
    __global const SolveFeature* features = (__global const SolveFeature*)(topology + layout.m_features);
    __global SolveBucket* buckets = (__global SolveBucket*)(work + layout.m_buckets);
    __global SolveContact* sorted = (__global SolveContact*)(work + layout.m_sorted);
    __global uint* order = (__global uint*)(work + layout.m_order);
    const uint count = contactCount(contacts);
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const Run run = runAt(features, contacts, i, count);
        if (run.m_count == 0) continue;
        __global SolveBucket* bucket = buckets + run.m_bucket;
        const uint first = bucket->m_first + atomic_add(&bucket->m_filled, run.m_count);
        for (uint rank = 0; rank < run.m_count; ++rank)
        {
            order[first + rank] = i + rank;
            sorted[first + rank].m_rank = rank;
        }
    }
}

// Sets the bounding planes, and marks the nodes with contacts.
__kernel void prepareContacts(DRAPE_ORDER_CONTACTS)
{
    __global const SolveFeature* features = (__global const SolveFeature*)(topology + layout.m_features);
    __global const uint* cloths = (__global const uint*)(topology + layout.m_bucketCloths);
    __global SolveContact* sorted = (__global SolveContact*)(work + layout.m_sorted);
    __global const uint* order = (__global const uint*)(work + layout.m_order);
    __global SolveProgress* progress = (__global SolveProgress*)(work + layout.m_progress);
    const uint total = *(__global const uint*)(work + layout.m_total);
    for (uint i = get_global_id(0); i < total; i += get_global_size(0))
    {
        __global const Contact* found = contacts + DRAPE_CONTACT_HEAD + order[i];
        const SolveFeature feature = features[found->m_featureIndex];
        __global const SolveCloth* cloth =
            (__global const SolveCloth*)(input + layout.m_cloths) + cloths[feature.m_bucket];
        __global const NodePath* paths = (__global const NodePath*)(work + layout.m_paths) + cloth->m_nodes.m_first;
        __global SolveAllowance* allowances =
            (__global SolveAllowance*)(work + layout.m_allowances) + cloth->m_nodes.m_first;
        SolveContact contact;
        contact.m_normal = vec3Load(found->m_normal, 0);
        const Vec3 first = paths[feature.m_nodes[0]].m_start;
        Vec3 start = first;
        uint count = 0;
        for (uint k = 0; k < 3; ++k)
        {
            const int isUsed = feature.m_nodes[k] != DRAPE_NO_NODE;
            contact.m_nodes[k] = isUsed ? feature.m_nodes[k] : feature.m_nodes[0];
            if (!isUsed) continue;
            ++count;
            allowances[feature.m_nodes[k]].m_hasContact = 1;
            if (k > 0)
                start = vec3AddScaled(start, vec3Sub(paths[feature.m_nodes[k]].m_start, first), found->m_weights[k]);
        }
        const Vec3 apart = vec3Sub(vec3Load(found->m_point, 0), start);
        contact.m_level = cloth->m_mostThickness + vec3Dot(contact.m_normal, apart) + cloth->m_margin;
        contact.m_weights[0] = found->m_weights[1];
        contact.m_weights[1] = found->m_weights[2];
        contact.m_flags = (contactTurns(found) ? DRAPE_CONTACT_TURNS : 0u) | count << 8;
        contact.m_pushing = 0;
        contact.m_rank = sorted[i].m_rank;
        if (found->m_time < 1.0f) progress[cloths[feature.m_bucket]].m_meets = 1;
        sorted[i] = contact;
    }
}
