// Decides exactly whether two triangles with float corners have a common point, and computes their distance.
//
// Triangles are closed sets: touching counts, and a triangle without area is a segment or a point. For exact answers
// on the host: the device's tests (kernels/lib/queries/triangle_pair.h) leave few pairs undecided.
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
