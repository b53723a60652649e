#include <algorithm>
#include <cassert>
#include <tuple>

#include "leaf_pair_count.h"

namespace drape
{
std::vector<std::uint32_t> lastLeaves(const std::vector<BvhNode>& nodes, std::uint32_t leafCount)
{
    // Children lie before their parents (see bvh_layout.h).
    std::vector<std::uint32_t> last(nodes.size());
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
    {
        last[i] = i;
        assert((i < leafCount) == (nodes[i].m_count == 0));
        if (i >= leafCount) last[i] = last[nodes[i].m_first + nodes[i].m_count - 1];
    }
    return last;
}

void leafPairsOnHost(const HostTree& a, const HostTree& b, std::uint32_t kind,
                     const std::function<void(const Candidate&)>& visit, const std::function<bool()>& goesOn)
{
    if (b.m_layout.leafCount() == 0) return;
    const std::vector<std::uint32_t> last = lastLeaves(b.m_nodes, b.m_layout.leafCount());
    const WalkSide sideA = {a.m_nodes.data(), a.m_order.data(), a.m_triangles.data()};
    const WalkSide sideB = {b.m_nodes.data(), b.m_order.data(), b.m_triangles.data()};
    for (std::uint32_t leaf = 0; leaf < a.m_layout.leafCount(); ++leaf)
    {
        LeafWalk walk;
        Candidate pair;
        leafWalkStart(&walk, leaf, b.m_layout.root());
        while (leafWalkNext(&walk, &sideA, &sideB, kind, last.data(), &pair))
        {
            if (goesOn && !goesOn()) return;
            visit(pair);
        }
        assert(!walk.m_tooDeep && "binary hierarchies of bvh_layout.h are at most 32 high");
    }
}

void SelfCollisions::leaveUntested()
{
    m_untested = true;
    m_hitCount[0] = m_hitCount[1] = 0;
    std::vector<FeatureHit>().swap(m_hits);
}

void SelfCollisions::add(const FeatureHit& hit, const SelfLimits& limits)
{
    ++m_hitCount[hit.m_kind == DRAPE_EDGES];
    if (hits() <= limits.m_hits)
        m_hits.push_back(hit);
    else
        std::vector<FeatureHit>().swap(m_hits);
}

void selfCollideOnHost(const HostMotion& motion, const CcdSettings& settings, const SelfLimits& limits,
                       SelfCollisions& found)
{
    found = SelfCollisions();
    const std::uint64_t tooMany = leafPairsBeyond(motion.m_tree, motion.m_tree, DRAPE_WALK_SELF, limits.m_candidates);
    if (tooMany > 0)
    {
        found.m_trianglePairs = tooMany;
        return found.leaveUntested();
    }
    std::vector<Dop> volumes(motion.m_vertexCount);
    for (std::uint32_t i = 0; i < motion.m_vertexCount; ++i)
        vertexVolume(&volumes[i], motion.m_start, motion.m_end, i, selfRadius(settings));
    const Triangle* triangles = motion.m_tree.m_triangles.data();
    const auto test = [&](std::uint32_t kind, const FeaturePair& pair)
    {
        FeatureHit hit;
        if (featurePairHit(kind, pair, triangles, motion.m_edges.data(), motion.m_start, motion.m_end, settings, &hit))
            found.add(hit, limits);
    };
    const auto visit = [&](const Candidate& pair)
    {
        FeaturePairs features;
        collectFeaturePairs(&features, triangles, pair, volumes.data());
        ++found.m_trianglePairs;
        found.m_vertexFaceCandidates += features.m_vertexFaceCount;
        found.m_edgeCandidates += features.m_edgesCount;
        if (!found.m_untested && found.m_vertexFaceCandidates + found.m_edgeCandidates > limits.m_candidates)
            found.leaveUntested();
        if (found.m_untested) return;
        for (std::uint32_t i = 0; i < features.m_vertexFaceCount; ++i)
            test(DRAPE_VERTEX_FACE, features.m_vertexFace[i]);
        for (std::uint32_t i = 0; i < features.m_edgesCount; ++i)
            test(DRAPE_EDGES, features.m_edges[i]);
    };
    leafPairsOnHost(motion.m_tree, motion.m_tree, DRAPE_WALK_SELF, visit);
    sortHits(found.m_hits);
}

void sortHits(std::vector<FeatureHit>& hits)
{
    std::sort(hits.begin(), hits.end(),
              [](const FeatureHit& a, const FeatureHit& b)
              { return std::tie(a.m_kind, a.m_a, a.m_b) < std::tie(b.m_kind, b.m_a, b.m_b); });
}
}  // namespace drape
