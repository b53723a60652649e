// The order of a mesh's triangles as leaves: by the Morton code of the centroid, equal codes by number. O(n log n).
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared/mesh.h"

namespace drape
{
// The box of all centroids that are finite; low is infinite where there is none.
struct CentroidBounds
{
    Vec3 m_low, m_high;
};

// positions: m, x y z per vertex that triangles refer to.
CentroidBounds centroidBounds(const std::vector<Triangle>& triangles, const float* positions);

// Triangles in the order of their codes of 30 bits. NaN centroids sort by a code of zero.
std::vector<std::uint32_t> mortonOrderOnHost(const std::vector<Triangle>& triangles, const float* positions);
}  // namespace drape
