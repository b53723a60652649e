// One resolved contact, the input of contact sweeps and cuts. Lengths in metres, world frame.
#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/lib/geometry/rigid_motion.h"
#include "kernels/lib/solver/acting_contact.h"
#include "solver_nodes.h"

namespace drape
{
// An obstacle's motion in the step, as it carries points near it.
struct Carry
{
    const float* m_map = nullptr;    // rigid motion, three rows of rotation and shift; null if the obstacle rests
    const Vec3* m_starts = nullptr;  // by node of the cloth: its carried start, beside an obstacle whose vertices move;
                                     // null if m_map applies

    bool moves() const { return m_map || m_starts; }
    // Returns where the motion carries a point from the step's start.
    Vec3 point(Vec3 p) const { return m_map ? mapPoint(m_map, p) : p; }
    // Returns where the motion carries a node's start.
    Vec3 start(std::size_t node, Vec3 p) const { return m_starts ? m_starts[node] : point(p); }
};

struct SolverContact
{
    int m_nodes[3];  // -1 where unused
    ContactPlane m_plane;
    float m_thickness;
    float m_time;  // time of impact, 0 to 1; 1 if nothing was passed
    ContactGaps m_gaps;
    float m_friction;
    Carry m_carry;
};

// Returns what a contact's row needs of its feature's nodes. nodes: indices, -1 where unused.
inline FeatureNodes featureNodes(const SolverNodes& all, const int nodes[3], const Carry& carry)
{
    FeatureNodes feature = {};
    feature.m_moves = carry.moves();
    for (int k = 0; k < 3 && nodes[k] >= 0; ++k)
    {
        const std::size_t node = std::size_t(nodes[k]);
        feature.m_nodes[k] = std::uint32_t(node);
        feature.m_starts[k] = all.start(node);
        feature.m_carried[k] = carry.start(node, all.start(node));
        feature.m_ends[k] = all.end(node);
        feature.m_inverseMasses[k] = all.inverseMass(node);
        ++feature.m_count;
    }
    return feature;
}
}  // namespace drape
