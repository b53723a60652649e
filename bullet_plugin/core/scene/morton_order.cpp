#include "morton_order.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "kernels/lib/geometry/triangle_order.h"

namespace drape
{
CentroidBounds centroidBounds(const std::vector<Triangle>& triangles, const float* positions)
{
    const float infinity = std::numeric_limits<float>::infinity();
    Vec3 low = vec3(infinity, infinity, infinity), high = vec3(-infinity, -infinity, -infinity);
    for (const Triangle& triangle : triangles)
    {
        const Vec3 p = triangleCentroid(&triangle, positions);
        if (!vec3IsFinite(p)) continue;
        low = vec3(drapeMin(low.x, p.x), drapeMin(low.y, p.y), drapeMin(low.z, p.z));
        high = vec3(drapeMax(high.x, p.x), drapeMax(high.y, p.y), drapeMax(high.z, p.z));
    }
    return {low, high};
}

std::vector<std::uint32_t> mortonOrderOnHost(const std::vector<Triangle>& triangles, const float* positions)
{
    const CentroidBounds bounds = centroidBounds(triangles, positions);
    std::vector<std::uint32_t> codes, order(triangles.size());
    codes.reserve(triangles.size());
    for (const Triangle& triangle : triangles)
        codes.push_back(mortonCode(triangleCentroid(&triangle, positions), bounds.m_low, bounds.m_high));
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
    return order;
}
}  // namespace drape
