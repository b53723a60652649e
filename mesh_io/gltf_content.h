// The JSON of glTF, which a text file is and a binary file has as a chunk.
#pragma once

#include <string>

#include "mesh_io/readers.h"

namespace drape
{
// Reads the triangles of the default scene. `binary` is the binary chunk, or null; `fileBytes` the size of the whole
// file, which bounds how much its nodes may repeat. Returns "" or the reason.
std::string readGltfContent(const std::string& text, const std::string* binary, std::size_t fileBytes,
                            const FindBuffer& findBuffer, MeshFile& mesh);
}  // namespace drape
