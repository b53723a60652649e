// The meshes that benchmarks run on, by name.
//
// bunny, bunny_1m (the bunny, every triangle split in 16), dragon and spot are read from files; sphere_<n> and
// torus_<n>, terrain_<n> are made. All are placed on the floor at 2 m largest extent.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace drape::bench
{
// Where model files are looked for: the folder named by --models, by DRAPE_MODELS_DIR, then Debian's glmark2-data.
std::vector<std::string> modelFolders(const std::string& given);

// False with one line in `error` for a name that is not known or a file that is not there.
bool makeModel(const std::string& name, const std::vector<std::string>& folders, TriangleMesh& mesh,
               std::string& error);
}  // namespace drape::bench
