// The traversals on the calling thread.
#pragma once

#include <utility>
#include <vector>

#include "study/methods.h"
#include "study/kernels/lib/grid.h"
#include "study/traversal/hierarchy.h"

namespace drape
{
// One side as the traversal sees it.
struct TreeSide
{
    Hierarchy m_tree;
    const std::vector<Triangle>& m_triangles;
};

class HostTraversal
{
public:
    explicit HostTraversal(Traversal traversal) : m_traversal(traversal) {}

    // New links in either tree: drops the front.
    void setTopology(const Hierarchy& cloth, const Hierarchy& obstacle);

    // thickness: m, cloth slots × obstacle slots, negative where the pair is not tested. False when there are more than
    // limit candidates; the list is incomplete then.
    bool run(const TreeSide& cloth, const TreeSide& obstacle, const std::vector<float>& thickness,
             std::size_t obstacleMeshes, std::vector<Candidate>& candidates, std::size_t limit = kMostPairs);

    // Volume tests of the last run.
    std::size_t volumeTests() const { return m_tests; }

private:
    struct Step;
    void runBothOpen(const Step& step);
    void runFront(const Step& step);
    void runGrid(const Step& step);
    void openFrom(const Step& step, NodePair pair, bool keep);
    void keepPair(NodePair pair);
    bool raise(const Step& step, NodePair& pair);

    Traversal m_traversal;
    std::vector<BvhLink> m_clothLinks, m_obstacleLinks;
    GridFrame m_frame = {};
    std::vector<std::pair<std::uint32_t, std::uint32_t>> m_entries;  // cell and obstacle node, sorted
    std::vector<NodePair> m_front, m_nextFront, m_stack;
    std::uint32_t m_step = 0;
    std::size_t m_tests = 0;
};
}  // namespace drape
