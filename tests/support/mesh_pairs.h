// Which triangles of two meshes are near or meet: as a back end answers, and by testing every pair exactly. Both lists
// are sorted. Lengths in metres.
#pragma once

#include <vector>

#include <drape/queries.h>
#include "scenes/mesh.h"

namespace drape::test
{
// Records a failure and returns nothing when the back end cannot answer.
MeshPairs meshPairsOn(const Settings& settings, const TriangleMesh& a, const TriangleMesh& b, float radius);

// By brute force in exact arithmetic (oracle.h): the pairs that have a point in common. O(triangles²).
std::vector<NearTriangles> meetingPairs(const TriangleMesh& a, const TriangleMesh& b);
}  // namespace drape::test
