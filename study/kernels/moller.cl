// Möller's test of pairs of triangles, as the thesis's narrow phase has it.
#include "../../kernels/queries/queries_bindings.h"
#include "lib/moller.h"

static void loadCorners(FeatureTriangle* triangle, __global const float* coordinates)
{
    for (uint i = 0; i < 3; ++i)
        triangle->m_p[i] = vec3Load(coordinates, i);
}

// A work-item is a query. The arguments are those of queryTriangles.
__kernel void mollerTriangles(DRAPE_QUERY_TRIANGLES)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    FeatureTriangle a, b;
    loadCorners(&a, queries[i].m_a);
    loadCorners(&b, queries[i].m_b);
    results[i] = mollerIntersect(a, b) ? 1u : 0u;
}
