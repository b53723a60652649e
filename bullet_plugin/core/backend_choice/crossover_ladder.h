// Times two back ends on a ladder of scenes. Cloths from two to some thousands of triangles lie draped over a wavy
// sheet and sway; sheets are as coarse as the cloth or four times finer.
//
// Output: rungs for bestCrossover(). A sheet's ladder ends where the device is well ahead or a step on the host takes
// long. The back ends are for the measurement alone: they know its scenes afterwards. Cost: a second or two.
#pragma once

#include "crossover.h"

namespace drape
{
class DeviceBackend;
class HostBackend;

struct LadderBackends
{
    HostBackend& m_host;
    DeviceBackend& m_device;
    const Settings& m_settings;
    unsigned m_threads;  // number of the host's threads
};

// busy: whether other processes kept the machine busy meanwhile, or the times of a scene varied widely.
// Returns null, or why the device cannot be measured: it failed, has no room for a step, or its
// contacts differ from the host's.
const char* measureLadder(const LadderBackends& backends, std::vector<CrossoverRung>& rungs, bool& busy);
}  // namespace drape
