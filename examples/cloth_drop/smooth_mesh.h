// A finer, rounder copy of a mesh for drawing: each level splits every triangle in four and puts the edges' middles on
// the curve that the normals at both ends suggest (the edge curve of PN triangles, Vlachos et al. 2001). The normals of
// the given mesh are blended along, so that shading shows no seams. Cost: 4 times the triangles a level. For pictures
// only: the surface differs from the simulated one by parts of the edge length.
#pragma once

#include <vector>

#include "scenes/mesh.h"
#include "scenes/vector3.h"

namespace drape
{
// Unit normals, weighted by area; zero for a vertex without area around it.
std::vector<Vector3> vertexNormals(const TriangleMesh& mesh);

struct ShadedMesh
{
    TriangleMesh m_mesh;
    std::vector<Vector3> m_normals;  // a vertex, unit
    bool m_creases = false;          // corners whose normal leans far from the triangle's are to be drawn flat
};

ShadedMesh smoothMesh(const TriangleMesh& mesh, int levels);
}  // namespace drape
