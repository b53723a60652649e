// Resting pairs of features whose distance and direction are known: what the contacts of the narrow phase are weighed
// by.
//
// A vertex and a face, or two edges whose closest points are inside of both. The truth is that of the float positions
// as they stand, in double. Half of the distances are spread over twice the thickness, half are within a thousandth to
// a hundred-millionth of it. The same seed gives the same set. Metres.
#pragma once

#include <string>
#include <vector>

#include "kernels/shared/query.h"
#include "scenes/vector3.h"

namespace drape::bench
{
struct DistancePair
{
    float m_points[12];    // vertex and face, or edge and edge
    std::uint32_t m_kind;  // DRAPE_VERTEX_FACE or DRAPE_EDGES
    double m_distance;
    Vector3 m_direction;  // unit, from the second feature to the first
    double m_extent;      // largest coordinate difference of its points
};

struct DistanceSet
{
    std::string m_name;
    double m_thickness;
    std::vector<DistancePair> m_pairs;
};

// Pairs of centimetres at the distances from the origin that make float positions coarse.
std::vector<DistanceSet> makeDistanceSets(std::size_t pairs);

// Returns the nearest point of a triangle, in double.
Vector3 nearestOnTriangle(const Vector3& p, const Vector3 corners[3]);

// Returns the offset from the closest point of the edge p[2] p[3] to that of p[0] p[1], both inside of them, in double.
Vector3 offsetOfEdges(const Vector3 p[4]);
}  // namespace drape::bench
