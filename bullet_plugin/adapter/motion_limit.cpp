#include "bullet_plugin/adapter/motion_limit.h"

#include <algorithm>
#include <cassert>

namespace drape
{
namespace
{
// Share of the minimum allowed distance that needs no exact test; the rest is for rounding.
constexpr btScalar kSureShare = btScalar(0.99);

// Returns the parameter, 0 to 1, of the path's closest position to the point.
btScalar closestOnPath(const btVector3& start, const btVector3& end, const btVector3& point)
{
    const btVector3 way = end - start;
    const btScalar length2 = way.length2();
    if (!(length2 > 0)) return 1;
    return std::min(btScalar(1), std::max(btScalar(0), (point - start).dot(way) / length2));
}

bool meet(const btVector3& low, const btVector3& high, const btVector3& otherLow, const btVector3& otherHigh)
{
    bool meet = true;
    for (int axis = 0; axis < 3; ++axis)
        meet = meet && low[axis] <= otherHigh[axis] && high[axis] >= otherLow[axis];
    return meet;
}

// Moves a position back to the path if it is farther off than the radius, which varies linearly between the ends.
// Returns the displacement, m.
btVector3 shiftToPath(const btVector3& start, const btVector3& end, btScalar startRadius, btScalar endRadius,
                      const btVector3& place)
{
    const btScalar t = closestOnPath(start, end, place);
    const btVector3 off = place - (start + (end - start) * t);
    const btScalar radius = startRadius + (endRadius - startRadius) * t;
    const btScalar distance = off.length();
    if (!(distance > radius)) return btVector3(0, 0, 0);
    return off * (radius / distance - 1);
}

// Brings a node back to the path in the same way. Returns whether it was moved.
bool bringBack(btSoftBody::Node& node, const btVector3& start, const btVector3& end, btScalar startRadius,
               btScalar endRadius, btScalar velocityScale)
{
    const btVector3 shift = shiftToPath(start, end, startRadius, endRadius, node.m_x);
    if (shift == btVector3(0, 0, 0)) return false;
    node.m_x += shift;
    node.m_v += shift * velocityScale;
    return true;
}
}  // namespace

void MotionLimit::clear()
{
    m_regions.clear();
    m_anyMoves = false;
    m_leastReach = m_leastTolerance = m_free = SIMD_INFINITY;
}

btScalar MotionLimit::pathTolerance(btScalar thickness, btScalar activation)
{
    return thickness * std::max(kLeastShare, std::min(activation, kMostStartShare));
}

void MotionLimit::addObstacle(const btVector3& low, const btVector3& high, btScalar thickness, btScalar activation,
                              const btTransform* carry, const btVector3* carriedStarts)
{
    const btScalar reach = thickness * (1 + activation);
    m_leastReach = std::min(m_leastReach, reach);
    const btVector3 margin(reach, reach, reach);
    const btScalar least = pathTolerance(thickness, activation);
    m_leastTolerance = std::min(m_leastTolerance, least);
    const bool moves = carry || carriedStarts;
    m_anyMoves = m_anyMoves || moves;
    m_free = std::min(m_free, kSureShare * std::min(least, kFreeShare * reach));
    m_regions.push_back(Region{low - margin, high + margin, Allowance{least, kFreeShare * reach}, moves,
                               carry ? *carry : btTransform::getIdentity(), carriedStarts});
}

void MotionLimit::startRecord(const ClothFaces& faces)
{
    m_paths.resize(faces.nodeCount());
    m_hasContact.assign(m_paths.m_end.size(), 0);
    m_faces = &faces;
}

void MotionLimit::recordNodes(const btSoftBody& body, std::size_t first, std::size_t count)
{
    assert(m_paths.m_end.size() == static_cast<std::size_t>(body.m_nodes.size()));
    for (std::size_t i = first; i < first + count; ++i)
        m_paths.record(i, body.m_nodes[static_cast<int>(i)]);
}

void MotionLimit::recordEnds(const btSoftBody& body, std::size_t first, std::size_t count)
{
    for (std::size_t i = first; i < first + count; ++i)
        m_paths.recordEnd(i, body.m_nodes[static_cast<int>(i)]);
}

void MotionLimit::record(const btSoftBody& body, const ClothFaces& faces)
{
    startRecord(faces);
    recordNodes(body, 0, m_paths.m_end.size());
}

MotionLimit::Allowance MotionLimit::allowance(const Region& region, std::size_t node) const
{
    const Allowance& own = region.m_allowance;
    return Allowance{own.m_start, m_hasContact[node] ? own.m_start : own.m_end};
}

bool MotionLimit::strayed(const btSoftBody& body)
{
    const btScalar most = kFreeShare * m_leastReach;
    const int count = std::min(body.m_nodes.size(), static_cast<int>(m_paths.m_end.size()));
    m_restless.clear();
    for (int i = 0; i < count; ++i)
        if ((body.m_nodes[i].m_x - m_paths.m_end[static_cast<std::size_t>(i)]).length2() > most * most)
            m_restless.push_back(Restless{i, Allowance{SIMD_INFINITY, SIMD_INFINITY}});
    if (m_restless.empty()) return false;
    boxPassed(body, true);
    return std::any_of(m_regions.begin(), m_regions.end(), [this](const Region& region) { return markNear(region); });
}

bool MotionLimit::isRestless(std::size_t node, const btVector3& place) const
{
    const btScalar off2 = (place - m_paths.m_end[node]).length2();
    return !(off2 <= m_free * m_free) && m_paths.m_inverseMass[node] > 0;
}

// Limits the node alone: every resting obstacle enforces the same region along its path.
bool MotionLimit::keepNear(std::size_t node, btVector3& place) const
{
    if (!isRestless(node, place)) return false;
    const btVector3 shift =
        shiftToPath(m_paths.m_start[node], m_paths.m_end[node], m_leastTolerance, m_leastTolerance, place);
    place += shift;
    return !(shift == btVector3(0, 0, 0));
}

bool MotionLimit::findRestless(const btSoftBody& body)
{
    const int count = std::min(body.m_nodes.size(), static_cast<int>(m_paths.m_end.size()));
    m_restless.clear();
    for (int i = 0; i < count; ++i)
    {
        if (!isRestless(static_cast<std::size_t>(i), body.m_nodes[i].m_x)) continue;
        m_restless.push_back(Restless{i, Allowance{SIMD_INFINITY, SIMD_INFINITY}});
    }
    return !m_restless.empty();
}

void MotionLimit::addPassed(const btSoftBody& body, int a, int b, int c)
{
    const btVector3& first = m_paths.m_end[static_cast<std::size_t>(a)];
    Passed passed{first, first, {a, b, c}};
    for (const int node : passed.m_nodes)
    {
        for (const btVector3& place : {m_paths.m_end[static_cast<std::size_t>(node)], body.m_nodes[node].m_x})
        {
            passed.m_low.setMin(place);
            passed.m_high.setMax(place);
        }
    }
    m_allLow.setMin(passed.m_low);
    m_allHigh.setMax(passed.m_high);
    m_passed.push_back(passed);
}

// Boxes the motion of restless nodes, and of triangles with such a node. Beside resting obstacles only nodes without
// contacts matter.
void MotionLimit::boxPassed(const btSoftBody& body, bool withContacts)
{
    m_passed.clear();
    m_allLow.setValue(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY);
    m_allHigh = -m_allLow;
    m_isBoxed.assign(m_paths.m_end.size(), 0);
    for (const Restless& restless : m_restless)
    {
        const std::size_t at = static_cast<std::size_t>(restless.m_node);
        if (!withContacts && m_hasContact[at]) continue;
        m_isBoxed[at] = 1;
        addPassed(body, restless.m_node, restless.m_node, restless.m_node);
    }
    const auto isBoxed = [this](std::int32_t node) { return m_isBoxed[static_cast<std::size_t>(node)] != 0; };
    for (std::size_t i = 0, nodes = m_passed.size(); i < nodes; ++i)
    {
        const int own = m_passed[i].m_nodes[0];
        const auto addFace = [&](const std::int32_t* face)
        {
            // Adds the face once, for the first of its boxed nodes.
            if (*std::find_if(face, face + 3, isBoxed) == own) addPassed(body, face[0], face[1], face[2]);
        };
        m_faces->forFacesOf(static_cast<std::size_t>(own), addFace);
    }
}

bool MotionLimit::markNear(const Region& region)
{
    if (!meet(m_allLow, m_allHigh, region.m_low, region.m_high)) return false;
    m_isNear.assign(m_paths.m_end.size(), 0);
    bool any = false;
    for (const Passed& passed : m_passed)
    {
        if (!meet(passed.m_low, passed.m_high, region.m_low, region.m_high)) continue;
        any = true;
        for (const int node : passed.m_nodes)
            m_isNear[static_cast<std::size_t>(node)] = 1;
    }
    return any;
}

void MotionLimit::applyResting(btSoftBody& body, btScalar velocityScale, bool withContacts)
{
    const auto rests = [](const Region& region) { return !region.m_moves; };
    if (std::none_of(m_regions.begin(), m_regions.end(), rests)) return;
    boxPassed(body, false);
    for (const Region& region : m_regions)
    {
        if (region.m_moves) continue;
        const bool anyNear = markNear(region);
        for (Restless& restless : m_restless)
        {
            const std::size_t at = static_cast<std::size_t>(restless.m_node);
            // Tests the way to the end: a surface that met a node's face there may be away from all boxes at the
            // current position.
            if (!(m_hasContact[at] ? withContacts : anyNear && m_isNear[at])) continue;
            const Allowance own = allowance(region, at);
            restless.m_allowed.m_start = std::min(restless.m_allowed.m_start, own.m_start);
            restless.m_allowed.m_end = std::min(restless.m_allowed.m_end, own.m_end);
        }
    }
    for (const Restless& restless : m_restless)
    {
        const Allowance& allowed = restless.m_allowed;
        if (allowed.m_end == SIMD_INFINITY) continue;
        const std::size_t at = static_cast<std::size_t>(restless.m_node);
        bringBack(body.m_nodes[restless.m_node], m_paths.m_start[at], m_paths.m_end[at], allowed.m_start, allowed.m_end,
                  velocityScale);
    }
}

bool MotionLimit::applyMoving(btSoftBody& body, const Region& region, btScalar velocityScale)
{
    bool moved = false;
    if (!markNear(region)) return moved;
    for (const Restless& restless : m_restless)
    {
        const std::size_t at = static_cast<std::size_t>(restless.m_node);
        if (!m_isNear[at]) continue;
        const Allowance own = allowance(region, at);
        const btVector3 start =
            carriedStart(&region.m_carry, region.m_carriedStarts, restless.m_node, m_paths.m_start[at]);
        moved =
            bringBack(body.m_nodes[restless.m_node], start, m_paths.m_end[at], own.m_start, own.m_end, velocityScale) ||
            moved;
    }
    return moved;
}

void MotionLimit::applyToOthers(btSoftBody& body)
{
    if (findRestless(body)) applyResting(body, body.m_sst.isdt * (1 - body.m_cfg.kDP), false);
}

void MotionLimit::apply(btSoftBody& body)
{
    if (!findRestless(body)) return;
    const btScalar velocityScale = body.m_sst.isdt * (1 - body.m_cfg.kDP);
    applyResting(body, velocityScale, true);
    bool boxed = false;
    for (const Region& region : m_regions)
    {
        if (!region.m_moves) continue;
        if (!boxed) boxPassed(body, true);
        boxed = !applyMoving(body, region, velocityScale);
    }
}
}  // namespace drape
