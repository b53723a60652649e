#include "motion_limit.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace drape
{
namespace
{
// Share of the minimum allowed distance that needs no exact test; the rest is for rounding.
constexpr float kSureShare = 0.99f;

bool bringBack(SolverNodes& nodes, std::size_t node, Vec3 start, Vec3 end, float startRadius, float endRadius)
{
    return drape::bringBack(nodes.nodes() + node, nodes.states() + node, start, end, startRadius, endRadius) != 0;
}
}  // namespace

void MotionLimit::clear()
{
    m_regions.clear();
    m_anyMoves = false;
    m_leastReach = m_leastTolerance = m_sure = kInfinity;
}

float MotionLimit::pathTolerance(float thickness, float activation)
{
    return thickness * std::max(kLeastShare, std::min(activation, kMostStartShare));
}

void MotionLimit::addObstacle(Vec3 low, Vec3 high, float thickness, float activation, const Carry& carry)
{
    const float reach = thickness * (1 + activation);
    m_leastReach = std::min(m_leastReach, reach);
    const Vec3 margin = vec3(reach, reach, reach);
    const float least = pathTolerance(thickness, activation);
    m_leastTolerance = std::min(m_leastTolerance, least);
    m_anyMoves = m_anyMoves || carry.moves();
    m_sure = std::min(m_sure, kSureShare * std::min(least, kFreeShare * reach));
    m_regions.push_back(
        Region{Box{vec3Sub(low, margin), vec3Add(high, margin)}, Allowance{least, kFreeShare * reach}, carry});
}

void MotionLimit::startStep(const ClothFaces& faces)
{
    m_hasContact.assign(faces.nodeCount(), 0);
    m_faces = &faces;
}

MotionLimit::Allowance MotionLimit::allowance(const Region& region, std::size_t node) const
{
    const Allowance& own = region.m_allowance;
    return Allowance{own.m_start, m_hasContact[node] ? own.m_start : own.m_end};
}

bool MotionLimit::anyOffPath(const SolverNodes& nodes)
{
    const float most = freeDistance();
    m_farNodes.clear();
    for (std::size_t i = 0; i < nodes.count(); ++i)
    {
        const Vec3 off = vec3Sub(nodes.displacement(i), nodes.pathVector(i));
        if (vec3Dot(off, off) > most * most) m_farNodes.push_back(FarNode{int(i), Allowance{kInfinity, kInfinity}});
    }
    if (m_farNodes.empty()) return false;
    boxPassed(nodes, true);
    return std::any_of(m_regions.begin(), m_regions.end(), [this](const Region& region) { return markNear(region); });
}

bool MotionLimit::isFar(const SolverNodes& nodes, std::size_t node) const
{
    return isFarFromEnd(nodes.nodes() + node, nodes.paths() + node, m_sure) != 0;
}

// Limits the node alone: every resting obstacle enforces the same region along its path.
void MotionLimit::keepNear(SolverNodes& nodes, std::size_t node) const
{
    if (m_hasContact[node] && isFar(nodes, node))
        bringBack(nodes, node, vec3(0, 0, 0), nodes.pathVector(node), m_leastTolerance, m_leastTolerance);
}

float MotionLimit::mostCarried(const SolverNodes& nodes, Carried which) const
{
    float most2 = 0;
    for (const Region& region : m_regions)
    {
        for (std::size_t i = 0; region.m_carry.moves() && i < nodes.count(); ++i)
        {
            if (which == Carried::ContactNodes && !m_hasContact[i]) continue;
            const Vec3 carried = vec3Sub(region.m_carry.start(i, nodes.start(i)), nodes.start(i));
            most2 = std::max(most2, vec3Dot(carried, carried));
        }
    }
    return std::sqrt(most2);
}

// The displacement is affine in the start, so that a corner has the largest one.
float MotionLimit::mostCarried(Vec3 low, Vec3 high) const
{
    float most2 = 0;
    for (const Region& region : m_regions)
    {
        for (int corner = 0; region.m_carry.moves() && corner < 8; ++corner)
        {
            const Vec3 start =
                vec3(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z);
            const Vec3 carried = vec3Sub(region.m_carry.start(0, start), start);
            most2 = std::max(most2, vec3Dot(carried, carried));
        }
    }
    return std::sqrt(most2);
}

bool MotionLimit::findFarNodes(const SolverNodes& nodes)
{
    assert(m_hasContact.size() == nodes.count());
    m_farNodes.clear();
    for (std::size_t i = 0; i < nodes.count(); ++i)
        if (isFar(nodes, i)) m_farNodes.push_back(FarNode{int(i), Allowance{kInfinity, kInfinity}});
    return !m_farNodes.empty();
}

void MotionLimit::addPassed(const SolverNodes& nodes, int a, int b, int c)
{
    Passed passed{pointBox(nodes.end(std::size_t(a))), {a, b, c}};
    for (const int node : passed.m_nodes)
        growByPassed(&passed.m_box, nodes.nodes() + node, nodes.paths() + node);
    m_all.m_low = vec3Least(m_all.m_low, passed.m_box.m_low);
    m_all.m_high = vec3Most(m_all.m_high, passed.m_box.m_high);
    m_passed.push_back(passed);
}

// Boxes the motion of far nodes, and of triangles with such a node. Beside resting obstacles only nodes without
// contacts matter.
void MotionLimit::boxPassed(const SolverNodes& nodes, bool withContacts)
{
    m_passed.clear();
    m_all.m_low = vec3(kInfinity, kInfinity, kInfinity);
    m_all.m_high = vec3Scale(m_all.m_low, -1);
    m_isBoxed.assign(nodes.count(), 0);
    for (const FarNode& far : m_farNodes)
    {
        const std::size_t at = std::size_t(far.m_node);
        if (!withContacts && m_hasContact[at]) continue;
        m_isBoxed[at] = 1;
        addPassed(nodes, far.m_node, far.m_node, far.m_node);
    }
    const auto isBoxed = [this](std::int32_t node) { return m_isBoxed[std::size_t(node)] != 0; };
    for (std::size_t i = 0, boxed = m_passed.size(); i < boxed; ++i)
    {
        const int own = m_passed[i].m_nodes[0];
        const auto addFace = [&](const std::int32_t* face)
        {
            // Adds the face once, for the first of its boxed nodes.
            if (*std::find_if(face, face + 3, isBoxed) == own) addPassed(nodes, face[0], face[1], face[2]);
        };
        m_faces->forFacesOf(std::size_t(own), addFace);
    }
}

bool MotionLimit::markNear(const Region& region)
{
    if (!boxesMeet(&m_all, &region.m_box)) return false;
    m_isNear.assign(m_isBoxed.size(), 0);
    bool any = false;
    for (const Passed& passed : m_passed)
    {
        if (!boxesMeet(&passed.m_box, &region.m_box)) continue;
        any = true;
        for (const int node : passed.m_nodes)
            m_isNear[std::size_t(node)] = 1;
    }
    return any;
}

void MotionLimit::applyResting(SolverNodes& nodes, bool withContacts)
{
    const auto rests = [](const Region& region) { return !region.m_carry.moves(); };
    if (std::none_of(m_regions.begin(), m_regions.end(), rests)) return;
    boxPassed(nodes, false);
    for (const Region& region : m_regions)
    {
        if (!rests(region)) continue;
        const bool anyNear = markNear(region);
        for (FarNode& far : m_farNodes)
        {
            const std::size_t at = std::size_t(far.m_node);
            // Tests the path to the end: a surface that met a node's face there may be away from all boxes at the
            // current position.
            if (!(m_hasContact[at] ? withContacts : anyNear && m_isNear[at])) continue;
            const Allowance own = allowance(region, at);
            far.m_allowed.m_start = std::min(far.m_allowed.m_start, own.m_start);
            far.m_allowed.m_end = std::min(far.m_allowed.m_end, own.m_end);
        }
    }
    for (const FarNode& far : m_farNodes)
    {
        if (far.m_allowed.m_end == kInfinity) continue;
        const std::size_t at = std::size_t(far.m_node);
        bringBack(nodes, at, vec3(0, 0, 0), nodes.pathVector(at), far.m_allowed.m_start, far.m_allowed.m_end);
    }
}

bool MotionLimit::applyMoving(SolverNodes& nodes, const Region& region)
{
    bool moved = false;
    if (!markNear(region)) return moved;
    for (const FarNode& far : m_farNodes)
    {
        const std::size_t at = std::size_t(far.m_node);
        if (!m_isNear[at]) continue;
        const Allowance own = allowance(region, at);
        const Vec3 start = vec3Sub(region.m_carry.start(at, nodes.start(at)), nodes.start(at));
        moved = bringBack(nodes, at, start, nodes.pathVector(at), own.m_start, own.m_end) || moved;
    }
    return moved;
}

void MotionLimit::applyToOthers(SolverNodes& nodes)
{
    if (findFarNodes(nodes)) applyResting(nodes, false);
}

void MotionLimit::apply(SolverNodes& nodes)
{
    if (!findFarNodes(nodes)) return;
    applyResting(nodes, true);
    bool boxed = false;
    for (const Region& region : m_regions)
    {
        if (!region.m_carry.moves()) continue;
        if (!boxed) boxPassed(nodes, true);
        boxed = !applyMoving(nodes, region);
    }
}
}  // namespace drape
