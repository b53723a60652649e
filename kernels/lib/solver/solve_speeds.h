// Limits the speeds that contacts of a group gave, once the sweeps are over.
#ifndef DRAPE_LIB_SOLVE_SPEEDS_H
#define DRAPE_LIB_SOLVE_SPEEDS_H

#include "solve_rows.h"

// See ContactGroup::endsNear().
static int endsNear(const Solve* solve, const ActingContact* acting)
{
    return acting->m_distance - rowViolation(&acting->m_row, solve->m_nodes, 1.0f) < solve->m_cloth->m_nearDistance;
}

// Returns whether the features of a contact that turned end near, where they are nearest then.
DRAPE_RARE_FUNCTION int turnedEndsNear(const Solve* solve, const uint index)
{
    ActingContact acting = solve->m_acting[index];
    const SolveContact contact = solve->m_sorted[index];
    __global const Contact* found = solve->m_contacts + solve->m_order[index];
    const FeatureNodes nodes = featureNodes(solve, &contact, surfaceOf(solve, found));
    const Displacements at = displacementsOf(solve, &contact);
    const ContactPlane before = foundPlane(found);
    ContactPlane plane;
    return !renewPlane(&acting, &nodes, at.m_nodes, 1.0f, &before, &plane) || endsNear(solve, &acting);
}

// Limits the speeds that contacts of a feature gave. Returns whether one of them ends so near that a surface may have
// been passed.
static int limitFeature(const Solve* solve, const uint first, const uint last)
{
    int near = 0;
    for (uint i = first; i < last && (i == first || solve->m_sorted[i].m_rank != 0); ++i)
    {
        if (!(solve->m_sorted[i].m_flags & DRAPE_CONTACT_MADE)) continue;
        const ActingContact acting = solve->m_acting[i];
        if (acting.m_pushed) limitSpeed(&acting, solve->m_states);
        near |= endsNear(solve, &acting);
        const int turns = (solve->m_sorted[i].m_flags & DRAPE_CONTACT_TURNS) != 0;
        if (turns && acting.m_phase != 0 && !near) near |= turnedEndsNear(solve, i);
    }
    return near;
}

// Limits the speeds that contacts of the group gave: of nodes and faces, or of edges. Only for nodes from the cloth's
// first on. Returns whether one of the work-item's ends near.
DRAPE_RARE_FUNCTION int limitSpeeds(const Solve* solve, const int edges)
{
    __global const SolveGroup* group = solve->m_group;
    const uint others = group->m_nodeBuckets + group->m_faceBuckets;
    const uint first = group->m_firstBucket + (edges ? others : 0), count = edges ? group->m_edgeBuckets : others;
    int near = 0;
    for (uint b = first; b < first + count; ++b)
    {
        const SolveBucket bucket = solve->m_buckets[b];
        forAll(i, bucket.m_first, bucket.m_first + bucket.m_count) if (solve->m_sorted[i].m_rank == 0) near |=
            limitFeature(solve, i, bucket.m_first + bucket.m_count);
        syncAll();
    }
    return near;
}

#endif
