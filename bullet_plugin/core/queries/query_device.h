// The queries on an OpenCL device. Every call waits; batches keep memory bounded.
#pragma once

#include <memory>

#include "bullet_plugin/core/queries/refit.h"
#include "bullet_plugin/core/device/program_set.h"
#include "drape/queries.h"
#include "pair_decision.h"

namespace drape
{
class QueryDevice
{
public:
    // Builds the kernels. On failure device().failed() is true and the error holds the log.
    QueryDevice(std::unique_ptr<Device> device, const Settings& settings);

    Device& device() { return *m_device; }
    bool fromCache() const { return m_programs.fromCache(); }
    SelfCollisionStage& stage() { return m_stage; }

    // Each returns false if the device failed or has no room; error() says which.
    const Error& error() const { return m_device->failed() ? m_device->error() : m_noRoom; }
    bool motions(const CcdQuery* queries, std::size_t count, const CcdSettings& settings, CcdResult* results);
    bool triangles(const TriangleQuery* queries, std::size_t count, std::uint32_t* results);
    // Passes the pairs that meet or are near by the certified tests to the decision, in no particular order. a and b:
    // the same mesh for a mesh with itself. If there are more candidates than the limit, stops with `within` false, and
    // counts them on the host after refitting the meshes there.
    bool meshPairs(QueryMesh& a, QueryMesh& b, float radius, std::uint64_t limit, std::uint64_t& candidates,
                   PairDecision& decision, bool& within);
    // Finds collisions of a mesh's motion with itself, and stops at the limits in the same way.
    bool meshMotion(QueryMesh& mesh, const CcdSettings& settings, const SelfLimits& limits, SelfCollisions& found);

private:
    struct Mesh
    {
        Buffer<BvhNode> m_nodes;
        Buffer<cl_uint> m_order, m_lastLeaf;
        Buffer<Triangle> m_triangles;
        Buffer<Edge> m_edges;
        Buffer<float> m_start, m_end, m_radius;
        RefitStage::Levels m_levels;
    };

    // Pairs of triangles over all leaves of one side, and the maximum that may be tested.
    struct PairWalk
    {
        std::uint32_t m_leafCount;
        std::uint64_t m_limit;
        std::uint64_t m_pairs = 0;
        bool m_tooMany = false;

        std::uint64_t left() const { return m_limit - m_pairs; }
    };

    void upload(const QueryMesh& source, float radius, Mesh& mesh);
    DeviceTreeView tree(const QueryMesh& source, Mesh& mesh) const;
    bool refuse(const std::string& why);
    template <typename Enqueue, typename Meet, typename Take>
    bool inBatches(PairWalk& walk, Enqueue enqueue, Meet meet, Take take);
    bool answerPairs(Mesh& a, Mesh& b, float radius, PairDecision& decision);
    bool takeHits(const SelfLimits& limits, SelfCollisions& found);

    std::unique_ptr<Device> m_device;
    Error m_noRoom;  // error of the last walk; the device stays usable
    ProgramSet m_programs;
    RefitStage m_refit;
    SelfCollisionStage m_stage;
    BoundKernel<kernels::queryMotion> m_motion;
    BoundKernel<kernels::queryTriangles> m_triangles;
    BoundKernel<kernels::queryPairs> m_pairs;
    Buffer<CcdQuery> m_motionQueries;
    Buffer<CcdResult> m_motionResults;
    Buffer<TriangleQuery> m_triangleQueries;
    Buffer<cl_uint> m_triangleResults, m_answerDemand;
    Buffer<PairAnswer> m_answers;
    Buffer<StepCounters> m_refitCounters;
};
}  // namespace drape
