#include "pair_decision.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "bullet_plugin/core/exact/triangles.h"
#include "kernels/lib/queries/triangle_pair.h"

namespace drape
{
namespace
{
ExactTriangle triangleOf(const QueryMesh& mesh, std::uint32_t triangle)
{
    float corners[9];
    for (int i = 0; i < 9; ++i)
        corners[i] = mesh.m_start[3 * mesh.m_topology.m_triangles[triangle].m_vertices[i / 3] + i % 3];
    return exactTriangle(corners);
}

void sortPairs(std::vector<NearTriangles>& pairs)
{
    std::sort(pairs.begin(), pairs.end(),
              [](const NearTriangles& a, const NearTriangles& b)
              { return std::tie(a.m_a, a.m_b) < std::tie(b.m_a, b.m_b); });
}
}  // namespace

void PairDecision::take(const PairAnswer& answer)
{
    const ExactTriangle first = triangleOf(m_a, answer.m_a), second = triangleOf(m_b, answer.m_b);
    NearTriangles pair = {m_a.m_topology.m_sourceTriangle[answer.m_a], m_b.m_topology.m_sourceTriangle[answer.m_b]};
    if (&m_a == &m_b && pair.m_a > pair.m_b) std::swap(pair.m_a, pair.m_b);
    const bool meet = (answer.m_bits & DRAPE_PAIR_MEETS) && trianglesMeet(first, second);
    if (meet || squaredDistance(first, second) <= m_radius * m_radius) list(pair, meet);
}

void PairDecision::list(const NearTriangles& pair, bool meet)
{
    ++m_found.m_withinCount;
    if (meet) ++m_found.m_intersectingCount;
    if (m_found.m_withinCount <= m_limit)
    {
        m_found.m_within.push_back(pair);
        if (meet) m_found.m_intersecting.push_back(pair);
        return;
    }
    m_found.m_limits |= kQueryAnswerLimit;
    std::vector<NearTriangles>().swap(m_found.m_within);
    std::vector<NearTriangles>().swap(m_found.m_intersecting);
}

void PairDecision::finish()
{
    sortPairs(m_found.m_within);
    sortPairs(m_found.m_intersecting);
}
}  // namespace drape
