// Every traversal of trees over the same two sides, on a device and on the host.
//
// Candidates come back sorted. The device's buffers have canaries, which are looked at after each run.
#pragma once

#include "study/step/tree_step.h"
#include "tests/support/device_side.h"

namespace drape::test
{
const std::vector<Traversal>& allTraversals();
const char* traversalName(Traversal traversal);

// Two refitted sides, the thickness of their pairs, and their trees.
struct Sides
{
    Side m_cloth, m_obstacle;
    std::vector<float> m_thickness;
    Tree m_clothTree, m_obstacleTree;
};

// Builds both trees from the positions at the step's start. Volumes are to be refitted.
void plantTrees(Sides& sides, const TreeMethods& methods);

// Refits both, with trees by the default methods where there are none; a cloth's volumes reach as far as its largest
// thickness.
void refitSides(Sides& sides);

// bruteForceCandidates() of both.
std::vector<Candidate> bruteForce(const Sides& sides);

// A traversal that lives for several runs, as in a pipeline.
class DeviceRun
{
public:
    // counting: built with the tests' counter.
    DeviceRun(Device& device, Traversal traversal, bool counting = false);
    DeviceRun(Device& device, std::unique_ptr<DeviceTraversal> traversal) : m_device(device)
    {
        m_traversal = std::move(traversal);
    }

    // New topology, and its volumes.
    void setTopology(Sides& sides);
    // New volumes.
    void upload(Sides& sides);

    // Returns the candidates that fit. Grows the buffers that the traversal itself needs.
    std::vector<Candidate> run(std::size_t capacity, std::size_t limit = kMostPairs);
    // Returns the counters of the last run. m_candidates is the demand.
    const TraversalCounters& counters() const { return m_counters; }
    // Runs again because the traversal had to grow, since the start.
    std::size_t retries() const { return m_retries; }

private:
    Device& m_device;
    std::unique_ptr<DeviceTraversal> m_traversal;
    DeviceSide m_cloth, m_obstacle;
    Buffer<BvhNode> m_clothNodes, m_obstacleNodes;
    Buffer<cl_uint> m_clothOrder, m_obstacleOrder;
    Buffer<float> m_thickness;
    std::size_t m_obstacleMeshes = 0;
    TraversalCounters m_counters = {};
    bool m_empty = true;
    std::size_t m_retries = 0;
};

class HostRun
{
public:
    explicit HostRun(Traversal traversal) : m_traversal(traversal) {}

    void setTopology(const Sides& sides);
    void upload(const Sides&) {}
    std::vector<Candidate> run(const Sides& sides);
    // Returns whether the candidates are no more than the limit.
    bool isWithin(const Sides& sides, std::size_t limit);
    std::size_t volumeTests() const { return m_traversal.volumeTests(); }

private:
    bool find(const Sides& sides, std::vector<Candidate>& candidates, std::size_t limit);

    HostTraversal m_traversal;
};
}  // namespace drape::test
