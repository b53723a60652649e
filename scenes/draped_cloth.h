// Cloths lying on an obstacle as after a fall, for measurements that need contact without a simulation.
//
// A cloth hangs over the highest surface under it with the given vertical gap, nowhere steeper than kDrapeSlope. Its
// nodes are above the surface by the gap, within a tenth of it. So are sample points inside its triangles, which are as
// dense as the obstacle. Nodes beside the obstacle hang down from it. Deterministic. Cost: linear in the nodes plus the
// sample points.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/height_field.h"
#include "scenes/mesh.h"

namespace drape
{
// Rise over run. A steeper drape would stretch the cloth more and come nearer to walls than the vertical gap tells:
// with 1.2 the distance to the surface is 0.64 of the gap at least.
constexpr double kDrapeSlope = 1.2;

struct ClothPlace
{
    int m_cells = 1;        // squares a side, two triangles each
    double m_size = 1;      // m, of a side before it drapes
    double m_x = 0;         // m, centre
    double m_z = 0;         // m
    double m_turn = 0;      // rad, about y
    double m_gap = 0.01;    // m, vertical, to the surface
    double m_detail = 0.1;  // m, distance of the points at which the surface is looked at
};

TriangleMesh drapeCloth(const HeightField& field, const ClothPlace& place);

// Returns `count` random places where the obstacle is under the centre.
std::vector<ClothPlace> scatterCloths(const HeightField& field, const ClothPlace& place, int count, std::uint32_t seed);

// A repeatable motion of cloth nodes: small periodic sways, so that any number of steps stays in contact and every step
// continues the one before. The longest way of a node in a step is at most `way`.
struct ClothMotion
{
    int m_period = 12;     // steps
    double m_way = 0.003;  // m

    // Positions at the end of step `step` − 1, the start of step `step`. out: x y z per vertex of rest.
    void positions(const std::vector<float>& rest, int step, float* out) const;
};
}  // namespace drape
