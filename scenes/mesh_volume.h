// The volume of a closed mesh.
//
// Cost: n log n in the triangles. Lengths in metres.
#pragma once

#include <string>

#include "scenes/mesh.h"

namespace drape
{
// Returns the volume that the mesh encloses, m³; negative if its triangles face inwards. Meaningless for open meshes.
double volumeOf(const TriangleMesh& mesh);

// Returns the reason for a mesh to have no volume of its own, or "". Each edge must belong to two triangles that run
// through it in opposite directions, and all triangles must be connected by edges.
std::string whyNotClosed(const TriangleMesh& mesh);

// Turns the triangles of a closed mesh outwards if they face inwards.
void turnOutwards(TriangleMesh& mesh);
}  // namespace drape
