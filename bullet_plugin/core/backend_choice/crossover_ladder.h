// Times a pipeline's two back ends on a ladder of scenes. Cloths from two to some thousands of triangles lie draped
// over a wavy sheet and sway; sheets are as coarse as the cloth or four times finer.
//
// Output: rungs for bestCrossover(). Guarantee: the pipeline is left without meshes. A sheet's ladder ends where the
// device is well ahead or a step on the host takes long. Cost: a second or two.
#pragma once

#include <functional>

#include "bullet_plugin/core/pipeline/pipeline.h"
#include "crossover.h"

namespace drape
{
// use: selects the host or the device for the pipeline's coming steps. activation: the pipeline's.
// busy: whether other processes kept the machine busy meanwhile, or the times of a scene varied widely.
// Returns null, or why the device cannot be measured: it failed, has no room for a step, or its
// contacts differ from the host's.
const char* measureLadder(Pipeline& pipeline, float activation, const std::function<void(bool onHost)>& use,
                          std::vector<CrossoverRung>& rungs, bool& busy);
}  // namespace drape
