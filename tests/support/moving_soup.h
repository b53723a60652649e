// Random triangles that move, and positions that are not usable, for tests of kernels over all triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/support/cases.h"
#include "tests/support/side.h"

namespace drape::test
{
// Returns `count` random triangles in a cube of 1 m. Within the step each coordinate moves at random by up to 0.1 m.
Side makeMovingSoup(int count, std::uint32_t seed);

// Overwrites about one coordinate in fifty, at least one, with NaN, infinity, a huge or a denormal number.
void spoil(std::vector<float>& positions, Random& random);
}  // namespace drape::test
