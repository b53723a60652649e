#include "leaf_pair_count.h"

#include <algorithm>
#include <utility>

#include "bullet_plugin/core/queries/leaf_crowd.h"

namespace drape
{
namespace
{
using NodePair = std::pair<std::uint32_t, std::uint32_t>;

std::uint64_t pairsAmong(std::uint64_t count)
{
    return count < 2 ? 0 : count * (count - 1) / 2;
}

std::vector<LeafCrowd> crowdsOf(const HostTree& tree)
{
    std::vector<LeafCrowd> crowds(tree.m_nodes.size());
    // Children lie before their parents (see bvh_layout.h).
    for (std::uint32_t index = 0; index < crowds.size(); ++index)
    {
        const BvhNode& node = tree.m_nodes[index];
        if (node.m_count == 0) crowds[index] = crowdOfLeaf(node, 0);
        for (std::uint32_t child = node.m_first; child < node.m_first + node.m_count; ++child)
            joinCrowd(crowds[index], crowds[child]);
    }
    return crowds;
}

class PairCounter
{
public:
    PairCounter(const HostTree& a, const HostTree& b) : m_a(a), m_b(b), m_crowdsA(crowdsOf(a)), m_crowdsB(crowdsOf(b))
    {
    }

    // Counts overlapping pairs of all leaves of a with all leaves of b.
    std::uint64_t countBetween()
    {
        m_stack = {{m_a.m_layout.root(), m_b.m_layout.root()}};
        return run([&](const NodePair& pair) { return between(pair); });
    }

    // Counts overlapping pairs among the leaves of a, b being the same tree. A node paired with itself stands for its
    // leaves' pairs.
    std::uint64_t countWithin()
    {
        m_stack = {{m_a.m_layout.root(), m_a.m_layout.root()}};
        return run([&](const NodePair& pair)
                   { return pair.first == pair.second ? within(pair.first) : between(pair); });
    }

private:
    template <typename Count>
    std::uint64_t run(Count count)
    {
        std::uint64_t sum = 0;
        while (!m_stack.empty())
        {
            const NodePair pair = m_stack.back();
            m_stack.pop_back();
            sum += count(pair);
        }
        return sum;
    }

    // Returns the pairs that count at once; puts the others on the stack.
    std::uint64_t between(const NodePair& pair)
    {
        const BvhNode &a = m_a.m_nodes[pair.first], &b = m_b.m_nodes[pair.second];
        if (!nodesOverlap(&a, &b)) return 0;
        const LeafCrowd &crowdA = m_crowdsA[pair.first], &crowdB = m_crowdsB[pair.second];
        if (allOverlap(crowdA, crowdB)) return crowdA.m_leaves * crowdB.m_leaves;
        const bool openA = opensFirst(&a, &b);
        const BvhNode& opened = openA ? a : b;
        for (std::uint32_t child = opened.m_first; child < opened.m_first + opened.m_count; ++child)
            m_stack.push_back(openA ? NodePair(child, pair.second) : NodePair(pair.first, child));
        return 0;
    }

    std::uint64_t within(std::uint32_t index)
    {
        const LeafCrowd& crowd = m_crowdsA[index];
        if (allOverlap(crowd, crowd)) return pairsAmong(crowd.m_leaves);
        const BvhNode& node = m_a.m_nodes[index];
        for (std::uint32_t first = node.m_first; first < node.m_first + node.m_count; ++first)
            for (std::uint32_t second = first; second < node.m_first + node.m_count; ++second)
                m_stack.emplace_back(first, second);
        return 0;
    }

    const HostTree &m_a, &m_b;
    std::vector<LeafCrowd> m_crowdsA, m_crowdsB;
    std::vector<NodePair> m_stack;
};

// Pairs of overlapping leaves among some.
std::uint64_t overlapsAmong(const HostTree& tree, const NodePair* leaves, std::size_t count)
{
    LeafCrowd crowd;
    for (std::size_t i = 0; i < count; ++i)
        joinCrowd(crowd, crowdOfLeaf(tree.m_nodes[leaves[i].second], 0));
    if (allOverlap(crowd, crowd)) return pairsAmong(count);
    // Around a vertex that is not finite.
    std::uint64_t overlaps = 0;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i + 1; j < count; ++j)
            overlaps += std::uint64_t(nodesOverlap(&tree.m_nodes[leaves[i].second], &tree.m_nodes[leaves[j].second]));
    return overlaps;
}

// Counts, over all features of one kind, the pairs of overlapping leaves whose triangles share the feature.
std::uint64_t sharingPairs(const HostTree& tree, DRAPE_UINT (Triangle::*features)[3])
{
    std::vector<NodePair> users;  // feature and leaf
    for (std::uint32_t leaf = 0; leaf < tree.m_layout.leafCount(); ++leaf)
        for (int i = 0; i < 3; ++i)
            users.emplace_back((tree.m_triangles[tree.m_order[leaf]].*features)[i], leaf);
    std::sort(users.begin(), users.end());
    std::uint64_t sum = 0;
    for (std::size_t first = 0, end; first < users.size(); first = end)
    {
        for (end = first; end < users.size() && users[end].first == users[first].first;)
            ++end;
        sum += overlapsAmong(tree, &users[first], end - first);
    }
    return sum;
}
}  // namespace

std::uint64_t countLeafPairs(const HostTree& a, const HostTree& b, std::uint32_t kind)
{
    if (a.m_layout.leafCount() == 0 || b.m_layout.leafCount() == 0) return 0;
    PairCounter counter(a, b);
    if (kind == DRAPE_WALK_OTHER) return counter.countBetween();
    std::uint64_t count = counter.countWithin();
    // A pair that shares an edge shares two vertices; no two triangles of a topology share three.
    if (kind == DRAPE_WALK_SELF_APART)
        count -= sharingPairs(a, &Triangle::m_vertices) - sharingPairs(a, &Triangle::m_edges);
    return count;
}

std::uint64_t leafPairsBeyond(const HostTree& a, const HostTree& b, std::uint32_t kind, std::uint64_t limit)
{
    const std::uint64_t leavesA = a.m_layout.leafCount(), leavesB = b.m_layout.leafCount();
    const std::uint64_t most = kind == DRAPE_WALK_OTHER ? leavesA * leavesB : pairsAmong(leavesA);
    if (most <= limit) return 0;
    const std::uint64_t count = countLeafPairs(a, b, kind);
    return count > limit ? count : 0;
}
}  // namespace drape
