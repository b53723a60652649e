#include "oracle/self_intersections.h"

#include <algorithm>
#include <cmath>

#include "oracle/exact_predicates.h"

namespace drape
{
namespace
{
bool isFinite(const Vector3& p)
{
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}
}  // namespace

SelfIntersections::SelfIntersections(const TriangleMesh& cloths)
    : m_tree(cloths.m_positions.data(), cloths.vertexCount(), cloths.m_triangles.data(), cloths.triangleCount())
{
}

bool SelfIntersections::intersect(std::int32_t first, std::int32_t second) const
{
    const std::int32_t *a = m_tree.indices(first), *b = m_tree.indices(second);
    // The corners in an order in which common vertices come first.
    Vector3 p[3], q[3];
    int common = 0, ownA = 3, ownB = 3;
    bool isCommonB[3] = {};
    for (int i = 0; i < 3; ++i)
    {
        const std::int32_t* const same = std::find(b, b + 3, a[i]);
        p[same != b + 3 ? common : --ownA] = m_tree.vertex(a[i]);
        if (same == b + 3) continue;
        isCommonB[same - b] = true;
        q[common++] = m_tree.vertex(a[i]);
    }
    for (int i = 0; i < 3; ++i)
        if (!isCommonB[i]) q[--ownB] = m_tree.vertex(b[i]);
    for (int i = 0; i < 3; ++i)
        if (!isFinite(p[i]) || !isFinite(q[i])) return false;
    if (common == 0) return trianglesIntersect(p, q);
    // The common part is convex and ends on the side opposite to the common vertex of one of the two.
    if (common == 1) return segmentMeetsTriangle(p[1], p[2], q) || segmentMeetsTriangle(q[1], q[2], p);
    return common == 2 && foldedFlat(p[0], p[1], p[2], q[2]);
}

std::vector<std::pair<std::int32_t, std::int32_t>> SelfIntersections::find(const std::vector<float>& positions)
{
    m_tree.refit(positions.data());
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
    m_tree.visitPairs(m_tree,
                      [&](std::int32_t first, std::int32_t second)
                      {
                          if (first < second && intersect(first, second)) pairs.emplace_back(first, second);
                      });
    return pairs;
}
}  // namespace drape
