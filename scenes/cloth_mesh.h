// Cloth from a triangle mesh: the springs that a grid of cloth has, for any triangles.
//
// Cost: n log n in the triangles.
#pragma once

#include <vector>

#include "scenes/cloth_grid.h"

namespace drape
{
// Adds springs to a mesh whose positions are those at rest (m): one along each edge, and one for bending across each
// edge of two triangles, between the two vertices opposite to it. Edges of more triangles get none.
ClothGrid clothOfMesh(TriangleMesh mesh);

// Returns the area of a mesh, m².
double areaOf(const TriangleMesh& mesh);

// Returns masses of the vertices (kg) that add up to `mass`: each has a third of its triangles' areas.
std::vector<double> massesByArea(const TriangleMesh& mesh, double mass);
}  // namespace drape
