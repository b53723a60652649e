// Self collision: finds features of a moving mesh that touch one another during a step, and pairs of triangles of a
// mesh with itself or of two meshes.
//
// Job: from hierarchies over the step's motion to pairs of triangles, then to the vertex-face and edge-edge pairs whose
// own volumes overlap, then to those that touch (kernels/lib/ccd/ccd.h). Features that share a vertex are left out.
// Guarantee: no touching pair is missed; host and device find the same sets, and times bit for bit. Cost: linear in the
// pairs; memory is bounded, since long lists are made in batches of leaves.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "bullet_plugin/core/probe/bvh_layout.h"
#include "kernels/lib/broad_phase/leaf_walk.h"
#include "kernels/queries/queries_bindings.h"

namespace drape
{
// The last leaf below each node.
std::vector<std::uint32_t> lastLeaves(const std::vector<BvhNode>& nodes, std::uint32_t leafCount);

// A hierarchy and its triangles on the host.
struct HostTree
{
    const std::vector<BvhNode>& m_nodes;
    const BvhLayout& m_layout;
    const std::vector<std::uint32_t>& m_order;
    const std::vector<Triangle>& m_triangles;
};

// Calls visit for each pair; kind: DRAPE_WALK_…, with a and b the same tree for a mesh with itself. Ends when goesOn,
// called before each pair, returns false.
void leafPairsOnHost(const HostTree& a, const HostTree& b, std::uint32_t kind,
                     const std::function<void(const Candidate&)>& visit, const std::function<bool()>& goesOn = nullptr);

// Positions: m, x y z per vertex at the step's start and end.
struct HostMotion
{
    HostTree m_tree;
    const std::vector<Edge>& m_edges;
    const float* m_start;
    const float* m_end;
    std::size_t m_vertexCount;
};

// Maximum pairs that a search may test and list.
struct SelfLimits
{
    std::uint64_t m_candidates = ~std::uint64_t(0);  // pairs of triangles, and pairs of features of both kinds
    std::uint64_t m_hits = ~std::uint64_t(0);
};

// Exact counts, except that those of features are 0 if there were too many triangle pairs.
struct SelfCollisions
{
    std::uint64_t m_trianglePairs = 0;
    std::uint64_t m_vertexFaceCandidates = 0;
    std::uint64_t m_edgeCandidates = 0;
    std::uint64_t m_hitCount[2] = {0, 0};  // by kind
    std::vector<FeatureHit> m_hits;        // by kind, first and second feature; none if there are too many
    bool m_untested = false;               // there are more candidates than may be tested, and no hits

    std::uint64_t hits() const { return m_hitCount[0] + m_hitCount[1]; }
    // Records a search that finds more candidates than it may test.
    void leaveUntested();
    // Counts a hit, and lists it while the list is within its limit.
    void add(const FeatureHit& hit, const SelfLimits& limits);
};

// Returns half the separation, rounded up: volumes grown by it overlap wherever two features come within the
// separation.
float selfRadius(const CcdSettings& settings);

void selfCollideOnHost(const HostMotion& motion, const CcdSettings& settings, const SelfLimits& limits,
                       SelfCollisions& found);

void sortHits(std::vector<FeatureHit>& hits);

// Device buffers of the same view.
struct DeviceTreeView
{
    Buffer<BvhNode>& m_nodes;
    Buffer<cl_uint>& m_order;
    Buffer<Triangle>& m_triangles;
    Buffer<cl_uint>& m_lastLeaf;
    const BvhLayout& m_layout;
};

struct DeviceMotion
{
    DeviceTreeView m_tree;
    Buffer<Edge>& m_edges;
    Buffer<float>& m_start;
    Buffer<float>& m_end;
    std::size_t m_vertexCount;
};

class SelfCollisionStage
{
public:
    static constexpr std::uint64_t kMostCounted = DRAPE_DEMAND_LIMIT - 1;

    void create(Device& device, const cl::Program& program);

    // Leaves of one batch, by their positions in the order.
    struct Batch
    {
        std::uint32_t m_first = 0;
        std::uint32_t m_count = 0;
    };

    // Computes the volumes of the vertices; once a step, before the tests. Each function returns after enqueueing.
    void enqueueVolumes(Device& device, DeviceMotion motion, const CcdSettings& settings);
    // Zeroes the counters and lists the batch's pairs of triangles. The traversal ends when their count exceeds `most`;
    // the count is exact up to it.
    void enqueuePairs(Device& device, DeviceTreeView a, DeviceTreeView b, std::uint32_t kind, Batch batch,
                      std::uint64_t most = kMostCounted);
    // Lists the features of the pairs; counts those without room in the lists.
    void enqueueFeatures(Device& device, DeviceMotion motion);
    // Lists the hits among them.
    void enqueueTests(Device& device, DeviceMotion motion, const CcdSettings& settings);
    void enqueueReadCounters(Device& device);

    // Returns the last batch's demand, after waiting.
    const SelfCounters& counters() const { return m_read; }
    enum class Demand
    {
        Met,
        Grown,   // lists grew: run the batch again
        TooMuch  // run a smaller batch
    };
    Demand meetDemand(Device& device);
    // Queries the triangle pairs alone.
    Demand meetPairs(Device& device);
    // Maximum bytes of one list. A batch of one leaf may exceed it.
    void limitLists(std::size_t bytes) { m_listBytes = bytes; }

    Buffer<Candidate>& pairs() { return m_pairs; }
    Buffer<FeatureHit>& hits() { return m_hits; }

private:
    template <typename T>
    Demand meet(Device& device, std::size_t wanted, Buffer<T>& list) const;

    BoundKernel<kernels::selfVolumes> m_volumesKernel;
    BoundKernel<kernels::leafTraverse> m_traverse;
    BoundKernel<kernels::selfFeatures> m_features;
    BoundKernel<kernels::selfTest> m_test;
    Buffer<Dop> m_volumes;
    Buffer<Candidate> m_pairs;
    Buffer<FeaturePair> m_vertexFace, m_edgePairs;
    Buffer<FeatureHit> m_hits;
    Buffer<SelfCounters> m_counters;
    SelfCounters m_read = {};
    std::size_t m_listBytes = std::size_t(256) << 20;  // four lists then fit into 1 GiB
};
}  // namespace drape
