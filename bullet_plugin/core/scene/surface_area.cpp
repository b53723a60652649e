#include "surface_area.h"

#include <cmath>

#include "kernels/lib/segment.h"
#include "kernels/lib/vec3.h"

namespace drape
{
double surfaceArea(const std::vector<Triangle>& triangles, const float* positions)
{
    double area = 0;
    for (const Triangle& triangle : triangles)
    {
        const Vec3 a = vec3Load(positions, triangle.m_vertices[0]);
        const Vec3 ab = vec3Sub(vec3Load(positions, triangle.m_vertices[1]), a);
        const Vec3 ac = vec3Sub(vec3Load(positions, triangle.m_vertices[2]), a);
        const double twice = isSegment(&triangle) ? vec3Dot(ab, ab) : vec3Length(vec3Cross(ab, ac));
        if (std::isfinite(twice)) area += 0.5 * twice;
    }
    return area;
}
}  // namespace drape
