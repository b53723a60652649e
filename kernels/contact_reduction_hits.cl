// Which hits of each slot stay (lib/contact_reduction.h), where work-items of a hit each are there in plenty: on a GPU. A slot
// with more than a group holds is reduced by the whole group.
#include "lib/crowded_slot.h"

// Most slots of a group whose work-items take a hit each, and most hits that it holds at a time.
#define DRAPE_HELD_SLOTS 64
#define DRAPE_HELD 256
#define DRAPE_HELD_GROUP 128
// Most hits of a slot that are compared each with each.
#define DRAPE_COMPARED 32u
// Most work-items that share a hit's comparisons.
#define DRAPE_COMPARERS 8u
#define DRAPE_UNDECIDED_HIT 0
#define DRAPE_STAYS 1
#define DRAPE_GOES 2

// Local memory, of a number of words that is odd, so that neighbours' lie in different banks.
typedef struct HeldHit
{
    ReducedContact m_contact;
    float m_lack;    // by which its nodes alone fail to imply it, m; infinite where it may not go
    int m_depth[3];  // of its nodes, m; as ordered() has it until their contacts were asked
    uint m_feature;  // of the obstacle
    uint m_implied;  // a bit for each deeper hit of its slot that implies it, by rank
    ushort m_rank;   // how many of its slot are deeper
    ushort m_byRank;  // of another hit: the one of this slot with as many deeper ones as stand before this
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
} HeldSlot;

// Consecutive slots and their hits.
typedef struct Held
{
    __local const uint* m_firsts;  // of the slots, where their hits begin among all members; one more than slots
    __local HeldSlot* m_slots;
    __local HeldHit* m_hits;
    uint m_slotCount, m_hitCount;
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

static void holdSlots(const ReductionView* view, const SlotLists* lists, const Held* held)
{
    for (uint s = get_local_id(0); s < held->m_slotCount; s += get_local_size(0))
    {
        __local HeldSlot* slot = held->m_slots + s;
        const uint begin = heldBegin(held, s), end = heldEnd(held, s);
        slot->m_stay = 0;
        slot->m_keeper[0] = slot->m_keeper[1] = UINT_MAX;
        slot->m_nodes = 0;
        if (begin == end) continue;
        for (uint i = begin; i < end; ++i) held->m_hits[i].m_slot = (uchar)s;
        __global const Contact* contact = lists->m_hits + lists->m_members[held->m_firsts[0] + begin];
        if (contact->m_kind >= DRAPE_SELF_NODE_FACE) continue;
        const ReducedFeature feature = reducedFeature(view, lists, contact);
        slot->m_cloth = feature.m_cloth;
        slot->m_nodes = feature.m_count;
        slot->m_mayEmpty = feature.m_mayEmpty;
        for (int k = 0; k < feature.m_count; ++k)
        {
            uint first = 0;
            slot->m_ways[k] = feature.m_way[k];
            slot->m_supports[k] = feature.m_count > 1 ? supportsOf(lists, feature.m_node[k], &first) : 0;
            slot->m_support[k] = first;
        }
    }
}

// Depths as they are without the nodes' own contacts.
static void holdHits(const ReductionView* view, const SlotLists* lists, const Held* held)
{
    for (uint i = get_local_id(0); i < held->m_hitCount; i += get_local_size(0))
    {
        __global const Contact* found = lists->m_hits + lists->m_members[held->m_firsts[0] + i];
        __local HeldHit* hit = held->m_hits + i;
        __local const HeldSlot* slot = held->m_slots + hit->m_slot;
        hit->m_feature = found->m_obstacleFeature;
        hit->m_implied = 0;
        hit->m_state = slot->m_nodes == 0 ? DRAPE_STAYS : DRAPE_UNDECIDED_HIT;
        hit->m_lack = INFINITY;
        const ReducedContact contact = reducedContact(view, slot->m_nodes == 0 ? 0 : slot->m_cloth, found);
        hit->m_contact = contact;
        if (slot->m_nodes == 0 || !isReducible(view, &contact, found->m_time)) continue;
        hit->m_lack = 0.0f;
        for (int k = 0; k < slot->m_nodes; ++k)
            hit->m_depth[k] =
                ordered(as_int(freeDepth(contact.m_normal, slot->m_ways[k], view->m_tube[contact.m_pair])));
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
    for (int k = 0; k < count; ++k)
    {
        bounds.m_depth[k] = as_float(hit->m_depth[k]);
        bounds.m_height[k] = nodeHeight(hit->m_contact.m_normal, ways[k], view->m_tube[hit->m_contact.m_pair]);
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
        const uint begin = heldBegin(held, hit->m_slot), end = heldEnd(held, hit->m_slot);
        const float gap = hit->m_contact.m_gap1;
        uint rank = 0;
        for (uint j = begin; j < end; ++j)
        {
            const float other = held->m_hits[j].m_contact.m_gap1;
            rank += other < gap || (other == gap && held->m_hits[j].m_feature < hit->m_feature);
        }
        hit->m_rank = (ushort)rank;
        held->m_hits[begin + rank].m_byRank = (ushort)i;
        if (hit->m_lack == INFINITY) continue;
        const ReducedContact contact = hit->m_contact;
        float depth[3];
        for (int k = 0; k < slot->m_nodes; ++k)
        {
            hit->m_depth[k] = ordered(hit->m_depth[k]);
            depth[k] = as_float(hit->m_depth[k]);
        }
        hit->m_lack = lackOf(&contact, slot->m_nodes, depth, view->m_thickness[contact.m_pair]);
        if (hit->m_lack <= 0.0f && (rank > 0 || slot->m_mayEmpty)) hit->m_state = DRAPE_GOES;
    }
}

// Whether hits that are undecided are implied by a keeper of their slot.
static int heldImplied(const ReductionView* view, const Held* held, const uint i, const uint keeper)
{
    __local const HeldHit* hit = held->m_hits + i;
    __local const HeldSlot* slot = held->m_slots + hit->m_slot;
    if (!(hit->m_lack < INFINITY)) return 0;
    Vec3 ways[3];
    for (int k = 0; k < slot->m_nodes; ++k) ways[k] = slot->m_ways[k];
    const NodeBounds bounds = heldBounds(view, hit, ways, slot->m_nodes);
    const ReducedContact contact = hit->m_contact, its = held->m_hits[keeper].m_contact;
    return impliedBy(view, ways, slot->m_nodes, &bounds, &contact, &its);
}

// Compares the hits of slots that have few, each with all that are deeper: which of these stay is known only later.
static void compareHits(const ReductionView* view, const Held* held)
{
    const uint comparers = sharersOf(held->m_hitCount, DRAPE_COMPARERS);
    for (uint j = get_local_id(0); j < comparers * held->m_hitCount; j += get_local_size(0))
    {
        const uint i = j / comparers, slot = held->m_hits[i].m_slot, begin = heldBegin(held, slot);
        if (heldEnd(held, slot) - begin > DRAPE_COMPARED || held->m_hits[i].m_state != DRAPE_UNDECIDED_HIT) continue;
        uint implied = 0;
        for (uint rank = j & (comparers - 1); rank < held->m_hits[i].m_rank; rank += comparers)
        {
            const uint keeper = held->m_hits[begin + rank].m_byRank;
            if (held->m_hits[keeper].m_state == DRAPE_UNDECIDED_HIT && heldImplied(view, held, i, keeper))
                implied |= 1u << rank;
        }
        if (implied != 0) atomic_or(&held->m_hits[i].m_implied, implied);
    }
}

// A work-item takes a slot that has few hits: those stay that none implies which stays.
static void decideFew(const Held* held)
{
    for (uint slot = get_local_id(0); slot < held->m_slotCount; slot += get_local_size(0))
    {
        const uint begin = heldBegin(held, slot), count = heldEnd(held, slot) - begin;
        if (count > DRAPE_COMPARED) continue;
        uint keepers = 0;
        for (uint rank = 0, left = DRAPE_KEEPERS; rank < count; ++rank)
        {
            __local HeldHit* hit = held->m_hits + held->m_hits[begin + rank].m_byRank;
            if (hit->m_state != DRAPE_UNDECIDED_HIT) continue;
            hit->m_state = hit->m_implied & keepers ? DRAPE_GOES : DRAPE_STAYS;
            if (hit->m_state == DRAPE_GOES || left == 0) continue;
            keepers |= 1u << rank;
            --left;
        }
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

// Reduces the slots that are held. slotKept: of the first one. left: two.
static void reduceHeld(const ReductionView* view, const SlotLists* lists, const Held* held, __global uint* kept,
                       __global uint* slotKept, __local uint* left)
{
    holdSlots(view, lists, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    holdHits(view, lists, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    askSupports(view, lists, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    rankHits(view, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    compareHits(view, held);
    barrier(CLK_LOCAL_MEM_FENCE);
    decideFew(held);
    decideMany(view, held, left);
    writeHeld(lists, held, kept);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint slot = get_local_id(0); slot < held->m_slotCount; slot += get_local_size(0))
        slotKept[slot] = held->m_slots[slot].m_stay;
    barrier(CLK_LOCAL_MEM_FENCE);
}

// See reduction_slots.h; block: at most DRAPE_HELD_SLOTS. members: in order in slots with more than DRAPE_HELD.
__kernel __attribute__((reqd_work_group_size(DRAPE_HELD_GROUP, 1, 1))) void reductionKeepWide(DRAPE_KEEP_ARGUMENTS)
{
    __local uint firsts[DRAPE_HELD_SLOTS + 1], left[2], scratch[DRAPE_HELD_GROUP];
    __local HeldSlot heldSlots[DRAPE_HELD_SLOTS];
    __local HeldHit heldHits[DRAPE_HELD];
    const ReductionView view = DRAPE_KEEP_VIEW;
    const SlotLists lists = DRAPE_KEEP_LISTS;
    const uint begin = min(slots, (uint)(get_group_id(0) * block)), own = min(slots, begin + block) - begin;
    for (uint i = get_local_id(0); i <= own; i += get_local_size(0))
        firsts[i] = begin + i < slots ? min(slotFirst[begin + i], lists.m_count) : lists.m_count;
    barrier(CLK_LOCAL_MEM_FENCE);
    const int none = firsts[own] == firsts[0];
    for (uint slot = get_local_id(0); slot < own && none; slot += get_local_size(0)) slotKept[begin + slot] = 0;
    uint from = none ? own : 0;
    while (from < own)
    {
        // As many slots as can be held, or a crowded one.
        const uint first = firsts[from];
        uint to = from;
        while (to < own && firsts[to + 1] - first <= DRAPE_HELD) ++to;
        if (to == from)
        {
            const uint stays = reduceCrowded(&view, &lists, kept, first, firsts[from + 1] - first, scratch);
            if (get_local_id(0) == 0) slotKept[begin + from] = stays;
            ++from;
            continue;
        }
        const Held held = {firsts + from, heldSlots, heldHits, to - from, firsts[to] - first};
        reduceHeld(&view, &lists, &held, kept, slotKept + begin + from, left);
        from = to;
    }
}
