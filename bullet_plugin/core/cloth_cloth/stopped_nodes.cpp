#include "stopped_nodes.h"

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
        const bool isFree = node.m_mass > 0 && isFinite(node.m_place) && isFinite(node.m_velocity);
        impact.m_isHeld = impact.m_isHeld || !isFree;
        if (isFree) impact.m_whole.add(node.m_mass, node.m_place, node.m_velocity);
    }
    bool anyFree = false;
    for (auto& impact : impacts)
    {
        impact.second.m_whole.compute(motion != ImpactMotion::Straight);
        anyFree = anyFree || !impact.second.m_isHeld;
    }
    const auto impactOf = [&](const StoppedNode& node) -> Impact*
    {
        const auto found = impacts.find(node.m_impact);
        return found == impacts.end() || found->second.m_isHeld ? nullptr : &found->second;
    };
    for (StoppedNode& node : nodes)
    {
        Impact* const impact = impactOf(node);
        node.m_isHeld = !impact && node.m_impact != NodeGroups::kNone;
        if (impact) node.m_velocity = node.m_velocity - impact->m_whole.velocityAt(node.m_place);
        node.m_velocity = (impact && motion != ImpactMotion::Shares ? 0 : node.m_share) * node.m_velocity;
        if (impact) impact->m_left.add(node.m_mass, node.m_place, node.m_velocity);
    }
    for (auto& impact : impacts)
        impact.second.m_left.compute();
    for (StoppedNode& node : nodes)
        if (const Impact* const impact = impactOf(node))
            node.m_velocity =
                node.m_velocity + impact->m_whole.velocityAt(node.m_place) - impact->m_left.velocityAt(node.m_place);
    return anyFree;
}
}  // namespace drape
