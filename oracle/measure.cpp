#include "oracle/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "oracle/exact_predicates.h"

namespace drape
{
namespace
{
constexpr double kEverywhere = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1 + 1e-9;  // far above double rounding, far below any length of interest

void lowerGap(StepMeasure& step, double gap)
{
    step.m_gapMin = std::min(step.m_gapMin, gap);
}

void notePenetration(StepMeasure& step, double depth)
{
    step.m_penetrationMax = std::max(step.m_penetrationMax, depth);
    lowerGap(step, -depth);
}
}  // namespace

PenetrationMeter::PenetrationMeter(const TriangleMesh& obstacle, const TriangleMesh& cloth)
    : m_surface(obstacle),
      m_clothTree(cloth.m_positions.data(), cloth.vertexCount(), cloth.m_triangles.data(), cloth.triangleCount()),
      m_positions(cloth.m_positions),
      m_before(cloth.vertexCount()),
      m_nodes(cloth.vertexCount()),
      m_neighbours(obstacle.vertexCount()),
      m_reach(0.01 * boundsOf(obstacle).largestExtent())
{
    for (std::size_t i = 0; i < m_nodes.size(); ++i)
        m_nodes[i].m_position = m_before[i] = m_clothTree.vertex(static_cast<std::int32_t>(i));
    for (std::size_t i = 0; i < obstacle.m_triangles.size(); ++i)
        m_neighbours[static_cast<std::size_t>(obstacle.m_triangles[i])].push_back(
            obstacle.m_triangles[i % 3 == 2 ? i - 2 : i + 1]);
    // A closed surface has each edge in both directions; at a boundary the other direction is missing, which only means
    // that the surface is not followed along that edge that way round.
}

StepMeasure PenetrationMeter::measure(const float* positions)
{
    StepMeasure step;
    step.m_gapMin = kEverywhere;
    m_cutTriangles.clear();
    acceptPositions(positions, step);
    m_clothTree.refit(m_positions.data());
    for (const bool near : {true, false})  // near ones first: they spare most of the others
        for (std::size_t i = 0; i < m_nodes.size(); ++i)
            if ((m_nodes[i].m_lower < m_reach) == near && (near || m_nodes[i].m_lower < step.m_gapMin))
                measureNode(i, step);
    countIntersections(step);
    followCuts(step);
    lowerGapByVertices(step);
    return step;
}

void PenetrationMeter::acceptPositions(const float* positions, StepMeasure& step)
{
    for (std::size_t i = 0; i < m_nodes.size(); ++i)
    {
        const float* p = positions + 3 * i;
        m_before[i] = m_nodes[i].m_position;
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
        {
            ++step.m_invalidNodes;
            continue;
        }
        std::copy(p, p + 3, &m_positions[3 * i]);
        m_nodes[i].m_position = {p[0], p[1], p[2]};
        const double moved = length(m_nodes[i].m_position - m_before[i]) * kRounding;
        m_nodes[i].m_lower -= moved;
        m_nodes[i].m_upper += moved;
    }
}

void PenetrationMeter::measureNode(std::size_t node, StepMeasure& step)
{
    NodeState& state = m_nodes[node];
    const double radius = state.m_upper * kRounding;
    const ClosestPoint closest = m_surface.tree().closest(state.m_position, radius * radius);
    if (closest.m_triangle < 0) return;
    const double distance = std::sqrt(closest.m_squaredDistance);
    state.m_upper = distance;
    state.m_below = nodeBelow(node, closest);
    // A node that is below, or whose side is unknown, is checked again each step.
    state.m_lower = state.m_below || (!m_surface.closed() && state.m_side == 0) ? 0 : distance;
    if (!state.m_below) return lowerGap(step, distance);
    step.m_nodeDepths.push_back(static_cast<float>(distance));
    notePenetration(step, distance);
}

bool PenetrationMeter::nodeBelow(std::size_t node, const ClosestPoint& closest)
{
    NodeState& state = m_nodes[node];
    if (m_surface.closed()) return m_surface.inside(state.m_position, closest);
    const int side = m_surface.sideOf(state.m_position, closest);
    bool crossed = false;
    const Vector3 &p = m_before[node], &q = state.m_position;
    m_surface.tree().visitBox({std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
                              {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)},
                              [&](std::int32_t triangle)
                              {
                                  Vector3 corners[3];
                                  m_surface.tree().corners(triangle, corners);
                                  crossed = crossed || segmentMeetsTriangle(p, q, corners);
                              });
    if (side == 0) return state.m_below;
    if (state.m_side == 0 || (!crossed && !state.m_below)) state.m_side = side;  // at first, or gone round the boundary
    return side != state.m_side;
}

void PenetrationMeter::countIntersections(StepMeasure& step)
{
    m_clothTree.visitPairs(m_surface.tree(),
                           [&](std::int32_t face, std::int32_t triangle)
                           {
                               Vector3 a[3], b[3];
                               m_clothTree.corners(face, a);
                               m_surface.tree().corners(triangle, b);
                               if (!trianglesIntersect(a, b)) return;
                               ++step.m_intersectingPairs;
                               m_cutTriangles.push_back(triangle);
                           });
}

bool PenetrationMeter::clothPointBelow(const ClosestPoint& onCloth) const
{
    const ClosestPoint closest = m_surface.tree().closest(onCloth.m_point, kEverywhere);
    if (m_surface.closed()) return m_surface.inside(onCloth.m_point, closest);
    const int side = m_surface.sideOf(onCloth.m_point, closest);
    for (int corner = 0; corner < 3; ++corner)
    {
        const NodeState& state = m_nodes[static_cast<std::size_t>(m_clothTree.indices(onCloth.m_triangle)[corner])];
        if (state.m_side != 0 && side != 0) return side != state.m_side;
    }
    return false;
}

Vector3 PenetrationMeter::outerNormal(std::int32_t face) const
{
    Vector3 c[3];
    m_clothTree.corners(face, c);
    const Vector3 normal = normalized(cross(c[1] - c[0], c[2] - c[0]));
    double away = 0;
    for (int i = 0; i < 3; ++i)
        if (!m_nodes[static_cast<std::size_t>(m_clothTree.indices(face)[i])].m_below)
            away += dot(normal, c[i] - m_surface.tree().closest(c[i], kEverywhere).m_point);
    return away < 0 ? -1.0 * normal : normal;
}

void PenetrationMeter::followCuts(StepMeasure& step)
{
    std::vector<std::int32_t> front;
    for (const std::int32_t triangle : m_cutTriangles)
        front.insert(front.end(), m_surface.tree().indices(triangle), m_surface.tree().indices(triangle) + 3);
    std::unordered_set<std::int32_t> seen(front.begin(), front.end());
    front.assign(seen.begin(), seen.end());
    while (!front.empty())
    {
        const std::int32_t v = front.back();
        front.pop_back();
        const Vector3& vertex = m_surface.tree().vertex(v);
        const ClosestPoint closest = m_clothTree.closest(vertex, kEverywhere);
        if (dot(vertex - closest.m_point, outerNormal(closest.m_triangle)) <= 0 || !clothPointBelow(closest)) continue;
        notePenetration(step, std::sqrt(closest.m_squaredDistance));
        for (const std::int32_t next : m_neighbours[static_cast<std::size_t>(v)])
            if (seen.insert(next).second) front.push_back(next);
    }
}

void PenetrationMeter::lowerGapByVertices(StepMeasure& step) const
{
    for (std::size_t v = 0; v < m_surface.tree().vertexCount() && step.m_gapMin > 0; ++v)
    {
        const Vector3& vertex = m_surface.tree().vertex(static_cast<std::int32_t>(v));
        const ClosestPoint closest = m_clothTree.closest(vertex, step.m_gapMin * step.m_gapMin);
        if (closest.m_triangle >= 0) lowerGap(step, std::sqrt(closest.m_squaredDistance));
    }
}
}  // namespace drape
