#include "mesh_io/ear_clipping.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace drape
{
namespace
{
constexpr std::size_t kLeafSize = 4;
constexpr int kTries = 64;  // corners to look at for one that turns left, where no ear is left

// Returns twice the area of a triangle, positive if it turns to the left.
double area(const Point2& a, const Point2& b, const Point2& c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}
}  // namespace

EarClipping::Outcome EarClipping::split(const std::vector<Point2>& outline, std::vector<std::int32_t>& triangles)
{
    start(outline);
    bool simple = true;
    for (std::size_t left = outline.size(); left > 3; --left)
    {
        Corner ear = kNone;
        while (ear == kNone)
        {
            Corner corner = kNone;
            if (!popCandidate(corner))
            {
                simple = false;
                ear = pickAny();
                break;
            }
            const Corner blocker = findBlocker(corner);
            if (m_visits > kMostVisits * outline.size()) return Outcome::TooLong;
            if (blocker == kNone)
                ear = corner;
            else
                m_waiting[blocker].push_back(corner);
        }
        clip(ear, triangles);
    }
    // The last triangle begins with its lowest corner, like a polygon.
    const Corner second = m_next[m_head], third = m_next[second];
    const Corner first = std::min({m_head, second, third});
    for (const Corner corner : {first, m_next[first], m_previous[first]})
        triangles.push_back(static_cast<std::int32_t>(corner));
    return simple ? Outcome::Simple : Outcome::NotSimple;
}

void EarClipping::start(const std::vector<Point2>& outline)
{
    const Corner count = static_cast<Corner>(outline.size());
    m_points = outline;
    m_previous.resize(count);
    m_next.resize(count);
    for (Corner i = 0; i < count; ++i)
    {
        m_previous[i] = i == 0 ? count - 1 : i - 1;
        m_next[i] = i + 1 == count ? 0 : i + 1;
    }
    m_isRemoved.assign(count, 0);
    m_isQueued.assign(count, 0);
    m_isBlocker.assign(count, 0);
    m_waiting.assign(count, {});
    m_queue.clear();
    m_visits = 0;
    m_head = 0;
    buildTree();
    for (Corner i = 0; i < count; ++i)
        if (!turnsLeft(i)) setBlocker(i, true);
    // Corner 1 comes first: a fan from corner 0 begins with its ear.
    for (Corner i = 0; i < count; ++i)
        push(m_next[i]);
}

void EarClipping::buildTree()
{
    const std::size_t count = m_points.size();
    m_leaves = 1;
    while (m_leaves * kLeafSize < count)
        m_leaves *= 2;
    constexpr double far = std::numeric_limits<double>::infinity();
    m_boxes.assign(2 * m_leaves, Box{{far, far}, {-far, -far}, 0});
    m_order.resize(count);
    std::iota(m_order.begin(), m_order.end(), Corner(0));
    sortSubtree(1, 0, m_leaves * kLeafSize);
    m_leafOf.resize(count);
    for (std::size_t slot = 0; slot < count; ++slot)
        m_leafOf[m_order[slot]] = m_leaves + slot / kLeafSize;
}

// Splits slots `first` to `last` of the order in halves at the longer side of their bounds. Slots at or beyond the
// number of corners are empty.
void EarClipping::sortSubtree(std::size_t node, std::size_t first, std::size_t last)
{
    const std::size_t end = std::min(last, m_order.size()), middle = (first + last) / 2;
    if (first >= end) return;
    Box& box = m_boxes[node];
    for (std::size_t slot = first; slot < end; ++slot)
        for (int axis = 0; axis < 2; ++axis)
        {
            box.m_low[axis] = std::min(box.m_low[axis], m_points[m_order[slot]][axis]);
            box.m_high[axis] = std::max(box.m_high[axis], m_points[m_order[slot]][axis]);
        }
    if (node >= m_leaves) return;
    const int axis = box.m_high[0] - box.m_low[0] < box.m_high[1] - box.m_low[1];
    if (middle < end)
        std::nth_element(&m_order[first], &m_order[middle], m_order.data() + end,
                         [this, axis](Corner a, Corner b) { return m_points[a][axis] < m_points[b][axis]; });
    sortSubtree(2 * node, first, middle);
    sortSubtree(2 * node + 1, middle, last);
}

// Ears that waited for a corner that blocks no longer are candidates again.
void EarClipping::setBlocker(Corner corner, bool blocks)
{
    if (m_isBlocker[corner] == static_cast<char>(blocks)) return;
    m_isBlocker[corner] = blocks;
    for (std::size_t box = m_leafOf[corner]; box > 0; box /= 2)
        m_boxes[box].m_blockers += blocks ? 1u : ~0u;
    if (blocks) return;
    std::vector<Corner> waiting;
    waiting.swap(m_waiting[corner]);
    for (const Corner ear : waiting)
        push(ear);
}

void EarClipping::update(Corner corner)
{
    setBlocker(corner, !turnsLeft(corner));
    push(corner);
}

void EarClipping::push(Corner corner)
{
    if (m_isRemoved[corner] || m_isQueued[corner] || m_isBlocker[corner]) return;
    m_isQueued[corner] = 1;
    m_queue.push_back(corner);
}

bool EarClipping::popCandidate(Corner& corner)
{
    while (!m_queue.empty())
    {
        corner = m_queue.front();
        m_queue.pop_front();
        m_isQueued[corner] = 0;
        if (!m_isRemoved[corner] && !m_isBlocker[corner]) return true;
    }
    return false;
}

EarClipping::Corner EarClipping::pickAny()
{
    Corner corner = m_head;
    for (int i = 0; i < kTries && !turnsLeft(corner); ++i)
        corner = m_next[corner];
    return corner;
}

void EarClipping::clip(Corner corner, std::vector<std::int32_t>& triangles)
{
    const Corner before = m_previous[corner], after = m_next[corner];
    for (const Corner each : {before, corner, after})
        triangles.push_back(static_cast<std::int32_t>(each));
    m_isRemoved[corner] = 1;
    m_next[before] = after;
    m_previous[after] = before;
    m_head = after;
    setBlocker(corner, false);
    update(before);
    update(after);
}

bool EarClipping::turnsLeft(Corner corner) const
{
    return area(m_points[m_previous[corner]], m_points[corner], m_points[m_next[corner]]) > 0;
}

EarClipping::Corner EarClipping::findBlocker(Corner corner)
{
    const Corner before = m_previous[corner], after = m_next[corner];
    const Point2 ear[3] = {m_points[before], m_points[corner], m_points[after]};
    std::size_t stack[64];
    std::size_t depth = 0;
    stack[depth++] = 1;
    while (depth > 0)
    {
        const std::size_t box = stack[--depth];
        ++m_visits;
        if (m_boxes[box].m_blockers == 0 || isOutside(m_boxes[box], ear)) continue;
        if (box < m_leaves)
        {
            stack[depth++] = 2 * box;
            stack[depth++] = 2 * box + 1;
            continue;
        }
        const std::size_t first = (box - m_leaves) * kLeafSize, last = std::min(first + kLeafSize, m_points.size());
        for (std::size_t slot = first; slot < last; ++slot)
        {
            const Corner other = m_order[slot];
            if (m_isBlocker[other] && other != before && other != after && blocks(other, ear)) return other;
        }
    }
    return kNone;
}

// Returns true if one of the ear's edges, or its bounds, separates it from the box.
bool EarClipping::isOutside(const Box& box, const Point2* ear) const
{
    for (int axis = 0; axis < 2; ++axis)
    {
        const auto [low, high] = std::minmax({ear[0][axis], ear[1][axis], ear[2][axis]});
        if (box.m_high[axis] < low || box.m_low[axis] > high) return true;
    }
    for (int edge = 0; edge < 3; ++edge)
    {
        const Point2 &a = ear[edge], &b = ear[(edge + 1) % 3];
        // The corner is the box's farthest to the left of the edge.
        const Point2 corner = {b[1] - a[1] > 0 ? box.m_low[0] : box.m_high[0],
                               b[0] - a[0] > 0 ? box.m_high[1] : box.m_low[1]};
        if (area(a, b, corner) < 0) return true;
    }
    return false;
}

// Corners at the place of one of the ear's do not block it: outlines with holes pass some places twice.
bool EarClipping::blocks(Corner corner, const Point2* ear) const
{
    const Point2& p = m_points[corner];
    if (p == ear[0] || p == ear[1] || p == ear[2]) return false;
    return area(ear[0], ear[1], p) >= 0 && area(ear[1], ear[2], p) >= 0 && area(ear[2], ear[0], p) >= 0;
}
}  // namespace drape
