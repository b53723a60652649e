#include "candidate_count.h"

#include "leaf_crowd.h"

namespace drape
{
namespace
{
std::vector<LeafCrowd> crowdsOf(const BroadPhaseSide& side)
{
    std::vector<LeafCrowd> crowds(side.m_layout.nodeCount());
    // Nodes lie by height, children before their parents.
    for (std::uint32_t index = 0; index < side.m_layout.nodeCount(); ++index)
    {
        const BvhNode& node = side.m_nodes[index];
        if (node.m_count == 0) crowds[index] = crowdOfLeaf(node, side.m_triangles[side.m_order[node.m_first]].m_mesh);
        for (std::uint32_t child = node.m_first; child < node.m_first + node.m_count; ++child)
            joinCrowd(crowds[index], crowds[child]);
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
    const std::vector<LeafCrowd> clothCrowds = crowdsOf(cloth), obstacleCrowds = crowdsOf(obstacle);
    std::vector<Candidate> stack = {{cloth.m_layout.root(), obstacle.m_layout.root()}};  // of nodes
    while (!stack.empty())
    {
        const Candidate pair = stack.back();
        stack.pop_back();
        const BvhNode &a = cloth.m_nodes[pair.m_cloth], &b = obstacle.m_nodes[pair.m_obstacle];
        if (!nodesOverlap(&a, &b)) continue;
        const LeafCrowd &crowdA = clothCrowds[pair.m_cloth], &crowdB = obstacleCrowds[pair.m_obstacle];
        if (crowdA.m_mesh != kMixedMeshes && crowdB.m_mesh != kMixedMeshes)
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
