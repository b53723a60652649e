// Nodes whose positions are not valid, of cloths that collide with themselves. For kernels only.
#ifndef DRAPE_LIB_INVALID_NODES_H
#define DRAPE_LIB_INVALID_NODES_H

#include "self_cull.h"

// Counts invalid nodes that the triangle owns, of a cloth that the search for obstacles does not visit.
static void countInvalidNodes(__global const Triangle* triangle, __global const float* start, __global const float* end,
                              __global StepCounters* counters)
{
    for (int i = 0; i < 3; ++i)
    {
        if ((triangle->m_owned & DRAPE_OWNS_VERTEX(i)) && !nodeIsValid(start, end, triangle->m_vertices[i]))
            atomic_inc(&counters->m_invalidNodes);
    }
}

#endif
