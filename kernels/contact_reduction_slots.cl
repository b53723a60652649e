// Which hits of each slot stay (lib/contact_reduction.h), on a CPU: a work-item reduces slots one after the other, alone.
#include "lib/ask_for.h"
#include "lib/reduction_slots.h"

// Most members that are sorted by insertion, which takes as long as a heap there.
#define DRAPE_INSERTED 128u

// Whether one of two members stands before the other: by depth, or by obstacle feature.
static int isBefore(__global const Contact* hits, const uint a, const uint b, const int byDepth)
{
    return byDepth ? isDeeper(hits + a, hits + b) : hits[a].m_obstacleFeature < hits[b].m_obstacleFeature;
}

// Makes members[root] … members[count - 1] a heap, last one first, in which only the root may be out of place.
static void siftDown(__global const Contact* hits, __global uint* members, uint root, const uint count, const int byDepth)
{
    const uint member = members[root];
    for (uint child = 2 * root + 1; child < count; child = 2 * root + 1)
    {
        if (child + 1 < count && isBefore(hits, members[child], members[child + 1], byDepth)) ++child;
        if (!isBefore(hits, member, members[child], byDepth)) break;
        members[root] = members[child];
        root = child;
    }
    members[root] = member;
}

static void heapSort(__global const Contact* hits, __global uint* members, const uint count, const int byDepth)
{
    for (uint root = count / 2; root-- > 0;) siftDown(hits, members, root, count, byDepth);
    for (uint end = count - 1; end > 0; --end)
    {
        const uint last = members[0];
        members[0] = members[end];
        members[end] = last;
        siftDown(hits, members, 0, end, byDepth);
    }
}

static void putInOrder(__global const Contact* hits, __global uint* members, const uint count, const int byDepth)
{
    if (count > DRAPE_INSERTED)
    {
        heapSort(hits, members, count, byDepth);
        return;
    }
    for (uint i = 1; i < count; ++i)
    {
        const uint member = members[i];
        uint j = i;
        for (; j > 0 && isBefore(hits, member, members[j - 1], byDepth); --j) members[j] = members[j - 1];
        members[j] = member;
    }
}

// kept: of the slot. Returns how many stay.
static uint reduceMembers(const ReductionView* view, const SlotLists* lists, __global uint* kept, const uint first,
                          const uint count)
{
    for (uint i = 0; i < count; ++i)
    {
        askFor(lists->m_hits + lists->m_members[min(first + i + DRAPE_AHEAD, lists->m_count - 1)]);
        kept[i] = lists->m_members[first + i];
    }
    uint stay = count;
    if (!isSelf(lists, first))
    {
        putInOrder(lists->m_hits, kept, count, 1);
        stay = reduceSlot(view, lists, kept, count);
    }
    putInOrder(lists->m_hits, kept, stay, 0);
    for (uint i = stay; i < count; ++i) kept[i] = DRAPE_NO_FEATURE;
    return stay;
}

// See reduction_slots.h; a group is a work-item, and takes a share of the slots. members: in any order.
__kernel __attribute__((reqd_work_group_size(1, 1, 1))) void reductionKeep(DRAPE_KEEP_ARGUMENTS)
{
    const ReductionView view = DRAPE_KEEP_VIEW;
    const SlotLists lists = DRAPE_KEEP_LISTS;
    const uint begin = min(slots, (uint)get_global_id(0) * share), last = min(slots, begin + share);
    for (uint slot = begin; slot < last; ++slot)
    {
        const uint first = slotFirst[slot], end = slotEnd(&lists, slot);
        slotKept[slot] = end > first ? reduceMembers(&view, &lists, kept + first, first, end - first) : 0;
    }
}
