// The meshes that benchmarks and tests run on, by name.
//
// Four are read from files. bunny is bunny_69k.obj (or Debian's bunny.obj) of 69,666 triangles, from the Stanford 3D
// Scanning Repository. bunny_1m is the bunny with every triangle split in 16. dragon is dragon_871k.ply of 871,414
// triangles, from the same repository. spot is spot_6k.obj of 5,856 triangles by Keenan Crane. sphere_<n>, torus_<n>
// and terrain_<n> are generated. All stand on the floor at 2 m largest extent.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
// Returns the thesis's models or their replacements, by size.
const std::vector<std::string>& studyModelNames();

// Returns the folders that are searched for model files: the folder named by --models, by DRAPE_MODELS_DIR, then
// Debian's glmark2-data.
std::vector<std::string> modelFolders(const std::string& given);

// Returns false with one line in `error` for an unknown name or a missing file.
bool makeModel(const std::string& name, const std::vector<std::string>& folders, TriangleMesh& mesh,
               std::string& error);
}  // namespace drape
