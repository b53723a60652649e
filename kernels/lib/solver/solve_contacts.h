// Sweeps over the contacts of a group, bucket by bucket (core/solver/host/contact_group.h).
//
// The features of a bucket share no node, so work-items visit its contacts side by side, one contact each. The contacts
// of one feature are projected in order: in each round the first one that is due.
#ifndef DRAPE_LIB_SOLVE_CONTACTS_H
#define DRAPE_LIB_SOLVE_CONTACTS_H

#include "solve_rows.h"

// Marks order the contacts of a feature within a round: the mark at its first node is the least of the round's tag and
// a contact's rank. Tags fall from round to round, so that marks of earlier rounds do not count.
#define DRAPE_NO_MARK 0xffffffffu
#define DRAPE_MOST_ROUNDS 0xf000u
#define DRAPE_ROUND_TAG(round) ((0xffffu - (round)) << 16)

DRAPE_HOT_FUNCTION void resetMarks(const Solve* solve, Sweep* sweep)
{
    syncNodes();
#ifdef DRAPE_GLOBAL_NODES
    for (uint b = 0; b < bucketsOf(solve); ++b)
        forAll(i, solve->m_shared[DRAPE_SHARED_FIRST + b], solve->m_shared[DRAPE_SHARED_LAST + b])
            solve->m_marks[solve->m_sorted[i].m_nodes[0]] = DRAPE_NO_MARK;
#else
    forAll(i, 0, solve->m_group->m_nodes.m_count) solve->m_marks[i] = DRAPE_NO_MARK;
#endif
    if (get_local_id(0) == 0)
        for (int i = 0; i < 3; ++i)
            solve->m_shared[DRAPE_SHARED_PENDING + i] = 0;
    sweep->m_round = sweep->m_pending = 0;
    syncNodes();
}

// Returns whether any of the group's contacts is due in this round. Three words take turns, so that one barrier is
// enough.
DRAPE_HOT_FUNCTION int anyPending(const Solve* solve, Sweep* sweep)
{
    const int any = solve->m_shared[DRAPE_SHARED_PENDING + sweep->m_pending] != 0;
    if (get_local_id(0) == 0) solve->m_shared[DRAPE_SHARED_PENDING + (sweep->m_pending + 2) % 3] = 0;
    sweep->m_pending = (sweep->m_pending + 1) % 3;
    return any;
}

// Visits contacts side by side, one for each work-item. A contact that acts remembers how many of its feature came
// before it. Returns how many rounds actSideBySide() needs for the work-item's contact, 0 if it does not act.
DRAPE_HOT_FUNCTION uint visitSideBySide(const Solve* solve, const uint index, const int exists, Sweep* sweep)
{
    SolveContact contact;
    ActingContact acting;
    uint before = 0, rounds = 0;
    int isOpen = exists, hasRow = 0;
    contact.m_rank = 0;
    if (isOpen)
    {
        contact = loadContact(solve, index);
        hasRow = contact.m_pushing == sweep->m_phase;
        if (hasRow) acting = loadActing(solve, index);
    }
    for (;;)
    {
        const uint tag = DRAPE_ROUND_TAG(sweep->m_round);
        const uint rank = contact.m_rank & 0xffffu;
        if (isOpen && (hasRow || isDue(solve, &contact, sweep)))
        {
            atomic_min(solve->m_marks + (contact.m_nodes[0] - solve->m_base), tag | rank);
            solve->m_shared[DRAPE_SHARED_PENDING + sweep->m_pending] = 1;
        }
        syncNodes();
        ++sweep->m_round;
        if (!anyPending(solve, sweep)) return rounds;
        if (isOpen)
        {
            const uint mark = solve->m_marks[contact.m_nodes[0] - solve->m_base];
            if ((mark & 0xffff0000u) == tag)
            {
                if (rank == (mark & 0xffffu))
                {
                    if (!hasRow) acting = openRow(solve, index, &contact, sweep->m_phase);
                    if (projectContact(solve, index, &contact, &acting, sweep) || hasRow)
                    {
                        rounds = before + 1;
                        if (contact.m_rank >> 16 != before) solve->m_sorted[index].m_rank = rank | before << 16;
                    }
                }
                if (rank <= (mark & 0xffffu)) isOpen = 0;
                ++before;
            }
        }
        syncNodes();
    }
}

// Visits contacts that were loaded, one for each work-item that has any, if they act in this phase. The group takes so
// many rounds.
DRAPE_HOT_FUNCTION void actSideBySide(const Solve* solve, const uint index, const int exists,
                                      const SolveContact* contact, const uint rounds, Sweep* sweep)
{
    ActingContact acting;
    uint round = rounds;
    if (exists && contact->m_pushing == sweep->m_phase)
    {
        acting = loadActing(solve, index);
        if (acting.m_row.m_inverseMobility > 0.0f) round = contact->m_rank >> 16;
    }
    for (uint i = 0; i < rounds; ++i)
    {
        if (i == round) pushContact(solve, index, contact, &acting, sweep);
        syncNodes();
    }
}

// Visits contacts one after the other: all, or those that act in this phase.
DRAPE_HOT_FUNCTION uint visitInOrder(const Solve* solve, const uint first, const uint last, Sweep* sweep,
                                     const int acts)
{
    uint pushed = 0;
    for (uint i = first; i < last; ++i)
    {
        const SolveContact contact = loadContact(solve, i);
        if (acts ? contact.m_pushing != sweep->m_phase : !isDue(solve, &contact, sweep)) continue;
        ActingContact acting = openRow(solve, i, &contact, sweep->m_phase);
        pushed |=
            acts ? pushContact(solve, i, &contact, &acting, sweep) : projectContact(solve, i, &contact, &acting, sweep);
    }
    return pushed;
}

// The record of a bucket's pushes: the phase in which a contact pushed last, and the rounds that its acting contacts
// need.
#define DRAPE_PUSH_RECORD(phase, rounds) ((phase) << 16 | (rounds))

// Takes the group's buckets and their records of pushes into local memory, before the first sweep.
DRAPE_HOT_FUNCTION void openBuckets(const Solve* solve)
{
    forAll(i, 0, bucketsOf(solve))
    {
        const SolveBucket bucket = solve->m_buckets[solve->m_group->m_firstBucket + i];
        solve->m_shared[DRAPE_SHARED_PUSHED + i] = bucket.m_pushed;
        solve->m_shared[DRAPE_SHARED_FIRST + i] = bucket.m_first;
        solve->m_shared[DRAPE_SHARED_LAST + i] = bucket.m_first + bucket.m_count;
    }
    syncNodes();
}

// Sweeps over the contacts of a bucket, a number within the group.
DRAPE_HOT_FUNCTION void sweepBucket(const Solve* solve, const uint index, Sweep* sweep)
{
    const uint first = solve->m_shared[DRAPE_SHARED_FIRST + index], last = solve->m_shared[DRAPE_SHARED_LAST + index];
    if (first == last) return;
    uint rounds = 0;
#ifdef DRAPE_CPU
    rounds = visitInOrder(solve, first, last, sweep, 0);
#else
    for (uint start = first; start < last; start += get_local_size(0))
    {
        if (sweep->m_round > DRAPE_MOST_ROUNDS) resetMarks(solve, sweep);
        const uint own = visitSideBySide(solve, start + get_local_id(0), start + get_local_id(0) < last, sweep);
        rounds = max(rounds, own);
    }
#endif
    // Most contacts find their rounds recorded: atomics on one word wait for each other.
    const uint record = DRAPE_PUSH_RECORD(sweep->m_phase, rounds);
    if (rounds > 0 && solve->m_shared[DRAPE_SHARED_PUSHED + index] < record)
    {
        atomic_max(solve->m_shared + DRAPE_SHARED_PUSHED + index, record);
        solve->m_progress->m_pushed = 1;
    }
}

// Returns the next bucket, from `index` on, in which contacts act in this phase; the number of buckets if there is
// none.
DRAPE_HOT_FUNCTION uint nextActing(const Solve* solve, uint index, const uint count, const uint phase)
{
    while (index < count && solve->m_shared[DRAPE_SHARED_PUSHED + index] >> 16 != phase)
        ++index;
    return index;
}

// Visits the contacts of all buckets that act in this phase. Loads each bucket's contacts while the one before it is
// visited.
DRAPE_HOT_FUNCTION void sweepActing(const Solve* solve, const uint count, Sweep* sweep)
{
    uint index = nextActing(solve, 0, count, sweep->m_phase);
#ifdef DRAPE_CPU
    for (; index < count; index = nextActing(solve, index + 1, count, sweep->m_phase))
        visitInOrder(solve, solve->m_shared[DRAPE_SHARED_FIRST + index], solve->m_shared[DRAPE_SHARED_LAST + index],
                     sweep, 1);
#else
    __local const uint* firsts = solve->m_shared + DRAPE_SHARED_FIRST;
    __local const uint* lasts = solve->m_shared + DRAPE_SHARED_LAST;
    const uint item = get_local_id(0), width = get_local_size(0);
    SolveContact loaded;
    if (index < count && firsts[index] + item < lasts[index]) loaded = loadContact(solve, firsts[index] + item);
    while (index < count)
    {
        const uint last = lasts[index], rounds = solve->m_shared[DRAPE_SHARED_PUSHED + index] & 0xffffu;
        uint own = firsts[index] + item;
        SolveContact contact = loaded;
        index = nextActing(solve, index + 1, count, sweep->m_phase);
        if (index < count && firsts[index] + item < lasts[index]) loaded = loadContact(solve, firsts[index] + item);
        actSideBySide(solve, own, own < last, &contact, rounds, sweep);
        for (own += width; own - item < last; own += width)
        {
            if (own < last) contact = loadContact(solve, own);
            actSideBySide(solve, own, own < last, &contact, rounds, sweep);
        }
    }
#endif
}

// Sweeps over buckets of the group, then `acting` times over the contacts in all of its buckets that act.
DRAPE_HOT_FUNCTION void sweepBuckets(const Solve* solve, const uint first, const uint last, const uint acting,
                                     Sweep* sweep)
{
    for (uint i = first; i < last; ++i)
        sweepBucket(solve, i, sweep);
    if (acting == 0) return;
    const float worst = sweep->m_worst;
    syncNodes();  // the records of pushes
    for (uint i = 0; i < acting; ++i)
        sweepActing(solve, bucketsOf(solve), sweep);
    sweep->m_worst = worst;
}

#endif
