// Drives a Pipeline as a caller does: meshes in, motions and pairs named, contacts out.
#pragma once

#include <vector>

#include "bullet_plugin/core/pipeline/pipeline.h"
#include "scenes/mesh.h"
#include "tests/support/cases.h"

namespace drape::test
{
MeshId addCloth(Pipeline& pipeline, const TriangleMesh& mesh);
MeshId addObstacle(Pipeline& pipeline, const TriangleMesh& mesh);

// Writes the cloth's nodes for the coming step.
void setMotion(Pipeline& pipeline, MeshId cloth, const std::vector<float>& start, const std::vector<float>& end);

// Calls submit() and finish().
std::vector<Contact> runStep(Pipeline& pipeline);

// Returns a pipeline's contacts of one case.
std::vector<Contact> runCase(Pipeline& pipeline, const StepCase& step);
}  // namespace drape::test
