// Published data that some tests need and the repository does not hold: meshes, and queries with their true answers.
//
// The environment variables DRAPE_MODELS_DIR and DRAPE_TRUTH_DIR name its folders. A test whose data is not there is
// skipped; with DRAPE_TEST_NEED_DATA=1 it fails. Each function returns false where one of the two happened to the
// test, which is then to return.
#pragma once

#include <string>

#include "scenes/mesh.h"

namespace drape::test
{
// Loads the Stanford bunny of 69,666 triangles: bunny_69k.obj in the folder DRAPE_MODELS_DIR, else the one of Debian's
// glmark2-data.
bool loadBunny(TriangleMesh& bunny);

// Finds the path of a file in the folder DRAPE_TRUTH_DIR.
bool findTruth(const std::string& name, std::string& path);

// A model of studyModelNames() in scenes/models.h. Where its file is not there the test goes on with the others, and
// fails where DRAPE_MODELS_DIR names a folder or DRAPE_TEST_NEED_DATA says that it must be there.
bool loadStudyModel(const std::string& name, TriangleMesh& mesh);
}  // namespace drape::test
