// Distances and cones by brute force in double precision: what the product is compared with.
//
// Shares no code and no method with kernels/lib: interior solutions by Cramer's rule, otherwise the least over the
// boundary. Inputs are float positions widened exactly; results are right to about 1e-14 of the largest coordinate
// where the features are not degenerate, and the least distance found never lies below the true one by more. Lengths in
// metres.
#pragma once

#include <vector>

#include "kernels/shared/mesh.h"
#include "scenes/vector3.h"

namespace drape::test
{
Vector3 position(const std::vector<float>& positions, std::uint32_t vertex);

struct NearestOnTriangle
{
    double m_distance;
    double m_weights[3];  // sum 1; exactly 0 off the interior
    Vector3 m_point;
};
NearestOnTriangle nearestOnTriangle(const Vector3& p, const Vector3 corners[3]);

struct NearestOnSegments
{
    double m_distance;
    double m_first, m_second;  // parameters in [0, 1]
    Vector3 m_firstPoint, m_secondPoint;
};
NearestOnSegments nearestOnSegments(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

// Returns 0 if they have a point in common (exact), else the least distance.
double triangleDistance(const Vector3 a[3], const Vector3 b[3]);

// All normals of the triangles around a feature lie within the half-angle of the axis. everything: no bound.
struct DirectionCone
{
    Vector3 m_axis;
    double m_cosine = 1;
    bool m_everything = false;

    // Two-sided: direction (unit) or its opposite lies in the cone.
    bool admits(const Vector3& direction) const;
};

struct SurfaceCones
{
    std::vector<DirectionCone> m_vertices, m_edges;
};
SurfaceCones surfaceCones(const std::vector<Triangle>& triangles, std::size_t edgeCount,
                          const std::vector<float>& positions);
}  // namespace drape::test
