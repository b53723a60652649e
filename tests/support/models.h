// Published meshes that some tests need and the repository does not hold.
#pragma once

#include <string>

#include "scenes/mesh.h"

namespace drape::test
{
// The Stanford bunny of 69,666 triangles: bunny_69k.obj in the folder DRAPE_MODELS_DIR, else the one of Debian's
// glmark2-data. Returns an empty text, else why there is none.
std::string loadBunny(TriangleMesh& bunny);
}  // namespace drape::test
