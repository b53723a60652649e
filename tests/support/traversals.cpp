#include "tests/support/traversals.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_plugin/core/compaction/canonical_order.h"

namespace drape::test
{
const std::vector<Traversal>& allTraversals()
{
    static const std::vector<Traversal> all = {Traversal::Pairs,     Traversal::Single, Traversal::Groups,
                                               Traversal::Front,     Traversal::Leaves, Traversal::WideLeaves,
                                               Traversal::WideGroups};
    return all;
}

const char* traversalName(Traversal traversal)
{
    static const char* const names[] = {"Auto",  "Pairs",  "Single",     "Groups",
                                        "Front", "Leaves", "WideLeaves", "WideGroups"};
    return names[std::size_t(traversal)];
}

void refitSides(Sides& sides)
{
    const std::size_t obstacles = sides.m_obstacle.m_pool.meshCount();
    std::vector<float> radius(sides.m_cloth.m_pool.meshCount(), -1.0f);
    for (std::size_t i = 0; i < sides.m_thickness.size(); ++i)
        radius[i / obstacles] = std::max(radius[i / obstacles], sides.m_thickness[i]);
    refitSide(sides.m_cloth, radius);
    refitSide(sides.m_obstacle, std::vector<float>(obstacles, 0.0f));
}

std::vector<Candidate> bruteForce(const Sides& sides)
{
    return bruteForceCandidates(sides.m_cloth, sides.m_obstacle, sides.m_thickness);
}

DeviceRun::DeviceRun(Device& device, Traversal traversal, bool counting) : m_device(device)
{
    m_stage.create(device, traversal,
                   [&](const char* name)
                   {
                       ProgramBuild build;
                       return buildProgram(device, name, "", build, counting ? "#define DRAPE_COUNT_VISITS\n" : "");
                   });
}

void DeviceRun::setTopology(Sides& sides)
{
    const Hierarchy cloth = sides.m_cloth.broadPhase().hierarchy();
    const Hierarchy obstacle = sides.m_obstacle.broadPhase().hierarchy();
    m_stage.setObstacles(m_device, obstacle);
    m_stage.setTopology(m_device, cloth, obstacle);
    upload(sides);
}

void DeviceRun::upload(Sides& sides)
{
    m_cloth.upload(m_device, sides.m_cloth);
    m_obstacle.upload(m_device, sides.m_obstacle);
    guardCopy(m_device, m_thickness, sides.m_thickness);
    m_obstacleMeshes = sides.m_obstacle.m_pool.meshCount();
    m_stage.obstaclesRefitted(m_device, m_obstacle.m_nodes);
}

std::vector<Candidate> DeviceRun::run(std::size_t capacity, std::size_t limit)
{
    Buffer<Candidate> candidates;
    guard(m_device, candidates, capacity);
    Buffer<StepCounters> counters;
    bool limitReached = false;
    for (bool again = true; again; m_retries += again)
    {
        clearCounters(m_device, counters);
        m_stage.enqueue(m_device, {{m_cloth.m_nodes, m_cloth.m_order, m_cloth.m_triangles},
                                   {m_obstacle.m_nodes, m_obstacle.m_order, m_obstacle.m_triangles},
                                   m_thickness,
                                   m_obstacleMeshes,
                                   candidates,
                                   counters,
                                   limit});
        m_counters = readCounters(m_device, counters);
        EXPECT_TRUE(intact(m_device, counters));
        again = m_stage.grow(m_device, m_counters, limitReached) && !limitReached && !m_device.failed();
    }
    if (m_counters.m_candidates <= limit) m_stage.accept(m_device, m_counters);
    std::vector<Candidate> found =
        contents(m_device, candidates, std::min(std::size_t(m_counters.m_candidates), candidates.capacity()));
    sortCandidates(found);
    EXPECT_FALSE(limitReached);
    EXPECT_TRUE(intact(m_device, candidates) && intact(m_device, m_thickness));
    EXPECT_TRUE(m_cloth.allIntact(m_device) && m_obstacle.allIntact(m_device));
    EXPECT_FALSE(m_device.failed()) << m_device.error().text();
    return found;
}

void HostRun::setTopology(const Sides& sides)
{
    m_traversal.setObstacles(sides.m_obstacle.broadPhase());
    m_traversal.setTopology(sides.m_cloth.broadPhase());
    upload(sides);
}

void HostRun::upload(const Sides& sides)
{
    m_traversal.obstaclesRefitted(sides.m_obstacle.broadPhase());
}

bool HostRun::isWithin(const Sides& sides, std::size_t limit)
{
    std::vector<Candidate> candidates;
    return m_traversal.run(sides.m_cloth.broadPhase(), sides.m_obstacle.broadPhase(), sides.m_thickness,
                           sides.m_obstacle.m_pool.meshCount(), candidates, limit);
}

std::vector<Candidate> HostRun::run(const Sides& sides)
{
    std::vector<Candidate> candidates;
    m_traversal.run(sides.m_cloth.broadPhase(), sides.m_obstacle.broadPhase(), sides.m_thickness,
                    sides.m_obstacle.m_pool.meshCount(), candidates);
    sortCandidates(candidates);
    return candidates;
}
}  // namespace drape::test
