// Which hits of each slot stay (lib/contact_reduction.h), where work-items of a hit each are there in plenty: on a GPU. A slot
// with more than a group holds is reduced by the whole group.
#include "lib/crowded_slot.h"

// Most slots that a group holds at a time, whose work-items take a hit each, and most of their hits.
#define DRAPE_HELD_SLOTS 64
#define DRAPE_HELD 256
#define DRAPE_HELD_GROUP 128
// Most hits of a slot that are compared each with each.
#define DRAPE_COMPARED 32u
// Most work-items that share a hit's comparisons.
#define DRAPE_COMPARERS 8u
// Pairs of hits that are left after a first look, of a group. A test sets fewer.
#ifndef DRAPE_LIKELY
#define DRAPE_LIKELY 1024u
#endif
#define DRAPE_UNDECIDED_HIT 0
#define DRAPE_STAYS 1
#define DRAPE_GOES 2
// Of a hit of which nothing is known: a bit that no deeper hit of its slot has.
#define DRAPE_OPEN (1u << (DRAPE_COMPARED - 1))

// Local memory, of a number of words that is odd, so that neighbours' lie in different banks.
typedef struct HeldHit
{
    ReducedContact m_contact;
    float m_lack;    // by which its nodes alone fail to imply it, m; infinite where it may not go
    int m_depth[3];  // of its nodes, m; as ordered() has it until their contacts were asked
    uint m_feature;  // of the obstacle
    ushort m_rank;   // how many of its slot are deeper
    // Of another hit, that of this slot with as many deeper ones as stand before this: its place; and DRAPE_OPEN and a bit for
    // each deeper hit that implies it, by rank.
    ushort m_byRank;
    uint m_implied;
    uchar m_slot;
    uchar m_state;
} HeldHit;

typedef struct HeldSlot
{
    Vec3 m_ways[3];      // of its nodes
    uint m_support[3];   // of each, where its own contacts begin among the members, and
    uint m_supports[3];  // how many are asked
    uint m_cloth;
    int m_nodes;  // 0 where all hits stay
    int m_mayEmpty;
    uint m_keeper[2];  // of a round and the next
    uint m_stay;       // how many hits do
    uint m_go;         // where they are few, a bit for each that does not, by rank
} HeldSlot;

// A slot with hits.
typedef struct FoundSlot
{
    uint m_number;
    uint m_kind;     // of its hits
    uint m_feature;  // of the cloth
} FoundSlot;

// Slots, no other slot with hits between them, and their hits.
typedef struct Held
{
    __local const FoundSlot* m_found;  // the slots as they were found
    __local const uint* m_firsts;      // where their hits begin among all members; one more than slots
    __local HeldSlot* m_slots;
    __local HeldHit* m_hits;
    uint m_slotCount, m_hitCount;
    __local uint* m_deeper;    // of each hit, how many of its slot are deeper
    __local ushort* m_likely;  // hit * DRAPE_HELD + a deeper one of its slot, which may imply it
    __local uint* m_likelyCount;
    __local uint* m_anyMany;  // whether something is left to be told of slots with more than DRAPE_COMPARED
} Held;

// Where a held slot's hits begin and end among those that are held.
static uint heldBegin(const Held* held, const uint slot)
{
    return held->m_firsts[slot] - held->m_firsts[0];
}

static uint heldEnd(const Held* held, const uint slot)
{
    return heldBegin(held, slot + 1);
}

// A number's bits, and back, such that ints are in the numbers' order.
static int ordered(const int bits)
{
    return bits < 0 ? bits ^ 0x7fffffff : bits;
}

// How many work-items, a power of two up to `most`, share an item where the group has so many.
static uint sharersOf(const uint items, const uint most)
{
    uint sharers = most;
    while (sharers > 1 && sharers * items > get_local_size(0)) sharers /= 2;
    return sharers;
}

// By the group's last work-items, while its first ones load hits.
static void holdSlots(const ReductionView* view, const SlotLists* lists, const Held* held)
{
    if (get_local_id(0) == 0) *held->m_likelyCount = *held->m_anyMany = 0;
    for (uint s = get_local_size(0) - 1 - get_local_id(0); s < held->m_slotCount; s += get_local_size(0))
    {
        __local HeldSlot* slot = held->m_slots + s;
        const FoundSlot found = held->m_found[s];
        const uint begin = heldBegin(held, s), end = heldEnd(held, s);
        slot->m_stay = 0;
        slot->m_keeper[0] = slot->m_keeper[1] = UINT_MAX;
        slot->m_nodes = 0;
        for (uint i = begin; i < end; ++i) held->m_hits[i].m_slot = (uchar)s;
        if (found.m_kind >= DRAPE_SELF_NODE_FACE) continue;
        const ReducedFeature feature = reducedFeature(view, lists, found.m_kind, found.m_feature);
        slot->m_cloth = feature.m_cloth;
        slot->m_nodes = feature.m_count;
        slot->m_mayEmpty = feature.m_mayEmpty;
        DRAPE_EACH_NODE(k, feature.m_count)
        {
            uint first = 0;
            slot->m_ways[k] = feature.m_way[k];
            slot->m_supports[k] =
                feature.m_count > 1 && k < feature.m_count ? supportsOf(lists, feature.m_node[k], &first) : 0;
            slot->m_support[k] = first;
        }
    }
}

// Hits as far as they are known without their slots: as if of the first cloth.
static void loadHits(const ReductionView* view, const SlotLists* lists, const Held* held)
{
    for (uint i = get_local_id(0); i < held->m_hitCount; i += get_local_size(0))
    {
        __global const Contact* found = lists->m_hits + lists->m_members[held->m_firsts[0] + i];
        __local HeldHit* hit = held->m_hits + i;
        hit->m_feature = found->m_obstacleFeature;
        hit->m_contact = reducedContact(view, 0, found);
        hit->m_lack = found->m_time == 1.0f ? 0.0f : INFINITY;
        held->m_deeper[i] = 0;
    }
}

// Depths as they are without the nodes' own contacts.
static void holdHits(const ReductionView* view, const Held* held)
{
    for (uint i = get_local_id(0); i < held->m_hitCount; i += get_local_size(0))
    {
        __local HeldHit* hit = held->m_hits + i;
        __local const HeldSlot* slot = held->m_slots + hit->m_slot;
        hit->m_state = slot->m_nodes == 0 ? DRAPE_STAYS : DRAPE_UNDECIDED_HIT;
        if (slot->m_nodes > 0) hit->m_contact.m_pair += slot->m_cloth * view->m_obstacleCount;
        const ReducedContact contact = hit->m_contact;
        if (slot->m_nodes == 0 || !isReducible(view, &contact, hit->m_lack == 0.0f ? 1.0f : 0.0f)) hit->m_lack = INFINITY;
        if (hit->m_lack == INFINITY) continue;
        const float tube = view->m_tube[contact.m_pair];
        DRAPE_EACH_NODE(k, slot->m_nodes)
        hit->m_depth[k] = k < slot->m_nodes ? ordered(as_int(freeDepth(contact.m_normal, slot->m_ways[k], tube))) : 0;
    }
}

// Counts how many of its slot are deeper than each hit.
static void countDeeper(const Held* held)
{
    const uint sharers = sharersOf(held->m_hitCount, DRAPE_COMPARERS);
    for (uint j = get_local_id(0); j < sharers * held->m_hitCount; j += get_local_size(0))
    {
        const uint i = j / sharers, slot = held->m_hits[i].m_slot, end = heldEnd(held, slot);
        const float gap = held->m_hits[i].m_contact.m_gap1;
        const uint feature = held->m_hits[i].m_feature;
        uint deeper = 0;
        for (uint other = heldBegin(held, slot) + (j & (sharers - 1)); other < end; other += sharers)
        {
            const float its = held->m_hits[other].m_contact.m_gap1;
            deeper += its < gap || (its == gap && held->m_hits[other].m_feature < feature);
        }
        if (deeper > 0) atomic_add(held->m_deeper + i, deeper);
    }
}

// Work-items share the contacts of a node of a hit, and ask what they hold.
static void askSupports(const ReductionView* view, const SlotLists* lists, const Held* held)
{
    const uint askers = sharersOf(3 * held->m_hitCount, DRAPE_SUPPORTS);
    for (uint j = get_local_id(0); j < 3 * askers * held->m_hitCount; j += get_local_size(0))
    {
        const uint asker = j & (askers - 1), item = j / askers, k = item % 3;
        __local HeldHit* hit = held->m_hits + item / 3;
        __local const HeldSlot* slot = held->m_slots + hit->m_slot;
        if ((int)k >= slot->m_nodes || asker >= slot->m_supports[k] || hit->m_lack == INFINITY) continue;
        const ReducedContact contact = hit->m_contact;
        const Vec3 way = slot->m_ways[k];
        float depth = INFINITY;
        for (uint i = asker; i < slot->m_supports[k]; i += askers)
        {
            const ReducedContact own =
                reducedContact(view, slot->m_cloth, lists->m_hits + lists->m_members[slot->m_support[k] + i]);
            depth = heldDepth(view, &contact, &own, way, depth);
        }
        atomic_min(hit->m_depth + k, ordered(as_int(depth)));
    }
}

// Of a hit's nodes; the lack as held.
static NodeBounds heldBounds(const ReductionView* view, __local const HeldHit* hit, const Vec3* ways, const int count)
{
    NodeBounds bounds;
    const float tube = view->m_tube[hit->m_contact.m_pair];
    DRAPE_EACH_NODE(k, count)
    {
        bounds.m_depth[k] = as_float(hit->m_depth[k]);
        bounds.m_height[k] = k < count ? nodeHeight(hit->m_contact.m_normal, ways[k], tube) : 0.0f;
    }
    bounds.m_lack = hit->m_lack;
    return bounds;
}

// Ranks the hits, and drops those that the nodes alone imply.
static void rankHits(const ReductionView* view, const Held* held)
{
    for (uint i = get_local_id(0); i < held->m_hitCount; i += get_local_size(0))
    {
        __local HeldHit* hit = held->m_hits + i;
        __local const HeldSlot* slot = held->m_slots + hit->m_slot;
        const uint begin = heldBegin(held, hit->m_slot), rank = held->m_deeper[i];
        hit->m_rank = (ushort)rank;
        held->m_hits[begin + rank].m_byRank = (ushort)i;
        held->m_hits[begin + rank].m_implied = hit->m_state == DRAPE_UNDECIDED_HIT ? DRAPE_OPEN : 0;
        if (hit->m_lack == INFINITY) continue;
        const ReducedContact contact = hit->m_contact;
        float depth[3];
        DRAPE_EACH_NODE(k, slot->m_nodes)
        {
            hit->m_depth[k] = ordered(hit->m_depth[k]);
            depth[k] = as_float(hit->m_depth[k]);
        }
        hit->m_lack = lackOf(&contact, slot->m_nodes, depth, view->m_thickness[contact.m_pair]);
        if (hit->m_lack > 0.0f || (rank == 0 && !slot->m_mayEmpty)) continue;
        hit->m_state = DRAPE_GOES;
        held->m_hits[begin + rank].m_implied = 0;
    }
}

// Whether hits that are undecided are implied by a keeper of their slot.
static int heldImplied(const ReductionView* view, const Held* held, const uint i, const uint keeper)
{
    __local const HeldHit* hit = held->m_hits + i;
    __local const HeldSlot* slot = held->m_slots + hit->m_slot;
    if (!(hit->m_lack < INFINITY)) return 0;
    Vec3 ways[3];
    DRAPE_EACH_NODE(k, slot->m_nodes) ways[k] = slot->m_ways[k];
    const NodeBounds bounds = heldBounds(view, hit, ways, slot->m_nodes);
    const ReducedContact contact = hit->m_contact, its = held->m_hits[keeper].m_contact;
    return impliedBy(view, ways, slot->m_nodes, &bounds, &contact, &its);
}

// Notes a deeper hit of the slot as one that implies another.
static void noteImplied(const ReductionView* view, const Held* held, const uint i, const uint keeper)
{
    const uint place = heldBegin(held, held->m_hits[i].m_slot) + held->m_hits[i].m_rank;
    if (heldImplied(view, held, i, keeper)) atomic_or(&held->m_hits[place].m_implied, 1u << held->m_hits[keeper].m_rank);
}

// Looks at the hits of slots that have few, each and all that are deeper, and lists the pairs that may imply: the few among
// many, which take longest, are then shared out evenly.
static void listLikely(const ReductionView* view, const Held* held)
{
    const uint comparers = sharersOf(held->m_hitCount, DRAPE_COMPARERS);
    for (uint j = get_local_id(0); j < comparers * held->m_hitCount; j += get_local_size(0))
    {
        const uint i = j / comparers, slot = held->m_hits[i].m_slot, begin = heldBegin(held, slot);
        __local const HeldHit* hit = held->m_hits + i;
        if (heldEnd(held, slot) - begin > DRAPE_COMPARED || hit->m_state != DRAPE_UNDECIDED_HIT) continue;
        if (!(hit->m_lack < INFINITY)) continue;
        const ReducedContact contact = hit->m_contact;
        const float depth[3] = {as_float(hit->m_depth[0]), as_float(hit->m_depth[1]), as_float(hit->m_depth[2])};
        for (uint rank = j & (comparers - 1); rank < hit->m_rank; rank += comparers)
        {
            const uint keeper = held->m_hits[begin + rank].m_byRank;
            if (held->m_hits[keeper].m_state != DRAPE_UNDECIDED_HIT) continue;
            const ReducedContact its = held->m_hits[keeper].m_contact;
            float most;
            if (!mayImply(view, held->m_slots[slot].m_nodes, depth, hit->m_lack, &contact, &its, &most)) continue;
            const uint place = atomic_inc(held->m_likelyCount);
            if (place < DRAPE_LIKELY)
                held->m_likely[place] = (ushort)(i * DRAPE_HELD + keeper);
            else
                noteImplied(view, held, i, keeper);
        }
    }
}

static void testLikely(const ReductionView* view, const Held* held)
{
    const uint count = min(*held->m_likelyCount, DRAPE_LIKELY);
    for (uint j = get_local_id(0); j < count; j += get_local_size(0))
        noteImplied(view, held, held->m_likely[j] / DRAPE_HELD, held->m_likely[j] % DRAPE_HELD);
}

// A work-item takes a slot that has few hits: those stay that none implies which stays.
static void decideFew(const Held* held)
{
    for (uint slot = get_local_id(0); slot < held->m_slotCount; slot += get_local_size(0))
    {
        const uint begin = heldBegin(held, slot), count = heldEnd(held, slot) - begin;
        if (count > DRAPE_COMPARED) continue;
        uint keepers = 0, go = 0;
        for (uint rank = 0, left = DRAPE_KEEPERS; rank < count; ++rank)
        {
            const uint implied = held->m_hits[begin + rank].m_implied;
            const uint goes = implied & keepers, keeps = (implied & DRAPE_OPEN) && !goes && left > 0;
            if (goes) go |= 1u << rank;
            if (keeps) keepers |= 1u << rank;
            left -= keeps;
        }
        held->m_slots[slot].m_go = go;
    }
}

// What that comes to for the slots' hits.
static void takeDecisions(const Held* held)
{
    for (uint i = get_local_id(0); i < held->m_hitCount; i += get_local_size(0))
    {
        __local HeldHit* hit = held->m_hits + i;
        if (hit->m_state != DRAPE_UNDECIDED_HIT) continue;
        if (heldEnd(held, hit->m_slot) - heldBegin(held, hit->m_slot) > DRAPE_COMPARED)
            *held->m_anyMany = 1;
        else
            hit->m_state = held->m_slots[hit->m_slot].m_go >> hit->m_rank & 1u ? DRAPE_GOES : DRAPE_STAYS;
    }
}

// The other slots' hits. In every round each slot's deepest hit that nothing is known of stays, and what it implies goes; then
// the rest stays. Keepers are by rank and place. left: whether a round has undecided hits, and the next.
static void decideMany(const ReductionView* view, const Held* held, __local uint* left)
{
    const uint id = get_local_id(0), size = get_local_size(0);
    if (id == 0) left[0] = left[1] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint round = 0; round < DRAPE_KEEPERS; ++round)
    {
        const uint now = round & 1u, next = 1u - now;
        for (uint i = id; i < held->m_hitCount; i += size)
        {
            if (held->m_hits[i].m_state != DRAPE_UNDECIDED_HIT) continue;
            atomic_min(held->m_slots[held->m_hits[i].m_slot].m_keeper + now, held->m_hits[i].m_rank * DRAPE_HELD + i);
            left[now] = 1;
        }
        for (uint slot = id; slot < held->m_slotCount; slot += size) held->m_slots[slot].m_keeper[next] = UINT_MAX;
        barrier(CLK_LOCAL_MEM_FENCE);
        const uint some = left[now];
        for (uint i = id; i < held->m_hitCount && some; i += size)
        {
            if (held->m_hits[i].m_state != DRAPE_UNDECIDED_HIT) continue;
            const uint keeper = held->m_slots[held->m_hits[i].m_slot].m_keeper[now] % DRAPE_HELD;
            if (keeper == i)
                held->m_hits[i].m_state = DRAPE_STAYS;
            else if (heldImplied(view, held, i, keeper))
                held->m_hits[i].m_state = DRAPE_GOES;
        }
        if (id == 0) left[next] = 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        if (!some) return;
    }
}

// Writes to the front of each slot what stays, by obstacle feature.
static void writeHeld(const SlotLists* lists, const Held* held, __global uint* kept)
{
    for (uint i = get_local_id(0); i < held->m_hitCount; i += get_local_size(0))
        if (held->m_hits[i].m_state != DRAPE_GOES) atomic_inc(&held->m_slots[held->m_hits[i].m_slot].m_stay);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = get_local_id(0); i < held->m_hitCount; i += get_local_size(0))
    {
        const uint slot = held->m_hits[i].m_slot, begin = heldBegin(held, slot);
        if (i >= begin + held->m_slots[slot].m_stay) kept[held->m_firsts[0] + i] = DRAPE_NO_FEATURE;
        if (held->m_hits[i].m_state == DRAPE_GOES) continue;
        uint before = 0;
        for (uint j = begin; j < heldEnd(held, slot); ++j)
            before += held->m_hits[j].m_state != DRAPE_GOES && held->m_hits[j].m_feature < held->m_hits[i].m_feature;
        kept[held->m_firsts[0] + begin + before] = lists->m_members[held->m_firsts[0] + i];
    }
}

// Notes how many hits of a slot stay, and adds them up where keptSums is not null.
static void noteStay(__global uint* slotKept, __global uint* keptSums, const uint slot, const uint stay)
{
    slotKept[slot] = stay;
    if (keptSums) addToSums(keptSums, slot, stay);
}

// Reduces the slots that are held. left: two.
static void reduceHeld(const ReductionView* view, const SlotLists* lists, const Held* held, __global uint* kept,
                       __global uint* slotKept, __global uint* keptSums, __local uint* left)
{
    holdSlots(view, lists, held);
    loadHits(view, lists, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    holdHits(view, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    countDeeper(held);
    askSupports(view, lists, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    rankHits(view, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    listLikely(view, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    testLikely(view, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    decideFew(held);
    barrier(CLK_LOCAL_MEM_FENCE);
    takeDecisions(held);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (*held->m_anyMany) decideMany(view, held, left);
    writeHeld(lists, held, kept);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint slot = get_local_id(0); slot < held->m_slotCount; slot += get_local_size(0))
        noteStay(slotKept, keptSums, held->m_found[slot].m_number, held->m_slots[slot].m_stay);
    barrier(CLK_LOCAL_MEM_FENCE);
}

// Finds the slots whose members begin at one of `share` places, at most DRAPE_HELD_SLOTS, from `begin` on: where they begin,
// and behind that where the last one ends. marks: two, a bit for each place. Returns how many slots there are.
static uint findSlots(const SlotLists* lists, const uint begin, const uint share, __local FoundSlot* found,
                      __local uint* firsts, __local uint* marks)
{
    const uint id = get_local_id(0), place = begin + id;
    if (id < 2) marks[id] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    FoundSlot slot = {0, 0, 0};
    int isFirst = 0;
    if (id < share && place < lists->m_count)
    {
        __global const Contact* hit = lists->m_hits + lists->m_members[place];
        slot.m_number = hit->m_slot;
        slot.m_kind = hit->m_kind;
        slot.m_feature = hit->m_clothFeature;
        isFirst = lists->m_first[slot.m_number] == place;
        if (isFirst) atomic_or(marks + id / 32, 1u << id % 32);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint count = popcount(marks[0]) + popcount(marks[1]);
    if (isFirst)
    {
        const uint earlier = marks[id / 32] & ((1u << id % 32) - 1u);
        const uint before = popcount(earlier) + (id < 32 ? 0 : popcount(marks[0]));
        found[before] = slot;
        firsts[before] = place;
        if (before + 1 == count) firsts[count] = slotEnd(lists, slot.m_number);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return count;
}

// See reduction_slots.h; a group takes the slots that begin in its share of the members, at most DRAPE_HELD_SLOTS at a time.
// members: in order in slots with more than DRAPE_HELD. slotKept must be zero before. keptSums gets sums over it, and must be
// zero, too; may be null.
__kernel __attribute__((reqd_work_group_size(DRAPE_HELD_GROUP, 1, 1))) void reductionKeepWide(DRAPE_KEEP_ARGUMENTS,
                                                                                             __global uint* keptSums)
{
    __local uint firsts[DRAPE_HELD_SLOTS + 1], marks[2], left[2], scratch[DRAPE_HELD_GROUP], deeper[DRAPE_HELD];
    __local FoundSlot found[DRAPE_HELD_SLOTS];
    __local HeldSlot heldSlots[DRAPE_HELD_SLOTS];
    __local HeldHit heldHits[DRAPE_HELD];
    __local ushort likely[DRAPE_LIKELY];
    __local uint likelyCount, anyMany;
    const ReductionView view = DRAPE_KEEP_VIEW;
    const SlotLists lists = DRAPE_KEEP_LISTS;
    for (uint begin = get_group_id(0) * share; begin < lists.m_count; begin += get_num_groups(0) * share)
    {
        const uint own = findSlots(&lists, begin, share, found, firsts, marks);
        uint from = 0;
        while (from < own)
        {
            // As many slots as can be held, or a crowded one.
            const uint first = firsts[from];
            uint to = from;
            while (to < own && firsts[to + 1] - first <= DRAPE_HELD) ++to;
            if (to == from)
            {
                const uint stays = reduceCrowded(&view, &lists, kept, first, firsts[from + 1] - first, scratch);
                if (get_local_id(0) == 0) noteStay(slotKept, keptSums, found[from].m_number, stays);
                ++from;
                continue;
            }
            const Held held = {found + from,          firsts + from, heldSlots, heldHits,     to - from,
                               firsts[to] - first, deeper,        likely,    &likelyCount, &anyMany};
            reduceHeld(&view, &lists, &held, kept, slotKept, keptSums, left);
            from = to;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}
