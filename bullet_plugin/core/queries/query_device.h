// The queries on an OpenCL device. Every call waits; batches keep memory bounded.
#pragma once

#include <memory>

#include "bullet_plugin/core/bvh/refit.h"
#include "drape/queries.h"
#include "query_mesh.h"

namespace drape
{
class QueryDevice
{
public:
    // Builds the kernels. On failure device().failed() tells and the error holds the log.
    QueryDevice(std::unique_ptr<Device> device, const Settings& settings);

    Device& device() { return *m_device; }
    bool fromCache() const { return m_fromCache; }
    SelfCollisionStage& stage() { return m_stage; }

    // Each returns false when the device failed.
    bool motions(const CcdQuery* queries, std::size_t count, const CcdSettings& settings, CcdResult* results);
    bool triangles(const TriangleQuery* queries, std::size_t count, std::uint32_t test, std::uint32_t* results);
    // Pairs that meet or are near by the certified tests, in no order; a and b the same mesh: with itself.
    bool meshPairs(const QueryMesh& a, const QueryMesh& b, float radius, std::uint64_t& candidates,
                   std::vector<PairAnswer>& answers);
    bool meshMotion(const QueryMesh& mesh, const CcdSettings& settings, SelfCollisions& found);

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

    cl::Program program(const char* name, const std::string& cacheFolder);
    void upload(const QueryMesh& source, float radius, Mesh& mesh);
    DeviceTree tree(const QueryMesh& source, Mesh& mesh) const;
    template <typename Enqueue, typename Take>
    bool inBatches(std::uint32_t leafCount, Enqueue enqueue, Take take);
    bool answerPairs(Mesh& a, Mesh& b, float radius, std::vector<PairAnswer>& answers);

    std::unique_ptr<Device> m_device;
    bool m_fromCache = true;
    RefitStage m_refit;
    SelfCollisionStage m_stage;
    Kernel m_motion, m_triangles, m_pairs;
    Buffer<CcdQuery> m_motionQueries;
    Buffer<CcdResult> m_motionResults;
    Buffer<TriangleQuery> m_triangleQueries;
    Buffer<cl_uint> m_triangleResults, m_answerDemand;
    Buffer<PairAnswer> m_answers;
    Buffer<StepCounters> m_refitCounters;
};
}  // namespace drape
