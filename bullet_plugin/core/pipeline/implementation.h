// The data of a Pipeline: the scene, both back ends, and the current step.
#pragma once

#include <cassert>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bullet_plugin/core/backend_choice/backend_choice.h"
#include "bullet_plugin/core/device/device_choice.h"
#include "bullet_plugin/core/pipeline/pipeline.h"
#include "bullet_plugin/core/backends/device_backend.h"
#include "bullet_plugin/core/backends/host_backend.h"

namespace drape
{
// Slots of a pair's meshes.
struct PairSlots
{
    std::size_t m_cloth;
    std::size_t m_obstacle;
};

// A pair named for the coming step; thickness in m.
struct NamedPair
{
    MeshId m_cloth;
    MeshId m_obstacle;
    float m_thickness;

    bool operator==(const NamedPair& other) const
    {
        return m_cloth == other.m_cloth && m_obstacle == other.m_obstacle && m_thickness == other.m_thickness;
    }
};

// Requires the id of an existing mesh.
inline std::size_t slotOf(const MeshPool& pool, MeshId id)
{
    const std::size_t slot = pool.slot(id);
    assert(slot < pool.meshCount());
    return slot;
}

// Slot of a contact's obstacle.
std::size_t obstacleSlot(const MeshPool& obstacles, const Contact& contact);

struct Pipeline::Implementation
{
    Settings m_settings;
    DeviceReport m_report;
    Error m_error;
    Scene m_scene;  // before the back ends: they may still read its memory while they end
    std::unique_ptr<DeviceBackend> m_deviceBackend;
    std::unique_ptr<HostBackend> m_hostBackend;
    std::vector<NamedPair> m_pairs;
    std::vector<PairSlots> m_pairSlots;  // slots of the named pairs
    std::vector<MeshId> m_selfCloths;    // named for the coming step
    StepPairs m_stepPairs;
    std::vector<bool> m_paired;  // per obstacle slot, with any cloth in the step
    StepResult m_result;
    std::vector<MeshId> m_leftOut;  // cloths, of the last step
    StepStatistics m_statistics;
    BackendChoice m_choice;               // active where cost decides
    std::vector<NamedPair> m_notedPairs;  // pairs that m_choice knows
    std::vector<MeshId> m_notedSelf;
    DeviceInfo m_openClDevice;
    std::size_t m_deviceIndex = 0;  // into deviceInfos()
    std::string m_deviceReason;     // why this device and no other
    MeshId m_nextId = 0;
    std::uint32_t m_clothRevision = 0, m_obstacleRevision = 0;
    std::size_t m_nodesWritten = 0, m_nodesSent = 0;  // counts of the cloths' first nodes, for the coming step
    bool m_neededMore = false;                        // the last step needed more tests than ordinary motion
    bool m_limitsRaised = false;                      // in this step they exceed those of ordinary motion
    bool m_submitted = false;
    bool m_deviceLeft = false;  // it failed

    std::shared_ptr<ThreadTeam> m_threads;

    bool runsOnGpu() { return !m_report.m_onHost && device()->isGpu(); }
    Device* device() { return m_deviceBackend ? &m_deviceBackend->device() : nullptr; }
    PooledMesh makeMesh(const MeshDescription& description);
    // Computes data that depends on an obstacle's positions.
    static void measureObstacle(PooledMesh& mesh);
    void joinScene();
    // Joins cloths from that slot on.
    void joinCloths(std::size_t first);
    void joinRest();
    std::vector<NodeStretch> stretchesOf(const std::vector<MeshId>& cloths);
    // Counts nodes of removed cloths as written, up to node `last`.
    void passVacantNodes(std::size_t last);
    // Forgets nodes declared as written: they are not those of the coming step. Ends their transfers.
    void forgetNodes();
    void joinObstacles(std::size_t first);
    // Computes data that depends on an obstacle's pose.
    void placeMesh(std::size_t slot);
    void findSlots();
    void collectPairs();
    void addOrdinaryTests(std::size_t cloth, std::size_t obstacle);
    void collectMotions();
    void collectSelf();
    // Returns how many obstacles of the pairs the step uses unchanged since the one before; records them all.
    std::size_t countKept();
    // Records the obstacles' current state as used by a step.
    void takeObstacles();
    // Makes a device ready for cloths that collide with themselves.
    void prepareSelf();
    // Returns false, with error filled, if the chosen device cannot be opened or its kernels cannot be built; keeps
    // nothing of it then.
    bool openDevice(Error& error);
    // Continues on the host for good after the device's failure.
    void leaveDevice();
    void goOnWithoutDevice(const Error& error);
    // Returns whether cost decides between the host and the chosen device.
    bool costDecides(const DeviceChoice& choice) const;
    // Reads the crossover from the cache, or measures it.
    double findCrossover(Pipeline& pipeline);
    bool beginChoice(Pipeline& pipeline, Error& error);
    // Selects the back end of the coming steps by the scene's work, and updates the report's reason.
    void useChosen();
    // Processes the pairs named for the coming step, if they differ from those of the last one.
    void chooseBackend();
    // Returns whether the host may run the steps of all current meshes. If cost decides, assumes pairs of a thickness
    // near zero, which make the least work.
    bool mayStayOnHost() const;
    void runOnHost();
    // Runs the step of the remaining pairs on the current back end.
    void enqueue();
    void complete();
    // Removes contacts on the back of one-sided obstacles.
    void dropBackContacts();
    // Removes a cloth from the step. candidates: the cloth's, as far as they were counted.
    void leaveOut(std::size_t slot, std::uint64_t candidates);
    // Removes cloths from the step until the rest is within the settings' limits.
    void leaveOutCloths();
    // Handles a step over the limits of StepPairs: removes cloths that need more than their allowance, and gives the
    // others theirs.
    void leaveOutStretched(const Allowance& allowance);
    // Raises every cloth's limits to its allowance, where that is more, before a step on the host that is likely to
    // exceed ordinary motion, like the one before.
    void expectMore(const Allowance& allowance);
    TestLimits allowed(std::size_t slot, float share) const;
    bool needsMore(std::size_t slot, const std::vector<std::size_t>& taking, TestLimits limits);
};
}  // namespace drape
