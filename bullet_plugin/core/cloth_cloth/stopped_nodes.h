// The velocities of nodes that stopped each other on their way through a step.
//
// Nodes of one impact keep their common rigid motion, and with it their linear and angular momentum. The rest of their
// velocities shrinks with the way that each could go, or is lost. In an impact with a held node, which takes the
// momentum, the velocities of all nodes shrink as that of the node that went least far. If each kept its own share,
// neighbours would go apart, and cloth would crumple. The energy of these velocities never grows. Double precision; the
// same bits everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/solver/topology/node_groups.h"
#include "bullet_plugin/core/vec3d.h"

namespace drape
{
struct StoppedNode
{
    Vec3d m_place, m_velocity;  // m, m/s
    double m_mass;              // kg; 0 for a node that the app moves, which keeps its velocity
    double m_share;             // 0 to 1, the part of its way that it went
    std::uint32_t m_impact;     // a name that its nodes have in common; NodeGroups::kNone for none
    bool m_isHeld = false;      // something takes its momentum; as a result, that of any node of its impact
};

// Motion that the nodes of an impact keep.
enum class ImpactMotion
{
    Shares,   // their common motion, and each its share of the rest
    Common,   // their common motion alone
    Straight  // their common velocity, without turning: angular momentum is lost
};

// Replaces the velocities. Returns whether there is an impact without held nodes.
bool slowDown(std::vector<StoppedNode>& nodes, ImpactMotion motion);
}  // namespace drape
