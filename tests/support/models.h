// Published meshes that some tests need and the repository does not hold.
#pragma once

#include <string>

#include "scenes/mesh.h"

namespace drape::test
{
// The Stanford bunny of 69,666 triangles: bunny_69k.obj in the folder DRAPE_MODELS_DIR, else the one of Debian's
// glmark2-data. Returns an empty text, else why there is none.
std::string loadBunny(TriangleMesh& bunny);

// A model of studyModelNames() in scenes/models.h. False where its file is not there, which is a failure of the test
// where DRAPE_MODELS_DIR names a folder.
bool loadStudyModel(const std::string& name, TriangleMesh& mesh);
}  // namespace drape::test
