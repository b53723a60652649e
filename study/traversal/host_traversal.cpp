#include "study/traversal/host_traversal.h"

#include <algorithm>
#include <deque>

#include "study/kernels/lib/traversal.h"
#include "study/traversal/grid_traversal.h"

namespace drape
{
namespace
{
// Equals the device's, see front_traversal.cpp.
constexpr std::uint32_t kRaiseInterval = 8;
// A front of more pairs is not kept, so that a crowd of triangles does not take memory twice: the next step begins at
// the roots.
constexpr std::size_t kMostFront = 1 << 22;

template <typename Visit>
void forEachCell(const BvhNode& node, GridFrame frame, Visit visit)
{
    GridRange range;
    if (node.m_count > 0 || !gridRange(&range, &node, frame)) return;
    for (std::uint32_t z = range.m_first[2]; z <= range.m_last[2]; ++z)
        for (std::uint32_t y = range.m_first[1]; y <= range.m_last[1]; ++y)
            for (std::uint32_t x = range.m_first[0]; x <= range.m_last[0]; ++x)
                visit(gridKey(x, y, z));
}
}  // namespace

struct HostTraversal::Step
{
    const TreeSide& m_cloth;
    const TreeSide& m_obstacle;
    const std::vector<float>& m_thickness;
    std::size_t m_obstacleMeshes;
    std::vector<Candidate>& m_candidates;
    std::size_t m_limit;
    bool& m_over;  // one more than the limit was found

    NodePair roots() const { return {m_cloth.m_tree.m_root, m_obstacle.m_tree.m_root}; }
    // Then there is no need to look further.
    bool overLimit() const { return m_over; }
    const BvhNode& clothNode(NodePair pair) const { return m_cloth.m_tree.m_nodes[pair.m_cloth]; }
    const BvhNode& obstacleNode(NodePair pair) const { return m_obstacle.m_tree.m_nodes[pair.m_obstacle]; }
    bool overlap(NodePair pair) const { return nodesOverlap(&clothNode(pair), &obstacleNode(pair)); }
    bool isLeaves(NodePair pair) const { return clothNode(pair).m_count == 0 && obstacleNode(pair).m_count == 0; }

    void add(Candidate candidate) const
    {
        const std::size_t row = m_cloth.m_triangles[candidate.m_cloth].m_mesh * m_obstacleMeshes;
        const float thickness = m_thickness[row + m_obstacle.m_triangles[candidate.m_obstacle].m_mesh];
        if (thickness < 0.0f) return;
        // Not even one too many is stored: the list would double for it.
        m_over = m_over || m_candidates.size() == m_limit;
        if (!m_over) m_candidates.push_back(candidate);
    }
    void addLeaves(NodePair pair) const
    {
        add({m_cloth.m_tree.m_order[clothNode(pair).m_first], m_obstacle.m_tree.m_order[obstacleNode(pair).m_first]});
    }
    void pushChildren(NodePair pair, bool openCloth, std::vector<NodePair>& stack) const
    {
        const BvhNode& opened = openCloth ? clothNode(pair) : obstacleNode(pair);
        for (std::uint32_t i = 0; i < opened.m_count; ++i)
        {
            const std::uint32_t child = opened.m_first + i;
            stack.push_back(openCloth ? NodePair{child, pair.m_obstacle} : NodePair{pair.m_cloth, child});
        }
    }
};

void HostTraversal::setTopology(const Hierarchy& cloth, const Hierarchy& obstacle)
{
    m_front.clear();
    m_clothLinks = makeLinks(cloth);
    m_obstacleLinks = makeLinks(obstacle);
    if (m_traversal == Traversal::Grid) m_frame = gridFrame(cloth, obstacle);
}

bool HostTraversal::run(const TreeSide& cloth, const TreeSide& obstacle, const std::vector<float>& thickness,
                        std::size_t obstacleMeshes, std::vector<Candidate>& candidates, std::size_t limit)
{
    candidates.clear();
    m_tests = 0;
    if (cloth.m_tree.empty() || obstacle.m_tree.empty()) return true;
    bool over = false;
    const Step step = {cloth, obstacle, thickness, obstacleMeshes, candidates, limit, over};
    if (m_traversal == Traversal::Single)
        runBothOpen(step);
    else if (m_traversal == Traversal::Front)
        runFront(step);
    else if (m_traversal == Traversal::Grid)
        runGrid(step);
    else
        openFrom(step, step.roots(), false);
    if (step.overLimit()) m_front.clear();
    return !step.overLimit();
}

// The thesis's queue: first in, first out, and both nodes of a pair open.
void HostTraversal::runBothOpen(const Step& step)
{
    std::deque<NodePair> queue = {step.roots()};
    for (; !queue.empty() && !step.overLimit(); queue.pop_front())
    {
        const NodePair pair = queue.front();
        const BvhNode &a = step.clothNode(pair), &b = step.obstacleNode(pair);
        ++m_tests;
        if (!step.overlap(pair)) continue;
        if (step.isLeaves(pair))
        {
            step.addLeaves(pair);
            continue;
        }
        const std::uint32_t clothCount = std::max(a.m_count, 1u), obstacleCount = std::max(b.m_count, 1u);
        for (std::uint32_t i = 0; i < clothCount * obstacleCount; ++i)
        {
            queue.push_back({a.m_count > 0 ? a.m_first + i % clothCount : pair.m_cloth,
                             b.m_count > 0 ? b.m_first + i / clothCount : pair.m_obstacle});
        }
    }
}

// Opens by the front's fixed rule; keep: what stops here belongs to the next front.
void HostTraversal::openFrom(const Step& step, NodePair start, bool keep)
{
    m_stack.assign(1, start);
    while (!m_stack.empty() && !step.overLimit())
    {
        const NodePair pair = m_stack.back();
        m_stack.pop_back();
        ++m_tests;
        const bool overlap = step.overlap(pair), leaves = step.isLeaves(pair);
        if (overlap && !leaves)
        {
            const bool openCloth =
                clothOpens(&step.clothNode(pair), &step.obstacleNode(pair), m_clothLinks[pair.m_cloth].m_depth,
                           m_obstacleLinks[pair.m_obstacle].m_depth);
            step.pushChildren(pair, openCloth, m_stack);
            continue;
        }
        if (overlap) step.addLeaves(pair);
        if (keep) keepPair(pair);
    }
}

// One more than are kept stays as a sign of it.
void HostTraversal::keepPair(NodePair pair)
{
    if (m_nextFront.size() <= kMostFront) m_nextFront.push_back(pair);
}

// Does the work of raisePair() in study/kernels/broad_phase_front.cl, up to the roots.
bool HostTraversal::raise(const Step& step, NodePair& pair)
{
    while (m_clothLinks[pair.m_cloth].m_depth + m_obstacleLinks[pair.m_obstacle].m_depth > 0)
    {
        const NodePair parent = parentPair(pair, m_clothLinks.data(), m_obstacleLinks.data());
        ++m_tests;
        if (step.overlap(parent)) return true;
        if (!isFirstChild(pair, parent, step.m_cloth.m_tree.m_nodes.data(), step.m_obstacle.m_tree.m_nodes.data()))
            return false;
        pair = parent;
    }
    return true;
}

void HostTraversal::runFront(const Step& step)
{
    if (m_front.empty()) m_front.push_back(step.roots());
    m_nextFront.clear();
    const bool climb = m_step++ % kRaiseInterval == 0;
    for (NodePair pair : m_front)
    {
        if (!climb || step.overlap(pair))
        {
            openFrom(step, pair, true);
            continue;
        }
        ++m_tests;
        if (raise(step, pair)) keepPair(pair);
    }
    m_front.swap(m_nextFront);
    if (m_front.size() > kMostFront) m_front.clear();
}

// Does the work of study/kernels/grid.cl.
void HostTraversal::runGrid(const Step& step)
{
    const std::vector<BvhNode>&cloths = step.m_cloth.m_tree.m_nodes, &obstacles = step.m_obstacle.m_tree.m_nodes;
    m_entries.clear();
    for (std::uint32_t place = 0; place < obstacles.size(); ++place)
        forEachCell(obstacles[place], m_frame, [&](std::uint32_t key) { m_entries.emplace_back(key, place); });
    std::sort(m_entries.begin(), m_entries.end());
    std::vector<std::uint32_t> starts(DRAPE_GRID_CELLS + 1, 0);
    for (const auto& entry : m_entries)
        ++starts[entry.first + 1];
    for (std::size_t cell = 0; cell < DRAPE_GRID_CELLS; ++cell)
        starts[cell + 1] += starts[cell];
    for (std::uint32_t own = 0; own < cloths.size() && !step.overLimit(); ++own)
    {
        const auto look = [&](std::uint32_t key)
        {
            for (std::uint32_t entry = starts[key]; entry < starts[key + 1]; ++entry)
            {
                const NodePair pair = {own, m_entries[entry].second};
                ++m_tests;
                if (step.overlap(pair) && gridPairKey(&cloths[own], &obstacles[pair.m_obstacle], m_frame) == key)
                    step.addLeaves(pair);
            }
        };
        forEachCell(cloths[own], m_frame, look);
    }
}
}  // namespace drape
