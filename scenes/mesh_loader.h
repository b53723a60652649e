// Loads a triangle mesh from a file: OBJ, PLY, STL, glTF and what else Assimp reads.
//
// Polygons become triangles, the transforms of the file's nodes are applied, vertices at equal positions are joined,
// triangles that repeat a vertex are dropped. A file with an error is refused, never repaired: false, and `error` holds
// one line with file, element (counted from 1, as editors do) and reason. Uses Assimp's logger, so one call at a time.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
bool loadMesh(const std::string& path, TriangleMesh& mesh, std::string& error);

// A mesh that moves: the same vertices and triangles in both files, positions at the start and at the end (x y z per
// vertex). Vertices that are at one place in both are joined.
bool loadMotion(const std::string& startPath, const std::string& endPath, TriangleMesh& mesh, std::vector<float>& end,
                std::string& error);
}  // namespace drape
