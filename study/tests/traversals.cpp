#include "study/tests/traversals.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_plugin/core/ordering/canonical_order.h"
#include "study/kernel_programs.h"
#include "study/trees/tree_builder.h"

namespace drape::test
{
namespace
{
Hierarchy treeOf(const Tree& tree)
{
    return {tree.m_nodes, 0, tree.m_order};
}
}  // namespace

const std::vector<Traversal>& allTraversals()
{
    static const std::vector<Traversal> all = {Traversal::Single, Traversal::Full, Traversal::Front, Traversal::Grid};
    return all;
}

const char* traversalName(Traversal traversal)
{
    static const char* const names[] = {"Single", "Full", "Front", "Grid"};
    return names[std::size_t(traversal)];
}

void plantTrees(Sides& sides, const TreeMethods& methods)
{
    const auto plant = [&](const Side& side)
    { return buildTreeOnHost(methods, side.m_pool.triangles(), side.m_start.data(), side.m_pool.meshCount()); };
    sides.m_clothTree = plant(sides.m_cloth);
    sides.m_obstacleTree = plant(sides.m_obstacle);
}

void refitSides(Sides& sides)
{
    if (sides.m_clothTree.m_order.empty() && sides.m_obstacleTree.m_order.empty()) plantTrees(sides, {});
    const std::size_t obstacles = sides.m_obstacle.m_pool.meshCount();
    std::vector<float> radius(sides.m_cloth.m_pool.meshCount(), -1.0f);
    const std::vector<float> noRadius(obstacles, 0.0f);
    for (std::size_t i = 0; i < sides.m_thickness.size(); ++i)
        radius[i / obstacles] = std::max(radius[i / obstacles], sides.m_thickness[i]);
    refitSide(sides.m_cloth, radius);
    refitSide(sides.m_obstacle, noRadius);
    std::size_t ignored = 0;
    const auto refit = [&](Tree& tree, const Side& side, const std::vector<float>& by)
    { refitTreeOnHost(tree, side.m_pool.triangles(), side.m_start.data(), side.m_end.data(), by, ignored); };
    refit(sides.m_clothTree, sides.m_cloth, radius);
    refit(sides.m_obstacleTree, sides.m_obstacle, noRadius);
}

std::vector<Candidate> bruteForce(const Sides& sides)
{
    return bruteForceCandidates(sides.m_cloth, sides.m_obstacle, sides.m_thickness);
}

DeviceRun::DeviceRun(Device& device, Traversal traversal, bool counting) : m_device(device)
{
    m_traversal =
        makeTraversal(device, traversal, studyPrograms(device, "", counting ? "#define DRAPE_COUNT_VISITS\n" : ""));
}

void DeviceRun::setTopology(Sides& sides)
{
    const Hierarchy cloth = treeOf(sides.m_clothTree), obstacle = treeOf(sides.m_obstacleTree);
    m_empty = cloth.empty() || obstacle.empty();
    if (!m_empty) m_traversal->setTopology(m_device, cloth, obstacle);
    upload(sides);
}

void DeviceRun::upload(Sides& sides)
{
    m_cloth.upload(m_device, sides.m_cloth);
    m_obstacle.upload(m_device, sides.m_obstacle);
    guardCopy(m_device, m_clothNodes, sides.m_clothTree.m_nodes);
    guardCopy(m_device, m_clothOrder, sides.m_clothTree.m_order);
    guardCopy(m_device, m_obstacleNodes, sides.m_obstacleTree.m_nodes);
    guardCopy(m_device, m_obstacleOrder, sides.m_obstacleTree.m_order);
    guardCopy(m_device, m_thickness, sides.m_thickness);
    m_obstacleMeshes = sides.m_obstacle.m_pool.meshCount();
}

std::vector<Candidate> DeviceRun::run(std::size_t capacity, std::size_t limit)
{
    Buffer<Candidate> candidates;
    guard(m_device, candidates, capacity);
    Buffer<TraversalCounters> counters;
    bool limitReached = false;
    for (bool again = true; again; m_retries += again)
    {
        guardCopy(m_device, counters, std::vector<TraversalCounters>(1));
        if (!m_empty)
            m_traversal->enqueue(m_device, {{m_clothNodes, m_clothOrder, m_cloth.m_triangles},
                                            {m_obstacleNodes, m_obstacleOrder, m_obstacle.m_triangles},
                                            m_thickness,
                                            m_obstacleMeshes,
                                            candidates,
                                            counters,
                                            limit});
        m_counters = contents(m_device, counters, 1)[0];
        EXPECT_TRUE(intact(m_device, counters));
        again = m_traversal->grow(m_device, m_counters, limitReached) && !limitReached && !m_device.failed();
    }
    if (m_counters.m_candidates <= limit) m_traversal->accept(m_device, m_counters);
    std::vector<Candidate> found =
        contents(m_device, candidates, std::min(std::size_t(m_counters.m_candidates), candidates.capacity()));
    sortCandidates(found);
    EXPECT_FALSE(limitReached);
    EXPECT_TRUE(intact(m_device, candidates) && intact(m_device, m_thickness));
    EXPECT_TRUE(m_cloth.allIntact(m_device) && m_obstacle.allIntact(m_device));
    EXPECT_TRUE(intact(m_device, m_clothNodes) && intact(m_device, m_obstacleNodes));
    EXPECT_FALSE(m_device.failed()) << m_device.error().text();
    return found;
}

void HostRun::setTopology(const Sides& sides)
{
    m_traversal.setTopology(treeOf(sides.m_clothTree), treeOf(sides.m_obstacleTree));
}

bool HostRun::find(const Sides& sides, std::vector<Candidate>& candidates, std::size_t limit)
{
    return m_traversal.run({treeOf(sides.m_clothTree), sides.m_cloth.m_pool.triangles()},
                           {treeOf(sides.m_obstacleTree), sides.m_obstacle.m_pool.triangles()}, sides.m_thickness,
                           sides.m_obstacle.m_pool.meshCount(), candidates, limit);
}

bool HostRun::isWithin(const Sides& sides, std::size_t limit)
{
    std::vector<Candidate> candidates;
    return find(sides, candidates, limit);
}

std::vector<Candidate> HostRun::run(const Sides& sides)
{
    std::vector<Candidate> candidates;
    find(sides, candidates, kMostPairs);
    sortCandidates(candidates);
    return candidates;
}
}  // namespace drape::test
