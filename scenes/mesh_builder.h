// Appends single vertices (m), triangles and quads to a mesh; the corners of a face counter-clockwise from outside. No
// checks.
#pragma once

#include "scenes/mesh.h"

namespace drape
{
inline void addVertex(TriangleMesh& mesh, double x, double y, double z)
{
    mesh.m_positions.insert(mesh.m_positions.end(),
                            {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
}

inline void addTriangle(TriangleMesh& mesh, int a, int b, int c)
{
    mesh.m_triangles.insert(mesh.m_triangles.end(), {a, b, c});
}

inline void addQuad(TriangleMesh& mesh, int a, int b, int c, int d)
{
    addTriangle(mesh, a, b, c);
    addTriangle(mesh, a, c, d);
}
}  // namespace drape
