// Makes a finer, rounder copy of a mesh for drawing.
//
// Each level splits every triangle in four. It moves the edges' midpoints onto the curve that the normals at both ends
// suggest (the edge curve of PN triangles, Vlachos et al. 2001). The normals of the given mesh are interpolated, so
// that shading shows no seams. Cost: 4 times the triangles per level. For pictures only: the surface differs from the
// simulated one by parts of the edge length.
#pragma once

#include <cstdint>
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
    // A triangle: bit i is set if its edge from corner i to the next is part of an edge of the mesh before smoothing.
    // Empty: edges are not drawn.
    std::vector<std::uint8_t> m_edges;
    bool m_creases = false;  // corners whose normal leans far from the triangle's are to be drawn flat
};

// `edges` says whether the edges of `mesh` are to be drawn.
ShadedMesh smoothMesh(const TriangleMesh& mesh, int levels, bool edges);
}  // namespace drape
