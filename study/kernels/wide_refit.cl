// Leaves of a tree of nodes with two to four children, or with bundles of leaves; kernels/queries/refit.cl has the
// nodes above.
#include "../../kernels/lib/geometry/dop.h"

// A work-item is a node; the leaves' volumes are made from their triangles, without a radius.
__kernel void refitWideLeaves(__global BvhNode* restrict nodes, __global const uint* restrict order,
                              __global const Triangle* restrict triangles, __global const float* restrict positions,
                              const uint count)
{
    const uint i = get_global_id(0);
    if (i >= count || nodes[i].m_count > 0) return;
    Dop dop;
    leafVolume(&dop, triangles + order[nodes[i].m_first], positions, positions, 0.0f);
    dopStore(nodes + i, &dop);
}
