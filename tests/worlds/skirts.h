// Grids of worlds with a skirt: cloth held at the waist by pinned nodes, on a kinematic body that moves the waist
// along. The setting's number takes the place of a seed.
#pragma once

#include "tests/worlds/world.h"

namespace drape::test
{
// The body makes half a turn in 8 to 20 steps: three bodies, three meshes, two clearances, three flares, six durations.
std::size_t skirtTurnCount();
void buildSkirtTurn(World& world, std::uint64_t setting);

// A narrow and a wide skirt: half a turn in 2 to 30 steps, or a run of a second that starts at once with 1 to 20 m/s.
std::size_t skirtDashCount();
void buildSkirtDash(World& world, std::uint64_t setting);
}  // namespace drape::test
