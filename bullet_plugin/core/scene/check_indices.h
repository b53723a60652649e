// Checks that a caller's mesh is usable: its arrays exist, and every index names a vertex.
//
// Input: a description as given. Output: false, and in `error` the call with the first bad index, its triangle or
// edge and the number of vertices. Nothing past the arrays' ends is read. O(triangles).
#pragma once

#include "drape/error.h"
#include "drape/mesh_description.h"

namespace drape
{
bool checkIndices(const MeshDescription& mesh, const char* call, Error& error);
}  // namespace drape
