// Makes a finer, rounder copy of a mesh for drawing.
//
// Each level splits every triangle in four. It moves the edges' midpoints onto the curve that the normals at both ends
// suggest (the edge curve of PN triangles, Vlachos et al. 2001). The normals of the given mesh are interpolated, so
// that shading shows no seams. Cost: 4 times the triangles per level. For pictures only: the surface differs from the
// simulated one by parts of the edge length.
#pragma once

#include <vector>

#include "scenes/mesh.h"
#include "scenes/vector3.h"

namespace drape
{
// Returns unit normals, weighted by area; zero for a vertex without area around it.
std::vector<Vector3> vertexNormals(const TriangleMesh& mesh);

struct ShadedMesh
{
    TriangleMesh m_mesh;
    std::vector<Vector3> m_normals;  // a vertex, unit
    bool m_creases = false;          // corners whose normal leans far from the triangle's are to be drawn flat
};

ShadedMesh smoothMesh(const TriangleMesh& mesh, int levels);
}  // namespace drape
