// A step over trees of triangles: refit of the cloths' tree, a traversal of both trees, the contacts of the pairs.
//
// Job: what a step of the thesis does, on the calling thread or on a device, beside today's step over patches. Input:
// the cloths' nodes at the step's start and end. Output: contacts in canonical order. Guarantee: the contacts of
// Pipeline, bit for bit, and the same pairs of triangles by every traversal. Cost: linear in the cloths' triangles and
// the pairs.
#pragma once

#include <memory>

#include "bullet_plugin/core/ordering/ordering.h"
#include "study/step/pair_stage.h"
#include "study/step/tree_scene.h"
#include "study/traversal/device_traversal.h"
#include "study/traversal/host_traversal.h"
#include "study/trees/tree_refit.h"

namespace drape
{
struct TreeStepResult
{
    std::vector<Contact> m_contacts;
    std::size_t m_candidates = 0;   // pairs of triangles whose volumes overlap
    std::size_t m_volumeTests = 0;  // on a device only where they are counted
    std::size_t m_retries = 0;
    double m_refitMs = 0, m_broadMs = 0, m_narrowMs = 0;  // times of the host
};

class TreeStep
{
public:
    virtual ~TreeStep() = default;
    // start, end: m, x y z per node of all cloths. False where a device failed or cannot hold what the step needs.
    virtual bool run(const float* start, const float* end, TreeStepResult& result) = 0;
};

class HostTreeStep : public TreeStep
{
public:
    // The scene stays.
    HostTreeStep(TreeScene& scene, Traversal traversal);
    bool run(const float* start, const float* end, TreeStepResult& result) override;
    const std::vector<Candidate>& candidates() const { return m_candidates; }

private:
    TreeScene& m_scene;
    HostTraversal m_traversal;
    std::vector<Candidate> m_candidates;
};

class DeviceTreeStep : public TreeStep
{
public:
    // Builds the kernels. Device and scene stay. Errors: in the device.
    DeviceTreeStep(Device& device, const TreeScene& scene, const Methods& methods, const std::string& cacheFolder);
    bool run(const float* start, const float* end, TreeStepResult& result) override;

private:
    // One side's data on the device.
    struct Side
    {
        DeviceTree m_tree;
        Buffer<Triangle> m_triangles;
        Buffer<float> m_radius;

        void upload(Device& device, const Tree& tree, const std::vector<Triangle>& triangles,
                    const std::vector<float>& radius);
        BroadPhaseBuffers traversed() { return {m_tree.m_nodes, m_tree.m_order, m_triangles}; }
    };

    void upload();
    void uploadGeometry();
    PairSides pairSides() const;
    void reserveContacts(std::size_t count);
    void enqueue();
    // Makes room for what the last run demanded. Returns whether the step must run again.
    bool grow(const StepCounters& counters, bool& limitReached);
    void read(std::size_t contacts);

    Device& m_device;
    const TreeScene& m_scene;
    Methods m_methods;
    TreeRefitStage m_refit;
    std::unique_ptr<DeviceTraversal> m_traversal;
    PairStage m_pairs;
    OrderingStage m_ordering;
    UnsortedContacts m_unsorted;
    Side m_cloth, m_obstacle;
    Buffer<float> m_start, m_end, m_thickness;
    // Geometry of both sides for the narrow phase.
    Arena<ClothWord> m_clothArena;
    ArenaArray<Triangle> m_clothTriangles{m_clothArena, "cloth triangles"};
    ArenaArray<Edge> m_edges{m_clothArena, "cloth edges"};
    Arena<ObstacleWord> m_obstacleArena;
    ArenaArray<float> m_positions{m_obstacleArena, "obstacle positions"};
    ArenaArray<NormalCone> m_vertexCones{m_obstacleArena, "obstacle cones"};
    ArenaArray<NormalCone> m_edgeCones{m_obstacleArena, "obstacle cones"};
    ArenaArray<Triangle> m_obstacleTriangles{m_obstacleArena, "obstacle triangles"};
    Buffer<Candidate> m_candidates;
    Buffer<TraversalCounters> m_found;
    Buffer<StepCounters> m_counters[2], m_ignored;
    std::size_t m_turn = 0, m_asked = 0;
    TraversalCounters m_foundRead = {};
    std::vector<Contact> m_read;  // behind the head that has the step's counters
};

// Makes a traversal on a device.
std::unique_ptr<DeviceTraversal> makeTraversal(Device& device, Traversal traversal, const ProgramLoader& load);
}  // namespace drape
