// Every Traversal over the same two sides, on a device and on the host.
//
// Candidates come back sorted. The device's buffers have canaries, which are looked at after each run.
#pragma once

#include "tests/support/device_side.h"

namespace drape::test
{
// All but Auto.
const std::vector<Traversal>& allTraversals();
const char* traversalName(Traversal traversal);

// Two refitted sides and the thickness of their pairs.
struct Sides
{
    Side m_cloth, m_obstacle;
    std::vector<float> m_thickness;
};

// Refits both; a cloth's volumes reach as far as its largest thickness.
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
        m_stage.use(std::move(traversal));
    }

    // New topology, and its volumes.
    void setTopology(Sides& sides);
    // New volumes.
    void upload(Sides& sides);

    // What fits of the candidates. Grows what the traversal itself needs.
    std::vector<Candidate> run(std::size_t capacity, std::size_t limit = kMostCandidates);
    // Of the last run. m_candidates is the demand.
    const StepCounters& counters() const { return m_counters; }
    // Runs again because the traversal had to grow, since the start.
    std::size_t retries() const { return m_retries; }

private:
    Device& m_device;
    BroadPhaseStage m_stage;
    DeviceSide m_cloth, m_obstacle;
    Buffer<float> m_thickness;
    std::size_t m_obstacleMeshes = 0;
    StepCounters m_counters = {};
    std::size_t m_retries = 0;
};

class HostRun
{
public:
    explicit HostRun(Traversal traversal) : m_traversal(traversal) {}

    void setTopology(const Sides& sides);
    void upload(const Sides& sides);
    std::vector<Candidate> run(const Sides& sides);
    // Whether the candidates are no more than the limit.
    bool isWithin(const Sides& sides, std::size_t limit);
    std::size_t volumeTests() const { return m_traversal.volumeTests(); }

private:
    HostTraversal m_traversal;
};
}  // namespace drape::test
