// Two triangles with float corners: whether they have a point in common, exactly, and how far apart they are.
//
// Closed sets: touching counts, a triangle without area is a segment or a point. For callers who ask for the truth, on
// the host: the device's tests (kernels/lib/triangle_pair.h) leave few pairs to ask for.
#pragma once

#include "orientation.h"

namespace drape
{
struct ExactTriangle
{
    ExactPoint m_p[3];
};

// corners: x y z of three, finite.
ExactTriangle exactTriangle(const float* corners);

bool trianglesMeet(const ExactTriangle& a, const ExactTriangle& b);

// Returns the squared distance of two triangles that do not meet, to double rounding of their coordinates.
double squaredDistance(const ExactTriangle& a, const ExactTriangle& b);
}  // namespace drape
