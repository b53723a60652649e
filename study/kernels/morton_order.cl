// Morton codes of the triangles' centroids: what leaves are sorted by.
#include "../../kernels/lib/geometry/triangle_order.h"
#include "lib/morton_wide.h"

#define DRAPE_BOUNDS_GROUP 64

// Maps floats to unsigned integers in the same order, and back.
static uint floatRank(const float value)
{
    const uint bits = as_uint(value);
    return (bits & 0x80000000u) ? ~bits : bits | 0x80000000u;
}
static float unrank(const uint rank)
{
    return as_float((rank & 0x80000000u) ? rank & 0x7fffffffu : ~rank);
}

// Computes the bounds of the centroids; a work-item takes every stride-th triangle. bounds: the ranks (see floatRank)
// of the least and greatest centroid, three each; all ones and zeros before. Minima and maxima do not depend on the
// order of the atomics.
__kernel __attribute__((reqd_work_group_size(DRAPE_BOUNDS_GROUP, 1, 1))) void mortonBounds(
    __global const Triangle* restrict triangles, __global const float* restrict positions, const uint triangleCount,
    __global volatile uint* bounds)
{
    __local uint group[6];
    const uint item = get_local_id(0);
    if (item < 6) group[item] = item < 3 ? ~0u : 0u;
    barrier(CLK_LOCAL_MEM_FENCE);
    uint low[3] = {~0u, ~0u, ~0u};
    uint high[3] = {0u, 0u, 0u};
    for (uint i = get_global_id(0); i < triangleCount; i += get_global_size(0))
    {
        const Vec3 p = triangleCentroid(triangles + i, positions);
        if (!vec3IsFinite(p)) continue;
        const uint rank[3] = {floatRank(p.x), floatRank(p.y), floatRank(p.z)};
        for (int axis = 0; axis < 3; ++axis)
        {
            low[axis] = min(low[axis], rank[axis]);
            high[axis] = max(high[axis], rank[axis]);
        }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
        atomic_min(group + axis, low[axis]);
        atomic_max(group + 3 + axis, high[axis]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < 3) atomic_min(bounds + item, group[item]);
    if (item >= 3 && item < 6) atomic_max(bounds + item, group[item]);
}

// Writes a triangle's number and its code per work-item. codeBits is 30, or 63 with the upper 31 in high and the rest
// in low.
__kernel void mortonCodes(__global const Triangle* restrict triangles, __global const float* restrict positions,
                          const uint triangleCount, __global const uint* restrict bounds, const uint codeBits,
                          __global uint* restrict high, __global uint* restrict low, __global uint* restrict numbers)
{
    const uint i = get_global_id(0);
    if (i >= triangleCount) return;
    const Vec3 least = vec3(unrank(bounds[0]), unrank(bounds[1]), unrank(bounds[2]));
    const Vec3 greatest = vec3(unrank(bounds[3]), unrank(bounds[4]), unrank(bounds[5]));
    const Vec3 centroid = triangleCentroid(triangles + i, positions);
    if (codeBits == 30)
    {
        high[i] = mortonCode(centroid, least, greatest);
    }
    else
    {
        mortonCodeWide(centroid, least, greatest, high + i, low + i);
    }
    numbers[i] = i;
}
