// Writes meshes for other programs to show: PLY (binary, little-endian) or Wavefront OBJ, chosen by the path's ending.
// Lines, two vertices each, are edges of the PLY and lines of the OBJ. Files appear whole or not at all. Returns false
// with one line in `error` naming file and reason.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
bool writeMesh(const std::string& path, const TriangleMesh& mesh, std::string& error,
               const std::vector<std::int32_t>& lines = {});

// Returns folder/stem_0042.ply for number 42: four digits at least, so that names sort by time.
std::string frameName(const std::string& folder, const std::string& stem, int number);
}  // namespace drape
