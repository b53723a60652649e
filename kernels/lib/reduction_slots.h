// What the kernels take that tell which hits of each slot stay: contact_reduction_hits.cl and contact_reduction_slots.cl, which
// come to the same. For OpenCL C only.
#ifndef DRAPE_LIB_REDUCTION_SLOTS_H
#define DRAPE_LIB_REDUCTION_SLOTS_H

#include "../shared/patch.h"
#include "contact_reduction.h"
#include "hit_list.h"

// Contacts of a cloth with itself all stay: nothing rests there for others to be implied by.
static int isSelf(const SlotLists* lists, const uint first)
{
    return lists->m_hits[lists->m_members[first]].m_kind >= DRAPE_SELF_NODE_FACE;
}

// hits, slotFirst, members: see SlotLists; which slots' members must be in order, each kernel says. Members stay as they are,
// since faces and edges read those of their nodes. kept gets at the front of each slot the members that stay, in order, and
// DRAPE_NO_FEATURE behind them; slotKept their number. counters->m_hits is then free. share: what a group takes.
#define DRAPE_KEEP_ARGUMENTS \
    __global const Contact* restrict hits, const uint hitCapacity, __global const uint* restrict slotFirst, \
    const uint slots, const uint share, __global const uint* restrict members, __global uint* kept, \
    __global uint* restrict slotKept, __global const StepCounters* restrict counters, __global const float* restrict start, \
    __global const float* restrict end, __global const Triangle* restrict triangles, __global const Edge* restrict edges, \
    __global const MeshFirsts* restrict cloths, __global const MeshFirsts* restrict obstacles, const uint clothCount, \
    const uint obstacleCount, __global const float* restrict thickness, __global const float* restrict tube
#define DRAPE_KEEP_VIEW \
    {start, end, triangles, edges, cloths, obstacles, clothCount, obstacleCount, thickness, tube}
#define DRAPE_KEEP_LISTS {hits, members, slotFirst, slots, min(counters->m_hits, hitCapacity)}

#endif
