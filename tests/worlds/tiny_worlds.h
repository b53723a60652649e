// Tiny worlds: a cloth of four to nine nodes with ordinary settings, thrown at one small obstacle. They are the
// quickest way to a small case that fails.
#pragma once

#include "tests/worlds/world.h"

namespace drape::test
{
// The obstacle of a kinematic world turns and swings.
void buildTinyWorld(World& world, std::uint64_t seed, bool kinematic);
}  // namespace drape::test
