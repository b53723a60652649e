#include "candidate_count.h"

#include "kernels/lib/dop.h"

namespace drape
{
namespace
{
constexpr std::uint32_t kMixed = 0xffffffffu;

// What is common to all leaves below a node.
struct Crowd
{
    float m_lowMost[DRAPE_DOP_DIRECTIONS];    // greatest lower bound of a leaf
    float m_highLeast[DRAPE_DOP_DIRECTIONS];  // least upper bound of a leaf
    std::uint64_t m_leaves = 0;
    std::uint32_t m_mesh = kMixed;  // slot of the one mesh that they belong to
};

Crowd crowdOfLeaf(const BvhNode& node, std::uint32_t mesh)
{
    Crowd crowd;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        crowd.m_lowMost[i] = node.m_low[i];
        crowd.m_highLeast[i] = node.m_high[i];
    }
    crowd.m_leaves = 1;
    crowd.m_mesh = mesh;
    return crowd;
}

void join(Crowd& crowd, const Crowd& other)
{
    if (crowd.m_leaves == 0)
    {
        crowd = other;
        return;
    }
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        crowd.m_lowMost[i] = drapeMax(crowd.m_lowMost[i], other.m_lowMost[i]);
        crowd.m_highLeast[i] = drapeMin(crowd.m_highLeast[i], other.m_highLeast[i]);
    }
    crowd.m_leaves += other.m_leaves;
    if (crowd.m_mesh != other.m_mesh) crowd.m_mesh = kMixed;
}

// Every leaf of one overlaps every leaf of the other: in each direction the greatest lower bound of either is no more
// than the least upper bound of the other.
bool allOverlap(const Crowd& a, const Crowd& b)
{
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        if (a.m_lowMost[i] > b.m_highLeast[i] || b.m_lowMost[i] > a.m_highLeast[i]) return false;
    }
    return true;
}

std::vector<Crowd> crowdsOf(const BroadPhaseSide& side)
{
    std::vector<Crowd> crowds(side.m_layout.nodeCount());
    // Nodes lie by height, children before their parents.
    for (std::uint32_t index = 0; index < side.m_layout.nodeCount(); ++index)
    {
        const BvhNode& node = side.m_nodes[index];
        if (node.m_count == 0) crowds[index] = crowdOfLeaf(node, side.m_triangles[side.m_order[node.m_first]].m_mesh);
        for (std::uint32_t child = node.m_first; child < node.m_first + node.m_count; ++child)
            join(crowds[index], crowds[child]);
    }
    return crowds;
}
}  // namespace

std::vector<std::uint64_t> countCandidates(const BroadPhaseSide& cloth, const BroadPhaseSide& obstacle,
                                           const std::vector<float>& thickness, std::size_t clothMeshes,
                                           std::size_t obstacleMeshes)
{
    std::vector<std::uint64_t> counts(clothMeshes, 0);
    if (cloth.m_layout.nodeCount() == 0 || obstacle.m_layout.nodeCount() == 0) return counts;
    const std::vector<Crowd> clothCrowds = crowdsOf(cloth), obstacleCrowds = crowdsOf(obstacle);
    std::vector<Candidate> stack = {{cloth.m_layout.root(), obstacle.m_layout.root()}};  // of nodes
    while (!stack.empty())
    {
        const Candidate pair = stack.back();
        stack.pop_back();
        const BvhNode &a = cloth.m_nodes[pair.m_cloth], &b = obstacle.m_nodes[pair.m_obstacle];
        if (!nodesOverlap(&a, &b)) continue;
        const Crowd &crowdA = clothCrowds[pair.m_cloth], &crowdB = obstacleCrowds[pair.m_obstacle];
        if (crowdA.m_mesh != kMixed && crowdB.m_mesh != kMixed)
        {
            if (thickness[crowdA.m_mesh * obstacleMeshes + crowdB.m_mesh] < 0.0f) continue;
            if (allOverlap(crowdA, crowdB))
            {
                counts[crowdA.m_mesh] += crowdA.m_leaves * crowdB.m_leaves;
                continue;
            }
        }
        const bool openCloth = opensFirst(&a, &b);
        const BvhNode& opened = openCloth ? a : b;
        for (std::uint32_t child = opened.m_first; child < opened.m_first + opened.m_count; ++child)
            stack.push_back(openCloth ? Candidate{child, pair.m_obstacle} : Candidate{pair.m_cloth, child});
    }
    return counts;
}
}  // namespace drape
