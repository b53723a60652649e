#include "stopped_nodes.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "bullet_plugin/core/solver/host/common_motion.h"

namespace drape
{
namespace
{
struct Impact
{
    CommonMotion m_whole, m_left;  // the velocities before, and what remains of their differences
    bool m_isHeld = false;
    double m_leastShare = 1;
};

bool isFinite(Vec3d v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
}  // namespace

bool slowDown(std::vector<StoppedNode>& nodes, ImpactMotion motion)
{
    std::unordered_map<std::uint32_t, Impact> impacts;
    for (const StoppedNode& node : nodes)
    {
        if (node.m_impact == NodeGroups::kNone) continue;
        Impact& impact = impacts[node.m_impact];
        const bool moves = node.m_mass > 0 && isFinite(node.m_place) && isFinite(node.m_velocity);
        impact.m_isHeld = impact.m_isHeld || node.m_isHeld || !moves;
        impact.m_leastShare = std::min(impact.m_leastShare, node.m_share);
        if (moves) impact.m_whole.add(node.m_mass, node.m_place, node.m_velocity);
    }
    bool anyFree = false;
    for (auto& impact : impacts)
    {
        impact.second.m_whole.compute(motion != ImpactMotion::Straight);
        anyFree = anyFree || !impact.second.m_isHeld;
    }
    for (StoppedNode& node : nodes)
    {
        const auto found = impacts.find(node.m_impact);
        node.m_isHeld = found != impacts.end() && found->second.m_isHeld;
        if (!(node.m_mass > 0) || found == impacts.end()) continue;
        Impact& impact = found->second;
        if (node.m_isHeld)
        {
            node.m_velocity = impact.m_leastShare * node.m_velocity;
            continue;
        }
        node.m_velocity = node.m_velocity - impact.m_whole.velocityAt(node.m_place);
        node.m_velocity = (motion != ImpactMotion::Shares ? 0 : node.m_share) * node.m_velocity;
        impact.m_left.add(node.m_mass, node.m_place, node.m_velocity);
    }
    for (auto& impact : impacts)
        impact.second.m_left.compute();
    for (StoppedNode& node : nodes)
    {
        const auto found = impacts.find(node.m_impact);
        if (found == impacts.end() || node.m_isHeld) continue;
        const Impact& impact = found->second;
        node.m_velocity =
            node.m_velocity + impact.m_whole.velocityAt(node.m_place) - impact.m_left.velocityAt(node.m_place);
    }
    return anyFree;
}
}  // namespace drape
