// Appends the results of traversals to a list. For devices only.
#ifndef DRAPE_LIB_CANDIDATE_LIST_H
#define DRAPE_LIB_CANDIDATE_LIST_H

#include "../shared/traversal.h"

#ifdef __OPENCL_VERSION__

// Counting costs an atomic per work-item, so only measurements enable it.
#ifdef DRAPE_COUNT_VISITS
#define DRAPE_VISITS(counters, count) atomic_add(&(counters)->m_visits, (count))
#else
#define DRAPE_VISITS(counters, count) (void)(count)
#endif

// Returns whether the step tests the meshes of two triangles against each other. thickness holds cloths × obstacles
// values, negative for pairs that are not tested. One obstacle needs no look-up: a cloth without a pair has empty
// volumes.
static int meshesPaired(const Candidate candidate, __global const Triangle* clothTriangles,
                        __global const Triangle* obstacleTriangles, __global const float* thickness,
                        const uint obstacleMeshes)
{
    if (obstacleMeshes == 1) return 1;
    const uint row = clothTriangles[candidate.m_cloth].m_mesh * obstacleMeshes;
    return !(thickness[row + obstacleTriangles[candidate.m_obstacle].m_mesh] < 0.0f);
}

// Moves candidates that a work-item gathered to the list; one atomic reserves disjoint ranges, whose order does not
// matter. The demand counts on past the capacity; what does not fit is not written, and the host repeats the step with
// a larger list.
// Returns 0 when more than limit were counted: then the traversal may end, since the step is over its limit whatever
// follows, and a count that ran on could wrap around.
static int flushCandidates(__global Candidate* restrict candidates, __global TraversalCounters* restrict counters,
                           const uint capacity, const uint limit, const Candidate* gathered, const uint count)
{
    if (count == 0) return 1;
    const uint place = atomic_add(&counters->m_candidates, count);
    for (uint i = 0; i < count; ++i)
    {
        if (place + i < capacity) candidates[place + i] = gathered[i];
    }
    return place <= limit;
}

// Appends pairs that a work-group gathered (candidates or a front's pairs). Every work-item calls it after a barrier
// that follows the last gathered pair. Two barriers allow the reuse of `place` and `gathered` afterwards. Returns the
// result of flushCandidates() to all.
static int groupFlush(__global uint2* restrict list, __global uint* restrict demand, const uint capacity,
                      const uint limit, __local const uint2* gathered, const uint count, __local uint* place)
{
    if (get_local_id(0) == 0) *place = atomic_add(demand, count);
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint first = *place;
    for (uint i = get_local_id(0); i < count; i += get_local_size(0))
    {
        if (first + i < capacity) list[first + i] = gathered[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return first <= limit;
}

#endif

#endif
