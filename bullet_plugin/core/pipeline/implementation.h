// What a Pipeline holds: the scene, both back ends, and the step under way.
#pragma once

#include <cassert>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backend_choice.h"
#include "bullet_plugin/core/device/device_choice.h"
#include "bullet_plugin/core/pipeline.h"
#include "device_backend.h"
#include "host_backend.h"

namespace drape
{
// Where a pair's meshes are.
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
    float m_tube;

    bool operator==(const NamedPair& other) const
    {
        return m_cloth == other.m_cloth && m_obstacle == other.m_obstacle && m_thickness == other.m_thickness &&
               m_tube == other.m_tube;
    }
};

// The id is of a mesh that is there.
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
    std::vector<PairSlots> m_pairSlots;  // of those
    std::vector<MeshId> m_selfCloths;    // named for the coming step
    StepPairs m_stepPairs;
    std::vector<bool> m_paired;  // per obstacle slot, with any cloth in the step
    StepResult m_result;
    std::vector<MeshId> m_leftOut;  // cloths, of the last step
    StepStatistics m_statistics;
    BackendChoice m_choice;               // active where cost decides
    std::vector<NamedPair> m_notedPairs;  // those that m_choice has taken in last
    std::vector<MeshId> m_notedSelf;
    DeviceInfo m_openClDevice;
    std::size_t m_deviceIndex = 0;  // into deviceInfos()
    std::string m_deviceReason;     // why this device and no other
    MeshId m_nextId = 0;
    std::uint32_t m_clothRevision = 0, m_obstacleRevision = 0;
    std::size_t m_nodesWritten = 0, m_nodesSent = 0;  // the first so many nodes of all cloths, for the coming step
    bool m_neededMore = false;                        // tests than ordinary motion does, the last step
    bool m_limitsRaised = false;                      // above those of ordinary motion, in this step
    bool m_submitted = false;
    bool m_deviceLeft = false;  // it failed

    std::shared_ptr<ThreadTeam> m_threads;

    bool runsOnGpu() { return !m_report.m_onHost && device()->isGpu(); }
    Device* device() { return m_deviceBackend ? &m_deviceBackend->device() : nullptr; }
    PooledMesh makeMesh(const MeshDescription& description);
    // What depends on an obstacle's positions.
    static void measureObstacle(PooledMesh& mesh);
    void joinScene();
    // From that slot on.
    void joinCloths(std::size_t first);
    void joinRest();
    std::vector<NodeStretch> stretchesOf(const std::vector<MeshId>& cloths);
    // Counts nodes of cloths that are gone as written, up to node `last`.
    void passVacantNodes(std::size_t last);
    // Nodes that were told to be written are not those of the coming step. Transfers of them end.
    void forgetNodes();
    void joinObstacles(std::size_t first);
    // What depends on where an obstacle is.
    void placeMesh(std::size_t slot);
    void findSlots();
    void collectPairs();
    void addOrdinaryTests(std::size_t cloth, std::size_t obstacle);
    void collectMotions();
    void collectSelf();
    // How many obstacles of the pairs the step uses as the one before left them; takes them all.
    std::size_t countKept();
    // From here on the obstacles that are there are as a step left them.
    void takeObstacles();
    // Which pairs' contacts may be reduced, and how far their cloths' nodes stay near their ways.
    void collectTubes();
    // Makes a device ready for cloths that collide with themselves.
    void prepareSelf();
    // False, with error filled, when the device that was chosen cannot be opened or its kernels made ready; nothing of
    // it is kept.
    bool openDevice(Error& error);
    // After the device's failure everything goes on, on the host, to the end.
    void leaveDevice();
    void goOnWithoutDevice(const Error& error);
    // Whether cost decides between the host and the device that was chosen.
    bool costDecides(const DeviceChoice& choice) const;
    // From the cache, or measured.
    double findCrossover(Pipeline& pipeline);
    bool beginChoice(Pipeline& pipeline, Error& error);
    // Has the coming steps run where the scene's work says, and the report say why.
    void useChosen();
    // Takes in the pairs that are named for the coming step, where they are not those of the last one.
    void chooseBackend();
    // Whether the host may have the steps of all meshes that are there: where cost decides, by pairs of a thickness
    // near zero, the least that any have.
    bool mayStayOnHost() const;
    void runOnHost();
    // The step of the pairs that are left, on the back end in use.
    void enqueue();
    void complete();
    // Takes out contacts on the back of one-sided obstacles.
    void dropBackContacts();
    // Takes a cloth out of the step; candidates: that it has, as far as they were counted.
    void leaveOut(std::size_t slot, std::uint64_t candidates);
    // Takes cloths out of the step until what is left is within the settings' limits.
    void leaveOutCloths();
    // After a step over the limits of StepPairs: takes out the cloths that need more than they may, and gives the
    // others what they may.
    void leaveOutStretched(const Allowance& allowance);
    // Before a step on the host that is likely to need more than ordinary motion, as the one before did: gives every
    // cloth what it may need, where that is more.
    void expectMore(const Allowance& allowance);
    TestLimits allowed(std::size_t slot, float share) const;
    bool needsMore(std::size_t slot, const std::vector<std::size_t>& taking, TestLimits limits);
};
}  // namespace drape
