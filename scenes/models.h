// The meshes that benchmarks and tests run on, by name.
//
// bunny, bunny_1m (the bunny, every triangle split in 16), dragon and spot are read from files: bunny_69k.obj (or
// Debian's bunny.obj) of 69,666 triangles and dragon_871k.ply of 871,414 from the Stanford 3D Scanning Repository,
// spot_6k.obj of 5,856 by Keenan Crane. sphere_<n> and torus_<n>, terrain_<n> are made. All are placed on the floor at
// 2 m largest extent.
#pragma once

#include <string>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
// The thesis's models or what stands for them, by size.
const std::vector<std::string>& studyModelNames();

// Where model files are looked for: the folder named by --models, by DRAPE_MODELS_DIR, then Debian's glmark2-data.
std::vector<std::string> modelFolders(const std::string& given);

// False with one line in `error` for a name that is not known or a file that is not there.
bool makeModel(const std::string& name, const std::vector<std::string>& folders, TriangleMesh& mesh,
               std::string& error);
}  // namespace drape
