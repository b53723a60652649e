// Broad phase on the calling thread over trees: the same traversals as on a device, for comparison, for reports of
// intersections, and for counts of pairs of triangles.
#pragma once

#include <vector>

#include "bullet_plugin/core/bvh/bvh_layout.h"
#include "drape/methods.h"
#include "wide_layout.h"

namespace drape
{
// One side as the traversal sees it.
struct BroadPhaseSide
{
    const std::vector<BvhNode>& m_nodes;
    const BvhLayout& m_layout;
    const std::vector<std::uint32_t>& m_order;
    const std::vector<Triangle>& m_triangles;

    Hierarchy hierarchy() const { return {m_nodes, m_layout.root(), m_order}; }
};

class HostTraversal
{
public:
    // Groups is Pairs with the fixed rule of the front; WideLeaves and WideGroups are the same.
    explicit HostTraversal(Traversal traversal = Traversal::Auto);
    // What Auto is here.
    static Traversal resolve(Traversal traversal)
    {
        return traversal == Traversal::Auto ? Traversal::Front : traversal;
    }

    // New links in the obstacles' hierarchy, but for those of the first so many blocks of a joined layout; or new
    // volumes.
    void setObstacles(const BroadPhaseSide& obstacle, std::size_t keptBlocks = 0);
    void obstaclesRefitted(const BroadPhaseSide& obstacle);
    // New links in either hierarchy, of the obstacles' after setObstacles(): drops the front.
    void setTopology(const BroadPhaseSide& cloth);

    // thickness: m, cloth slots × obstacle slots, negative where the pair is not tested. False when there are more than
    // limit candidates; the list is incomplete then.
    bool run(const BroadPhaseSide& cloth, const BroadPhaseSide& obstacle, const std::vector<float>& thickness,
             std::size_t obstacleMeshes, std::vector<Candidate>& candidates, std::size_t limit = kMostCandidates);

    // Volume tests of the last run.
    std::size_t volumeTests() const { return m_tests; }

private:
    struct Step;
    bool isWide() const { return m_traversal == Traversal::WideLeaves || m_traversal == Traversal::WideGroups; }
    bool walksFront() const { return m_traversal == Traversal::Front || m_traversal == Traversal::Groups; }
    void runPairs(const Step& step);
    void runBothOpen(const Step& step);
    void runFront(const Step& step);
    void runLeaves(const Step& step);
    void runWide(const Step& step);
    void openFrom(const Step& step, NodePair pair, bool keep);
    void keepPair(NodePair pair);
    bool raise(const Step& step, NodePair& pair);

    Traversal m_traversal;
    WideLayout m_wide;
    std::vector<std::uint32_t> m_leaves;  // nodes of the cloth's leaves
    std::vector<BvhLink> m_clothLinks, m_obstacleLinks;
    std::uint32_t m_rootDepth = 0;  // of both
    std::vector<NodePair> m_front, m_nextFront, m_stack;
    std::uint32_t m_step = 0;
    std::size_t m_tests = 0;
};
}  // namespace drape
