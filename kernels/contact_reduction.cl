// Reduction of the hits of each slot (lib/contact_reduction.h), between the compaction's order and its writing. Slots with few
// hits are a work-item's, crowded ones a work-group's; on a GPU each hit of the former is a work-item's. All come to the same
// contacts.
#include "lib/contact_reduction.h"
#include "lib/group_scan.h"
#include "lib/hit_list.h"
#include "lib/item_runs.h"
#include "shared/patch.h"

// Most slots and work-items of a group.
#define DRAPE_BLOCK 1024
#define DRAPE_REDUCE_GROUP 64

// What is known of a member of a crowded slot; places of hits are less.
#define DRAPE_DROPPED 0x80000000u
#define DRAPE_KEEPER 0x40000000u

// Puts a few members in order: by depth, or by obstacle feature.
static void sortFew(__global const Contact* hits, __global uint* members, const uint count, const int byDepth)
{
    for (uint i = 1; i < count; ++i)
    {
        const uint member = members[i];
        uint j = i;
        for (; j > 0; --j)
        {
            __global const Contact* before = hits + members[j - 1];
            const int stays = byDepth ? isDeeper(before, hits + member)
                                      : before->m_obstacleFeature < hits[member].m_obstacleFeature;
            if (stays) break;
            members[j] = members[j - 1];
        }
        members[j] = member;
    }
}

// Contacts of a cloth with itself all stay: nothing rests there for others to be implied by.
static int isSelf(const SlotLists* lists, const uint first)
{
    return lists->m_hits[lists->m_members[first]].m_kind >= DRAPE_SELF_NODE_FACE;
}

// A work-item reduces a slot of at most DRAPE_RANKED members. Returns how many stay.
static uint reduceFew(const ReductionView* view, const SlotLists* lists, __global uint* kept, const uint first,
                      const uint count)
{
    for (uint i = 0; i < count; ++i) kept[first + i] = lists->m_members[first + i];
    uint stay = count;
    if (!isSelf(lists, first))
    {
        sortFew(lists->m_hits, kept + first, count, 1);
        stay = reduceSlot(view, lists, kept + first, count);
    }
    sortFew(lists->m_hits, kept + first, stay, 0);
    for (uint i = stay; i < count; ++i) kept[first + i] = DRAPE_NO_FEATURE;
    return stay;
}

// The group's deepest member that nothing is known of, DRAPE_NO_FEATURE without one. Each work-item looks at its own.
static uint deepestLeft(const SlotLists* lists, __global const uint* kept, const uint count, __local uint* scratch)
{
    const uint id = get_local_id(0);
    uint best = DRAPE_NO_FEATURE;
    for (uint i = id; i < count; i += get_local_size(0))
    {
        if (kept[i] & (DRAPE_DROPPED | DRAPE_KEEPER)) continue;
        if (best == DRAPE_NO_FEATURE || isDeeper(lists->m_hits + kept[i], lists->m_hits + kept[best])) best = i;
    }
    scratch[id] = best;
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    uint width = get_local_size(0) / 2;
    do
    {
        if (id < width)
        {
            const uint a = scratch[id], b = scratch[id + width];
            if (a == DRAPE_NO_FEATURE ||
                (b != DRAPE_NO_FEATURE && isDeeper(lists->m_hits + kept[b], lists->m_hits + kept[a])))
                scratch[id] = b;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        width /= 2;
    } while (width > 0);
    best = scratch[0];
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    return best;
}

// Each work-item drops those of its own members that the nodes or the keeper, which may be null, imply.
static void dropImplied(const ReductionView* view, const SlotLists* lists, const ReducedFeature* feature,
                        __global uint* kept, const uint count, __global const Contact* keeper)
{
    NodeBounds bounds = noBounds();
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        if (kept[i] & (DRAPE_DROPPED | DRAPE_KEEPER)) continue;
        __global const Contact* contact = lists->m_hits + kept[i];
        const uint pair = pairOf(view, feature->m_cloth, contact);
        if (!isReducible(view, contact, pair)) continue;
        boundNodes(view, lists, feature, contact, pair, &bounds);
        if (bounds.m_lack <= 0.0f || (keeper && impliedBy(view, feature, &bounds, contact, pair, keeper)))
            kept[i] |= DRAPE_DROPPED;
    }
}

// Brings the members that stay to the front in the order that they have. Returns how many they are.
static uint closeRanks(__global uint* kept, const uint count, __local uint* scratch)
{
    uint stay = 0, base = 0;
    do
    {
        const uint i = base + get_local_id(0);
        const uint member = i < count ? kept[i] : DRAPE_DROPPED;
        const uint stays = !(member & DRAPE_DROPPED);
        uint total;
        barrier(CLK_GLOBAL_MEM_FENCE);  // all of this stretch are read before any is written
        const uint before = groupPrefix(scratch, stays, &total);
        if (stays) kept[stay + before] = member & ~DRAPE_KEEPER;
        stay += total;
        base += get_local_size(0);
    } while (base < count);
    barrier(CLK_GLOBAL_MEM_FENCE);
    for (uint i = stay + get_local_id(0); i < count; i += get_local_size(0)) kept[i] = DRAPE_NO_FEATURE;
    return stay;
}

// A work-group reduces a slot whose members are in order: a round finds the deepest that is left and drops what it implies.
// Returns how many stay.
static uint reduceCrowded(const ReductionView* view, const SlotLists* lists, __global uint* kept, const uint first,
                          const uint count, __local uint* scratch)
{
    kept += first;
    for (uint i = get_local_id(0); i < count; i += get_local_size(0)) kept[i] = lists->m_members[first + i];
    if (isSelf(lists, first)) return count;
    const ReducedFeature feature = reducedFeature(view, lists, lists->m_hits + lists->m_members[first]);
    if (feature.m_mayEmpty) dropImplied(view, lists, &feature, kept, count, 0);
    uint rounds = 0, deepest;
    do
    {
        deepest = deepestLeft(lists, kept, count, scratch);
        if (deepest != DRAPE_NO_FEATURE)
        {
            if (deepest % get_local_size(0) == get_local_id(0)) kept[deepest] |= DRAPE_KEEPER;
            dropImplied(view, lists, &feature, kept, count, lists->m_hits + lists->m_members[first + deepest]);
        }
        ++rounds;
    } while (deepest != DRAPE_NO_FEATURE && rounds < DRAPE_KEEPERS);
    return closeRanks(kept, count, scratch);
}

// What both kernels take that tell which contacts stay; see reductionKeep.
#define DRAPE_KEEP_ARGUMENTS \
    __global const Contact* restrict hits, const uint hitCapacity, __global const uint* restrict slotFirst, \
    const uint slots, const uint block, __global const uint* restrict members, __global uint* kept, \
    __global uint* restrict slotKept, __global const StepCounters* restrict counters, __global const float* restrict start, \
    __global const float* restrict end, __global const Triangle* restrict triangles, __global const Edge* restrict edges, \
    __global const MeshFirsts* restrict cloths, __global const MeshFirsts* restrict obstacles, const uint clothCount, \
    const uint obstacleCount, __global const float* restrict thickness, __global const float* restrict tube
#define DRAPE_KEEP_VIEW \
    {start, end, triangles, edges, cloths, obstacles, clothCount, obstacleCount, thickness, tube}
#define DRAPE_KEEP_LISTS {hits, members, slotFirst, slots, min(counters->m_hits, hitCapacity)}

// A work-group takes a block of at most DRAPE_BLOCK slots. members: in order in slots with more than DRAPE_RANKED; they stay
// as they are, since faces and edges read those of their nodes. kept gets at the front of each slot the members that stay, in
// order, and DRAPE_NO_FEATURE behind them; slotKept their number. counters->m_hits is then free.
__kernel __attribute__((reqd_work_group_size(DRAPE_REDUCE_GROUP, 1, 1))) void reductionKeep(DRAPE_KEEP_ARGUMENTS)
{
    __local uint crowded[DRAPE_BLOCK];
    __local uint scratch[DRAPE_REDUCE_GROUP];
    __local uint crowdedCount;
    const ReductionView view = DRAPE_KEEP_VIEW;
    const SlotLists lists = DRAPE_KEEP_LISTS;
    const uint begin = get_group_id(0) * block, last = min(slots, begin + block);
    if (get_local_id(0) == 0) crowdedCount = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint slot = begin + get_local_id(0); slot < last; slot += get_local_size(0))
    {
        const uint first = slotFirst[slot], stop = slotEnd(&lists, slot);
        const uint count = stop > first ? stop - first : 0;
        if (count > DRAPE_RANKED)
            crowded[atomic_inc(&crowdedCount)] = slot;
        else
            slotKept[slot] = count > 0 ? reduceFew(&view, &lists, kept, first, count) : 0;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint toReduce = crowdedCount;
    for (uint i = 0; i < toReduce; ++i)
    {
        const uint slot = crowded[i];
        const uint stay =
            reduceCrowded(&view, &lists, kept, slotFirst[slot], slotEnd(&lists, slot) - slotFirst[slot], scratch);
        if (get_local_id(0) == 0) slotKept[slot] = stay;
    }
}

// Most slots of a group whose work-items take a hit each, and most hits that it holds at a time.
#define DRAPE_HELD_SLOTS 64
#define DRAPE_HELD 256
#define DRAPE_HELD_GROUP 128
#define DRAPE_UNDECIDED_HIT 0u
#define DRAPE_STAYS 1u
#define DRAPE_GOES 2u

// Consecutive slots and their hits, by their places among those that are held. m_lack is infinite where a hit may not go, and
// m_rank how many of its slot are deeper. Depth and height of a hit's nodes are three each, as ways of a slot's nodes are.
typedef struct Held
{
    uint m_first, m_count, m_slots;  // the first hit's place among all members; how many there are
    __local const uint* m_firsts;    // of the slots, by all members' places; one more than slots
    __local uint *m_slot, *m_rank, *m_state, *m_feature;
    __local float *m_gap, *m_lack, *m_depth, *m_height;
    __local uint *m_cloth, *m_nodes, *m_mayEmpty, *m_stay;
    __local Vec3* m_ways;
} Held;

static void holdSlots(const ReductionView* view, const SlotLists* lists, const Held* held)
{
    for (uint slot = get_local_id(0); slot < held->m_slots; slot += get_local_size(0))
    {
        held->m_stay[slot] = 0;
        if (held->m_firsts[slot + 1] == held->m_firsts[slot]) continue;
        __global const Contact* contact = lists->m_hits + lists->m_members[held->m_firsts[slot]];
        for (uint i = held->m_firsts[slot]; i < held->m_firsts[slot + 1]; ++i) held->m_slot[i - held->m_first] = slot;
        held->m_nodes[slot] = 0;  // of hits that all stay
        if (contact->m_kind >= DRAPE_SELF_NODE_FACE) continue;
        const ReducedFeature feature = reducedFeature(view, lists, contact);
        held->m_cloth[slot] = feature.m_cloth;
        held->m_nodes[slot] = (uint)feature.m_count;
        held->m_mayEmpty[slot] = (uint)feature.m_mayEmpty;
        for (int k = 0; k < feature.m_count; ++k) held->m_ways[3 * slot + k] = feature.m_way[k];
    }
}

// The slot's feature, but for its nodes' numbers.
static ReducedFeature heldFeature(const Held* held, const uint slot)
{
    ReducedFeature feature;
    feature.m_count = (int)held->m_nodes[slot];
    feature.m_cloth = held->m_cloth[slot];
    feature.m_mayEmpty = (int)held->m_mayEmpty[slot];
    for (int k = 0; k < feature.m_count; ++k) feature.m_way[k] = held->m_ways[3 * slot + k];
    return feature;
}

static void holdHits(const ReductionView* view, const SlotLists* lists, const Held* held)
{
    for (uint i = get_local_id(0); i < held->m_count; i += get_local_size(0))
    {
        __global const Contact* contact = lists->m_hits + lists->m_members[held->m_first + i];
        held->m_gap[i] = contact->m_gap1;
        held->m_feature[i] = contact->m_obstacleFeature;
        held->m_lack[i] = INFINITY;
        if (held->m_nodes[held->m_slot[i]] == 0) continue;
        const ReducedFeature feature = reducedFeature(view, lists, contact);
        const uint pair = pairOf(view, feature.m_cloth, contact);
        if (!isReducible(view, contact, pair)) continue;
        NodeBounds bounds = noBounds();
        boundNodes(view, lists, &feature, contact, pair, &bounds);
        held->m_lack[i] = bounds.m_lack;
        for (int k = 0; k < feature.m_count; ++k)
        {
            held->m_depth[3 * i + k] = bounds.m_depth[k];
            held->m_height[3 * i + k] = bounds.m_height[k];
        }
    }
}

// Ranks the hits, and drops those that the nodes alone imply.
static void rankHits(const Held* held)
{
    for (uint i = get_local_id(0); i < held->m_count; i += get_local_size(0))
    {
        const uint slot = held->m_slot[i];
        uint rank = 0;
        for (uint j = held->m_firsts[slot] - held->m_first; j < held->m_firsts[slot + 1] - held->m_first; ++j)
            rank += held->m_gap[j] < held->m_gap[i] ||
                    (held->m_gap[j] == held->m_gap[i] && held->m_feature[j] < held->m_feature[i]);
        held->m_rank[i] = rank;
        held->m_state[i] = held->m_nodes[slot] == 0 ? DRAPE_STAYS : DRAPE_UNDECIDED_HIT;
        if (held->m_lack[i] <= 0.0f && (rank > 0 || held->m_mayEmpty[slot])) held->m_state[i] = DRAPE_GOES;
    }
}

// Whether a hit is implied by the keeper of its slot, both by their places among those that are held.
static int heldImplied(const ReductionView* view, const SlotLists* lists, const Held* held, const uint i, const uint keeper)
{
    if (!(held->m_lack[i] < INFINITY)) return 0;
    __global const Contact* contact = lists->m_hits + lists->m_members[held->m_first + i];
    const ReducedFeature feature = heldFeature(held, held->m_slot[i]);
    NodeBounds bounds;
    bounds.m_normal = contactNormal(contact);
    bounds.m_pair = pairOf(view, feature.m_cloth, contact);
    bounds.m_lack = held->m_lack[i];
    for (int k = 0; k < feature.m_count; ++k)
    {
        bounds.m_depth[k] = held->m_depth[3 * i + k];
        bounds.m_height[k] = held->m_height[3 * i + k];
    }
    return impliedBy(view, &feature, &bounds, contact, bounds.m_pair,
                     lists->m_hits + lists->m_members[held->m_first + keeper]);
}

// In every round each slot's deepest hit that nothing is known of stays, and what it implies goes; then the rest stays.
// keepers: DRAPE_HELD_SLOTS for the round and as many for the next.
static void decideHits(const ReductionView* view, const SlotLists* lists, const Held* held, __local uint* keepers,
                       __local uint* left)
{
    const uint id = get_local_id(0), size = get_local_size(0);
    for (uint slot = id; slot < 2 * DRAPE_HELD_SLOTS; slot += size) keepers[slot] = UINT_MAX;
    if (id == 0) left[0] = left[1] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint round = 0; round < DRAPE_KEEPERS; ++round)
    {
        __local uint* now = keepers + (round & 1u) * DRAPE_HELD_SLOTS;
        __local uint* next = keepers + (~round & 1u) * DRAPE_HELD_SLOTS;
        for (uint i = id; i < held->m_count; i += size)
        {
            if (held->m_state[i] != DRAPE_UNDECIDED_HIT) continue;
            atomic_min(now + held->m_slot[i], held->m_rank[i] * DRAPE_HELD + i);
            left[round & 1u] = 1;
        }
        for (uint slot = id; slot < held->m_slots; slot += size) next[slot] = UINT_MAX;
        barrier(CLK_LOCAL_MEM_FENCE);
        const uint some = left[round & 1u];
        for (uint i = id; i < held->m_count && some; i += size)
        {
            if (held->m_state[i] != DRAPE_UNDECIDED_HIT) continue;
            const uint keeper = now[held->m_slot[i]] % DRAPE_HELD;
            if (keeper == i)
                held->m_state[i] = DRAPE_STAYS;
            else if (heldImplied(view, lists, held, i, keeper))
                held->m_state[i] = DRAPE_GOES;
        }
        if (id == 0) left[~round & 1u] = 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        if (!some) return;
    }
}

// Writes to the front of each slot what stays, by obstacle feature.
static void writeHeld(const SlotLists* lists, const Held* held, __global uint* kept)
{
    for (uint i = get_local_id(0); i < held->m_count; i += get_local_size(0))
        if (held->m_state[i] != DRAPE_GOES) atomic_inc(held->m_stay + held->m_slot[i]);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = get_local_id(0); i < held->m_count; i += get_local_size(0))
    {
        const uint slot = held->m_slot[i], first = held->m_firsts[slot];
        if (held->m_first + i >= first + held->m_stay[slot]) kept[held->m_first + i] = DRAPE_NO_FEATURE;
        if (held->m_state[i] == DRAPE_GOES) continue;
        uint before = 0;
        for (uint j = first - held->m_first; j < held->m_firsts[slot + 1] - held->m_first; ++j)
            before += held->m_state[j] != DRAPE_GOES && held->m_feature[j] < held->m_feature[i];
        kept[first + before] = lists->m_members[held->m_first + i];
    }
}

// The same as reductionKeep, where work-items of a hit each are there in plenty; block: at most DRAPE_HELD_SLOTS. members: in
// order in slots with more than DRAPE_HELD.
__kernel __attribute__((reqd_work_group_size(DRAPE_HELD_GROUP, 1, 1))) void reductionKeepWide(DRAPE_KEEP_ARGUMENTS)
{
    __local uint firsts[DRAPE_HELD_SLOTS + 1], keepers[2 * DRAPE_HELD_SLOTS], left[2], scratch[DRAPE_HELD_GROUP];
    __local uint slotOf[DRAPE_HELD], rank[DRAPE_HELD], state[DRAPE_HELD], feature[DRAPE_HELD];
    __local float gap[DRAPE_HELD], lack[DRAPE_HELD], depth[3 * DRAPE_HELD], height[3 * DRAPE_HELD];
    __local uint cloth[DRAPE_HELD_SLOTS], nodes[DRAPE_HELD_SLOTS], mayEmpty[DRAPE_HELD_SLOTS], stay[DRAPE_HELD_SLOTS];
    __local Vec3 ways[3 * DRAPE_HELD_SLOTS];
    const ReductionView view = DRAPE_KEEP_VIEW;
    const SlotLists lists = DRAPE_KEEP_LISTS;
    const uint begin = min(slots, (uint)(get_group_id(0) * block)), own = min(slots, begin + block) - begin;
    for (uint i = get_local_id(0); i <= own; i += get_local_size(0))
        firsts[i] = begin + i < slots ? min(slotFirst[begin + i], lists.m_count) : lists.m_count;
    barrier(CLK_LOCAL_MEM_FENCE);
    uint from = 0;
    while (from < own)
    {
        // As many slots as can be held, or a crowded one.
        uint to = from;
        while (to < own && firsts[to + 1] - firsts[from] <= DRAPE_HELD) ++to;
        if (to == from)
        {
            const uint stays =
                reduceCrowded(&view, &lists, kept, firsts[from], firsts[from + 1] - firsts[from], scratch);
            if (get_local_id(0) == 0) slotKept[begin + from] = stays;
            ++from;
            continue;
        }
        const Held held = {firsts[from], firsts[to] - firsts[from], to - from, firsts + from, slotOf, rank,     state, feature,
                           gap,          lack,                      depth,     height,        cloth,  nodes,    mayEmpty, stay,
                           ways};
        holdSlots(&view, &lists, &held);
        barrier(CLK_LOCAL_MEM_FENCE);
        holdHits(&view, &lists, &held);
        barrier(CLK_LOCAL_MEM_FENCE);
        rankHits(&held);
        barrier(CLK_LOCAL_MEM_FENCE);
        decideHits(&view, &lists, &held, keepers, left);
        writeHeld(&lists, &held, kept);
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint slot = get_local_id(0); slot < held.m_slots; slot += get_local_size(0)) slotKept[begin + from + slot] = stay[slot];
        barrier(CLK_LOCAL_MEM_FENCE);
        from = to;
    }
}

// `parts` work-items (1, 2 or 4) share a place of the members' list, and go through their part: they copy the hit that stays
// there, if one does. keptFirst: where the contacts of each slot begin. contacts: behind a head with the counters.
__kernel void reductionWrite(__global const Contact* restrict hits, const uint hitCapacity,
                             __global const uint* restrict slotFirst, const uint parts,
                             __global const uint* restrict kept, __global const uint* restrict keptFirst,
                             __global Contact* restrict contacts, __global const StepCounters* restrict counters)
{
    const uint count = min(counters->m_listed, hitCapacity);
    if (get_global_id(0) == 0) *(__global StepCounters*)contacts = *counters;
    for (ItemRuns runs = itemRuns(count, parts); runs.m_item < count; nextItem(&runs))
    {
        const uint i = runs.m_item;
        const uint member = kept[i];
        if (member == DRAPE_NO_FEATURE) continue;
        const uint slot = hits[member].m_slot;
        copyHit(contacts + DRAPE_CONTACT_HEAD + keptFirst[slot] + i - slotFirst[slot], hits + member, parts);
    }
}

// The same where slots are few, without a launch before it that places them: a work-group takes `block` slots, at most
// DRAPE_BLOCK, and sums the contacts of those before. scratch: a uint per work-item.
__kernel void reductionWriteFew(__global const Contact* restrict hits, const uint hitCapacity,
                                __global const uint* restrict slotFirst, const uint slots, const uint block,
                                const uint parts, __global const uint* restrict kept,
                                __global const uint* restrict slotKept, __global Contact* restrict contacts,
                                __global const StepCounters* restrict counters, __local uint* scratch)
{
    __local uint shifts[DRAPE_BLOCK];  // from a slot's members to its contacts, modulo 2^32
    const uint id = get_local_id(0), size = get_local_size(0), count = min(counters->m_listed, hitCapacity);
    const uint begin = min(slots, (uint)(get_group_id(0) * block)), end = min(slots, begin + block);
    const uint before = groupSumOf(slotKept, begin, scratch);
    const uint share = (end - begin + size - 1) / size;
    const uint first = min(end, begin + id * share), last = min(end, first + share);
    uint sum = 0, total;
    for (uint slot = first; slot < last; ++slot) sum += slotKept[slot];
    uint next = before + groupPrefix(scratch, sum, &total);
    for (uint slot = first; slot < last; ++slot)
    {
        shifts[slot - begin] = next - slotFirst[slot];
        next += slotKept[slot];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (get_group_id(0) == get_num_groups(0) - 1 && id == 0)
    {
        StepCounters all = *counters;
        all.m_hits = before + total;
        *(__global StepCounters*)contacts = all;
    }
    if (begin == end) return;
    const uint from = slotFirst[begin], to = end < slots ? slotFirst[end] : count;
    for (uint k = from * parts + id; k < to * parts; k += size)
    {
        const uint i = k / parts, member = kept[i];
        if (member == DRAPE_NO_FEATURE) continue;
        const uint place = shifts[hits[member].m_slot - begin] + i;
        copyHit(contacts + DRAPE_CONTACT_HEAD + place, hits + member, parts);
    }
}
