// Writes meshes for other programs to show: PLY (binary, little-endian) or Wavefront OBJ, chosen by the path's ending.
// Files appear whole or not at all. Returns false with one line in `error` naming file and reason.
#pragma once

#include <string>

#include "scenes/mesh.h"

namespace drape
{
bool writeMesh(const std::string& path, const TriangleMesh& mesh, std::string& error);

// Returns folder/stem_0042.ply for number 42: four digits at least, so that names sort by time.
std::string frameName(const std::string& folder, const std::string& stem, int number);
}  // namespace drape
