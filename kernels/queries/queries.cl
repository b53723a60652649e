// Answers callers' queries about single pairs: continuous collision of four moving vertices, intersection of two
// triangles.
#include "../lib/ccd/ccd.h"
#include "../lib/queries/triangle_pair.h"
#include "queries_bindings.h"

static void loadPoints(Vec3* points, __global const float* coordinates, const uint count)
{
    for (uint i = 0; i < count; ++i)
        points[i] = vec3Load(coordinates, i);
}

// A work-item is a query.
__kernel void queryMotion(DRAPE_QUERY_MOTION)
{
    const uint i = get_global_id(0);
    if (i >= values.m_count) return;
    Vec3 start[4], end[4];
    loadPoints(start, queries[i].m_start, 4);
    loadPoints(end, queries[i].m_end, 4);
    results[i] = ccdOfKind(queries[i].m_kind, start, end, values.m_settings);
}

// A work-item is a query.
__kernel void queryTriangles(DRAPE_QUERY_TRIANGLES)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    FeatureTriangle a, b;
    loadPoints(a.m_p, queries[i].m_a, 3);
    loadPoints(b.m_p, queries[i].m_b, 3);
    results[i] = trianglePairTest(a.m_p, b.m_p, -1.0f) & DRAPE_PAIR_MEETS;
}

// Lists the pairs that meet or come within the radius. A work-item takes every stride-th of the pairs. The list's
// demand must be zero before; it counts on when the list is full.
__kernel void queryPairs(DRAPE_QUERY_PAIRS)
{
    for (uint i = get_global_id(0); i < values.m_count; i += get_global_size(0))
    {
        const PairAnswer answer =
            trianglePairAnswer(pairs[i], positionsA, trianglesA, positionsB, trianglesB, values.m_radius);
        if (answer.m_bits == 0u) continue;
        const uint index = atomic_inc(demand);
        if (index < values.m_capacity) answers[index] = answer;
    }
}
