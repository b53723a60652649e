// Whether a mesh that a caller hands over can be used: every index names a vertex.
//
// Input: a description as given. Output: false, and the call with the first bad index, its triangle and the number of
// vertices in `error`. Nothing past the arrays' ends is read. O(triangles).
#pragma once

#include "drape/error.h"
#include "drape/mesh_description.h"

namespace drape
{
bool checkIndices(const MeshDescription& mesh, const char* call, Error& error);
}  // namespace drape
