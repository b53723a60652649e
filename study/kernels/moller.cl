// Möller's test of pairs of triangles, as the thesis's narrow phase has it.
#include "../../kernels/shared/query.h"
#include "lib/moller.h"

static void loadCorners(FeatureTriangle* triangle, __global const float* coordinates)
{
    for (uint i = 0; i < 3; ++i)
        triangle->m_p[i] = vec3Load(coordinates, i);
}

// A work-item is a query.
__kernel void mollerTriangles(__global const TriangleQuery* restrict queries, const uint count,
                              __global uint* restrict results)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    FeatureTriangle a, b;
    loadCorners(&a, queries[i].m_a);
    loadCorners(&b, queries[i].m_b);
    results[i] = mollerIntersect(a, b) ? 1u : 0u;
}
