// Reads a mesh file of any format that Drape's tools read. The file's ending says which format it is.
#pragma once

#include <string>

#include "mesh_io/mesh_file.h"

namespace drape
{
// The formats, for help and messages.
constexpr const char* kMeshFormats = "OBJ, PLY, STL, glTF";

// Reads and parses the file once (glTF: and the files of its buffers). Returns false with one line in `error` (file,
// element counted from 1, reason) when it cannot be read, has no faces, or a face has a corner that is NaN or infinite.
bool readMeshFile(const std::string& path, MeshFile& mesh, std::string& error);
}  // namespace drape
