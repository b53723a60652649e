// Answers callers' queries about single pairs: continuous collision of four moving vertices, intersection of two
// triangles.
#include "../lib/ccd.h"
#include "../lib/triangle_pair.h"

static void loadPoints(Vec3* points, __global const float* coordinates, const uint count)
{
    for (uint i = 0; i < count; ++i) points[i] = vec3Load(coordinates, i);
}

// A work-item is a query.
__kernel void queryMotion(__global const CcdQuery* restrict queries, const uint count, const float separation,
                          const float tolerance, const float timeTolerance, const uint boxLimit,
                          __global CcdResult* restrict results)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    Vec3 start[4], end[4];
    loadPoints(start, queries[i].m_start, 4);
    loadPoints(end, queries[i].m_end, 4);
    results[i] = ccdOfKind(queries[i].m_kind, start, end,
                           ccdSettings(separation, tolerance, timeTolerance, boxLimit));
}

// A work-item is a query.
__kernel void queryTriangles(__global const TriangleQuery* restrict queries, const uint count,
                             __global uint* restrict results)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    FeatureTriangle a, b;
    loadPoints(a.m_p, queries[i].m_a, 3);
    loadPoints(b.m_p, queries[i].m_b, 3);
    results[i] = trianglePairTest(a.m_p, b.m_p, -1.0f) & DRAPE_PAIR_MEETS;
}

// Lists the pairs that meet or come within the radius (m; none if negative). A work-item takes every stride-th of the
// `count` pairs. The list's demand must be zero before; it counts on when the list is full.
__kernel void queryPairs(__global const Candidate* restrict pairs, const uint count,
                         __global const float* restrict positionsA, __global const Triangle* restrict trianglesA,
                         __global const float* restrict positionsB, __global const Triangle* restrict trianglesB,
                         const float radius, __global PairAnswer* restrict answers, const uint capacity,
                         __global volatile uint* demand)
{
    for (uint i = get_global_id(0); i < count; i += get_global_size(0))
    {
        const PairAnswer answer =
            trianglePairAnswer(pairs[i], positionsA, trianglesA, positionsB, trianglesB, radius);
        if (answer.m_bits == 0u) continue;
        const uint place = atomic_inc(demand);
        if (place < capacity) answers[place] = answer;
    }
}
