// Key by which triangles are sorted when leaves are ordered.
#ifndef DRAPE_LIB_TRIANGLE_ORDER_H
#define DRAPE_LIB_TRIANGLE_ORDER_H

#include "../../shared/mesh.h"
#include "morton.h"

DRAPE_NAMESPACE_BEGIN

DRAPE_FUNCTION Vec3 triangleCentroid(const DRAPE_GLOBAL Triangle* triangle, const DRAPE_GLOBAL float* positions)
{
    const Vec3 a = vec3Load(positions, triangle->m_vertices[0]);
    const Vec3 b = vec3Load(positions, triangle->m_vertices[1]);
    const Vec3 c = vec3Load(positions, triangle->m_vertices[2]);
    return vec3Scale(vec3Add(vec3Add(a, b), c), 1.0f / 3.0f);
}

DRAPE_NAMESPACE_END

#endif
