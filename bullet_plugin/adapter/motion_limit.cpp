#include "bullet_plugin/adapter/motion_limit.h"

#include <algorithm>

namespace drape
{
namespace
{
// Share of the least distance allowed that needs no closer look; the rest is for rounding.
constexpr btScalar kSureShare = btScalar(0.99);

// Where on the way from start to end, 0 to 1, the point is nearest.
btScalar closestOnPath(const btVector3& start, const btVector3& end, const btVector3& point)
{
    const btVector3 way = end - start;
    const btScalar length2 = way.length2();
    if (!(length2 > 0)) return 1;
    return std::min(btScalar(1), std::max(btScalar(0), (point - start).dot(way) / length2));
}

// Brings the node back to the path where it is farther off than the radius, which goes from one end's to the other's.
void keepNear(btSoftBody::Node& node, const btVector3& start, const btVector3& end, btScalar startRadius,
              btScalar endRadius, btScalar velocityScale)
{
    const btScalar t = closestOnPath(start, end, node.m_x);
    const btVector3 off = node.m_x - (start + (end - start) * t);
    const btScalar radius = startRadius + (endRadius - startRadius) * t;
    const btScalar distance = off.length();
    if (!(distance > radius)) return;
    const btVector3 shift = off * (radius / distance - 1);
    node.m_x += shift;
    node.m_v += shift * velocityScale;
}
}  // namespace

void MotionLimit::clear()
{
    m_regions.clear();
    m_leastReach = m_free = SIMD_INFINITY;
}

btScalar MotionLimit::tube(btScalar thickness, btScalar activation)
{
    return thickness * std::max(kLeastShare, std::min(activation, kMostStartShare));
}

void MotionLimit::addObstacle(const btVector3& low, const btVector3& high, btScalar thickness, btScalar activation,
                              const btTransform* carry)
{
    const btScalar reach = thickness * (1 + activation);
    m_leastReach = std::min(m_leastReach, reach);
    const btVector3 margin(reach, reach, reach);
    const btScalar least = tube(thickness, activation);
    m_free = std::min(m_free, kSureShare * std::min(least, kFreeShare * reach));
    m_regions.push_back(Region{low - margin, high + margin, Allowance{least, kFreeShare * reach}, carry != nullptr,
                               carry ? *carry : btTransform::getIdentity()});
}

void MotionLimit::record(const btSoftBody& body)
{
    m_paths.record(body);
    m_hasContact.assign(m_paths.m_end.size(), 0);
}

bool MotionLimit::near(const Region& region, std::size_t node, const btVector3& to) const
{
    btVector3 low = m_paths.m_end[node], high = m_paths.m_end[node];
    low.setMin(to);
    high.setMax(to);
    bool near = true;
    for (int axis = 0; axis < 3; ++axis)
        near = near && low[axis] <= region.m_high[axis] && high[axis] >= region.m_low[axis];
    return near;
}

MotionLimit::Allowance MotionLimit::allowance(const Region& region, std::size_t node) const
{
    const Allowance& own = region.m_allowance;
    return Allowance{own.m_start, m_hasContact[node] ? own.m_start : own.m_end};
}

MotionLimit::Allowance MotionLimit::allowance(std::size_t node, const btVector3& to) const
{
    Allowance least{SIMD_INFINITY, SIMD_INFINITY};
    for (const Region& region : m_regions)
    {
        // A node of a face or an edge that is near may itself be away from all boxes.
        if (region.m_moves || !(m_hasContact[node] || near(region, node, to))) continue;
        const Allowance own = allowance(region, node);
        least.m_start = std::min(least.m_start, own.m_start);
        least.m_end = std::min(least.m_end, own.m_end);
    }
    return least;
}

bool MotionLimit::strayed(const btSoftBody& body) const
{
    const btScalar most = kStrayReaches * m_leastReach;
    const int count = std::min(body.m_nodes.size(), static_cast<int>(m_paths.m_end.size()));
    for (int i = 0; i < count; ++i)
        if ((body.m_nodes[i].m_x - m_paths.m_end[static_cast<std::size_t>(i)]).length2() > most * most) return true;
    return false;
}

void MotionLimit::apply(btSoftBody& body) const
{
    const btScalar velocityScale = body.m_sst.isdt * (1 - body.m_cfg.kDP);
    const int count = std::min(body.m_nodes.size(), static_cast<int>(m_paths.m_end.size()));
    for (int i = 0; i < count; ++i)
    {
        btSoftBody::Node& node = body.m_nodes[i];
        const std::size_t at = static_cast<std::size_t>(i);
        const btVector3 &start = m_paths.m_start[at], &end = m_paths.m_end[at];
        if ((node.m_x - end).length2() <= m_free * m_free || !(m_paths.m_inverseMass[at] > 0)) continue;
        const Allowance allowed = allowance(at, node.m_x);
        if (allowed.m_end != SIMD_INFINITY) keepNear(node, start, end, allowed.m_start, allowed.m_end, velocityScale);
        for (const Region& region : m_regions)
        {
            if (!region.m_moves || !near(region, at, node.m_x)) continue;
            const Allowance own = allowance(region, at);
            keepNear(node, region.m_carry * start, end, own.m_start, own.m_end, velocityScale);
        }
    }
}
}  // namespace drape
