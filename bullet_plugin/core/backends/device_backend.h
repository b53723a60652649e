// The step on an OpenCL device: one submission, one wait. A buffer that turns out too small grows and the step runs
// again.
#pragma once

#include <memory>

#include "bullet_plugin/core/broad_phase/patch_cull.h"
#include "bullet_plugin/core/ordering/ordering.h"
#include "bullet_plugin/core/device/program_set.h"
#include "bullet_plugin/core/cloth_cloth/self_contacts.h"
#include "drape/settings.h"
#include "bullet_plugin/core/narrow_phase/narrow_phase.h"
#include "placed_obstacles.h"
#include "step_pairs.h"
#include "step_result.h"

namespace drape
{
class DeviceBackend
{
public:
    // Builds the kernels and runs each once. On failure device().failed() is true and the error holds the log.
    DeviceBackend(std::unique_ptr<Device> device, const Settings& settings);
    ~DeviceBackend();

    Device& device() { return *m_device; }
    bool fromCache() const { return m_programs.fromCache(); }

    // Builds the kernels of cloths that collide with themselves, at the first call.
    void prepareSelf();

    // Uploads added meshes and moved obstacles to the device, and waits.
    void prepare(const Scene& scene);
    // Releases memory of lists that only earlier steps with more contacts needed. Waits.
    void giveBackRoom();
    // Begins the upload of the cloths' nodes, start and end, before the step is submitted. Returns false if the device
    // does not know the cloths yet.
    bool sendNodes(const Scene& scene, std::size_t first, std::size_t count);
    // Returns after enqueueing. The scene and the pairs must stay unchanged until finish(). sent: number of the cloths'
    // first nodes that are uploaded already.
    void submit(const Scene& scene, const StepPairs& pairs, std::size_t sent = 0);
    // Waits. Returns false if the device failed or has no room for the step (then limitReached()). The result says
    // whether the step exceeded the settings' limits; if not, its counts are written to the statistics. Retries are
    // added.
    bool finish(const Scene& scene, const StepPairs& pairs, StepResult& result, StepStatistics& statistics);
    bool limitReached() const { return m_limitReached; }

private:
    // One side's data on the device.
    struct Side
    {
        explicit Side(const std::string& side)
            : m_order(side + " order"), m_triangles(side + " triangles"), m_radius(side + " meshes")
        {
        }
        Buffer<cl_uint> m_order;
        Buffer<Triangle> m_triangles;
        Buffer<float> m_radius;
        std::uint32_t m_revision = 0;
    };

    // Makes room for the lists of a first step.
    void reserveFirst();
    void warmUp(float selfThickness = 0.0f);
    // Uploads the next scene from its first mesh on.
    void forgetScene();
    void uploadSide(const MeshPool& pool, Side& side);
    void updateTopology(const Scene& scene);
    void updateCloths(const Scene& scene);
    // Returns the number of floats of the cloths' nodes at a step's start; there are as many at its end.
    void reserveNodes(std::size_t room);
    void clusterCloths(const MeshPool& cloths, std::size_t firstSlot);
    // Uploads and places the obstacles from slot `fresh` on, and earlier ones whose positions or poses changed, and
    // renews dependent data.
    void updateObstacles(const Scene& scene, std::size_t fresh);
    void writeNodes(const Scene& scene, std::size_t first, std::size_t count);
    void uploadStep(const Scene& scene, const StepPairs& pairs, std::size_t sent);
    void enqueueStep(const Scene& scene, const StepPairs& pairs);
    Buffer<StepCounters>& counters() { return m_counters[m_turn]; }
    void enqueueBroad(const Scene& scene, const StepPairs& pairs);
    void enqueueNarrow(const Scene& scene, const StepPairs& pairs);
    void enqueueOrdering();
    NarrowPhaseBuffers narrowPhaseBuffers(const StepPairs& pairs);
    SelfBuffers selfBuffers(const Scene& scene);
    // Enqueues the transfer of the step's counters and first contacts.
    void readContacts(std::size_t count);
    StepCounters countersRead() const;
    void takeCounts(const StepCounters& counters);
    // Returns whether the last run exceeded the settings' limits; the result says which.
    bool overLimit(const StepPairs& pairs, StepResult& result);
    // Makes room for the last run's demand. Returns whether the step must run again.
    bool grow();
    void readAll(StepResult& result);

    std::unique_ptr<Device> m_device;
    Settings m_settings;
    ProgramSet m_programs;
    bool m_limitReached = false;

    PatchCullStage m_patchCull;
    NarrowPhaseStage m_narrowPhase;
    SelfContactStage m_self;
    OrderingStage m_ordering;
    PlacedObstacles m_placed;

    Side m_cloth{"cloth"}, m_obstacle{"obstacle"};
    Buffer<float> m_clothNodes{"cloth positions"};
    Buffer<float> m_clothStart, m_clothEnd;  // parts of it, laid out like ClothNodes
    Buffer<float> m_thickness{"pairs of meshes"};
    Buffer<Edge> m_clothEdges{"cloth edges"};
    Buffer<ObstacleMotion> m_motions{"obstacle places"};
    std::vector<cl_uint> m_clustered;  // order, like m_cloth.m_order
    std::vector<ObstacleMotion> m_sentMotions;
    // Counters of a step and the next, alternating; see StepTally.
    Buffer<StepCounters> m_counters[2] = {Buffer<StepCounters>("step counters"), Buffer<StepCounters>("step counters")};
    std::size_t m_turn = 0;
    int m_stepsToOrder = 1;
    std::size_t m_testsBefore = SIZE_MAX,
                m_hitsBefore = SIZE_MAX;               // feature tests and unsorted contacts of the step before
    std::unique_ptr<Staging<Contact>> m_contactsRead;  // behind a head as on the device
    std::size_t m_contactsAsked = 0;
    std::vector<float> m_sentThickness, m_sentRadius;
};
}  // namespace drape
