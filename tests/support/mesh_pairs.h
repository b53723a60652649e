// Finds the triangles of two meshes that are near or meet: using a back end, and by testing every pair exactly. Both
// lists are sorted. Lengths in metres.
#pragma once

#include <vector>

#include <drape/queries.h>
#include "scenes/mesh.h"

namespace drape::test
{
// Records a failure and returns nothing when the back end cannot answer.
MeshPairs meshPairsOn(const Settings& settings, const TriangleMesh& a, const TriangleMesh& b, float radius);

// Returns the pairs that have a point in common, by brute force in exact arithmetic (oracle.h). O(triangles²).
std::vector<NearTriangles> meetingPairs(const TriangleMesh& a, const TriangleMesh& b);
}  // namespace drape::test
