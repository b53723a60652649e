// The step on an OpenCL device: one submission, one wait. A buffer that turns out too small grows and the step runs
// again.
#pragma once

#include <memory>

#include "bullet_plugin/core/broad_phase/patch_cull.h"
#include "bullet_plugin/core/cloth_cloth/self_contacts.h"
#include "bullet_plugin/core/device/program_set.h"
#include "bullet_plugin/core/lists/step_pairs.h"
#include "bullet_plugin/core/narrow_phase/narrow_phase.h"
#include "bullet_plugin/core/ordering/ordering.h"
#include "bullet_plugin/core/solver/device/solve_stage.h"
#include "cloth_store.h"
#include "device_cloth_search.h"
#include "drape/settings.h"
#include "obstacle_store.h"
#include "step_result.h"

namespace drape
{
class DeviceBackend
{
public:
    // Builds the kernels and runs each once. On failure device().failed() is true and the error holds the log.
    DeviceBackend(std::shared_ptr<Device> device, const Settings& settings);
    ~DeviceBackend();

    Device& device() { return *m_device; }
    SearchDevice searchDevice() const { return {m_device, m_programs}; }
    bool fromCache() const { return m_programs->fromCache(); }
    double compileMs() const { return m_programs->compileMs(); }

    // Solves cloths; created if the settings may have them solved on this device.
    SolveStage& solveStage() { return m_solve; }

    // Builds the kernels of cloths that collide with themselves, at the first call.
    void prepareSelf();

    // Uploads added meshes and moved obstacles to the device, and waits.
    void prepare(const Scene& scene);
    // Releases memory of lists that only earlier steps with more contacts needed. Waits.
    void giveBackRoom();
    // Begins the upload of the cloths' nodes, start and end, before the step is submitted. Returns false if the device
    // does not know the cloths yet.
    bool sendNodes(const Scene& scene, std::size_t first, std::size_t count);
    // Returns after enqueueing. The scene and the pairs must stay unchanged until finish(). place: where the contacts
    // go. sent: number of the cloths' first nodes that are uploaded already.
    void submit(const Scene& scene, const StepPairs& pairs, ContactPlace place = ContactPlace::Host,
                std::size_t sent = 0);
    // Returns the list of the submitted step if its contacts stay on the device; else an empty one.
    DeviceContacts contactsOnDevice();
    // Waits. Returns false if the device failed or has no room for the step (then limitReached()). The result says
    // whether the step exceeded the settings' limits; if not, its counts are written to the statistics. Retries are
    // added.
    bool finish(const Scene& scene, const StepPairs& pairs, StepResult& result, StepStatistics& statistics);
    bool limitReached() const { return m_limitReached; }
    // Brings contacts that stayed on the device to the host. Waits. Returns false if the device failed.
    bool bringContacts(StepResult& result);

private:
    // Makes room for the lists of a first step.
    void reserveFirst();
    void warmUp(float selfThickness = 0.0f);
    // Uploads the next scene from its first mesh on.
    void forgetScene();
    void updateTopology(const Scene& scene);
    // Makes room for unsorted contacts and for sorted ones.
    void reserveContacts(std::size_t count);
    // Predicts cloths whose nodes stay on the device.
    void predictKept(const Scene& scene, const StepPairs& pairs);
    void uploadStep(const Scene& scene, const StepPairs& pairs, std::size_t sent);
    void enqueueStep(const Scene& scene, const StepPairs& pairs);
    Buffer<StepCounters>& counters() { return m_counters[m_turn]; }
    void enqueueBroad(const Scene& scene, const StepPairs& pairs);
    void enqueueNarrow(const Scene& scene, const StepPairs& pairs);
    void enqueueOrdering();
    SelfContactStage::Input selfInput(const Scene& scene, const StepPairs& pairs) const;
    // Enqueues the transfer of the step's counters and first contacts.
    void readContacts(std::size_t count);
    StepCounters countersRead() const;
    void takeCounts(const StepCounters& counters);
    // Returns whether the last run exceeded the settings' limits; the result says which.
    bool overLimit(const StepPairs& pairs, StepResult& result);
    // Makes room for the last run's demand. Returns whether the step must run again.
    bool grow();
    // Makes the result's list; the first `read` contacts are read already.
    void readAll(StepResult& result, std::size_t read);

    std::shared_ptr<Device> m_device;
    Settings m_settings;
    std::shared_ptr<ProgramSet> m_programs;
    bool m_limitReached = false;

    PatchCullStage m_patchCull;
    NarrowPhaseStage m_narrowPhase;
    SelfContactStage m_self;
    OrderingStage m_ordering;
    SolveStage m_solve;

    ClothStore m_cloths;
    ObstacleStore m_obstacles;
    FeatureTestList m_tests{"step candidates"};
    UnsortedContacts m_unsorted;
    // Counters of a step and the next, alternating; see StepTally.
    Buffer<StepCounters> m_counters[2] = {Buffer<StepCounters>("step counters"), Buffer<StepCounters>("step counters")};
    std::size_t m_turn = 0;
    int m_stepsToOrder = 1;
    // Feature tests and unsorted contacts of the step before.
    std::size_t m_testsBefore = SIZE_MAX, m_contactsBefore = SIZE_MAX;
    std::unique_ptr<Staging<Contact>> m_contactsRead;  // behind a head as on the device
    std::size_t m_contactsAsked = 0;
    ContactPlace m_place = ContactPlace::Host;  // the place of the contacts
};
}  // namespace drape
