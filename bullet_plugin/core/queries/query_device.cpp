#include "query_device.h"

#include <algorithm>

#include "bullet_plugin/core/queries/leaf_pair_count.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
// Queries per batch: 25 MiB of the largest kind, work for any device.
constexpr std::size_t kBatch = std::size_t(1) << 18;
}  // namespace

QueryDevice::QueryDevice(std::unique_ptr<Device> device, const Settings& settings)
    : m_device(std::move(device)),
      m_programs(*m_device, settings.m_cacheFolder, {{"queries/queries", "queries/refit", "queries/self_collision"}})
{
    const cl::Program queries = m_programs.load("queries/queries");
    m_motion.create(*m_device, queries);
    m_triangles.create(*m_device, queries);
    m_pairs.create(*m_device, queries);
    m_refit.create(*m_device, m_programs.load("queries/refit"));
    m_stage.create(*m_device, m_programs.load("queries/self_collision"));
    m_refitCounters.reserve(*m_device, 1);
    m_answerDemand.reserve(*m_device, 1);
}

bool QueryDevice::motions(const CcdQuery* queries, std::size_t count, const CcdSettings& settings, CcdResult* results)
{
    Device& device = *m_device;
    for (std::size_t first = 0; first < count; first += kBatch)
    {
        const std::size_t some = std::min(kBatch, count - first);
        m_motionQueries.reserve(device, some);
        m_motionResults.reserve(device, some);
        m_motionQueries.write(device, queries + first, some);
        m_motion.launch(device, some, kGroup, {settings, cl_uint(some)}, m_motionQueries, m_motionResults);
        m_motionResults.read(device, results + first, some);
        device.wait();
    }
    return !device.failed();
}

bool QueryDevice::triangles(const TriangleQuery* queries, std::size_t count, std::uint32_t* results)
{
    Device& device = *m_device;
    for (std::size_t first = 0; first < count; first += kBatch)
    {
        const std::size_t some = std::min(kBatch, count - first);
        m_triangleQueries.reserve(device, some);
        m_triangleResults.reserve(device, some);
        m_triangleQueries.write(device, queries + first, some);
        m_triangles.launch(device, some, kGroup, cl_uint(some), m_triangleQueries, m_triangleResults);
        m_triangleResults.read(device, results + first, some);
        device.wait();
    }
    return !device.failed();
}

void QueryDevice::upload(const QueryMesh& source, float radius, Mesh& mesh)
{
    Device& device = *m_device;
    const std::size_t floats = 3 * source.m_topology.m_vertexCount;
    const std::vector<std::uint32_t> last = lastLeaves(source.m_nodes, source.m_layout.leafCount());
    const std::vector<float> radii = {radius};
    const WaitAtEnd wait(device);
    mesh.m_nodes.assign(device, source.m_nodes);
    mesh.m_order.assign(device, source.m_order);
    mesh.m_lastLeaf.assign(device, last);
    mesh.m_triangles.assign(device, source.m_topology.m_triangles);
    mesh.m_edges.assign(device, source.m_topology.m_edges);
    mesh.m_start.reserve(device, floats);
    mesh.m_start.write(device, source.m_start, floats);
    mesh.m_end.reserve(device, floats);
    mesh.m_end.write(device, source.m_end, floats);
    mesh.m_radius.assign(device, radii);
    m_refit.makeLevels(device, source.m_layout, mesh.m_levels);
    m_refitCounters.fill(device, 0, 1);
    m_refit.enqueue(device, source.m_layout, mesh.m_levels, mesh.m_nodes, mesh.m_order, mesh.m_triangles, mesh.m_start,
                    mesh.m_end, mesh.m_radius, m_refitCounters);
}

DeviceTreeView QueryDevice::tree(const QueryMesh& source, Mesh& mesh) const
{
    return {mesh.m_nodes, mesh.m_order, mesh.m_triangles, mesh.m_lastLeaf, source.m_layout};
}

bool QueryDevice::refuse(const std::string& why)
{
    m_noRoom.m_call = "traversal on " + m_device->info().m_name;
    m_noRoom.m_detail = why;
    return false;
}

// Runs enqueue(batch) over all leaves; take() reads a batch's results. meet() makes lists grow up to their limit; after
// that, batches shrink. Ends early if there are more pairs of triangles than the walk may have.
template <typename Enqueue, typename Meet, typename Take>
bool QueryDevice::inBatches(PairWalk& walk, Enqueue enqueue, Meet meet, Take take)
{
    Device& device = *m_device;
    SelfCollisionStage::Batch batch;
    batch.m_count = walk.m_leafCount;
    while (batch.m_first < walk.m_leafCount)
    {
        batch.m_count = std::min(batch.m_count, walk.m_leafCount - batch.m_first);
        enqueue(batch);
        m_stage.enqueueReadCounters(device);
        device.wait();
        if (device.failed()) return false;
        if (m_stage.counters().m_tooDeep > 0) return refuse("the hierarchy is too deep for its stack");
        walk.m_tooMany = m_stage.counters().m_pairs > walk.left();
        if (walk.m_tooMany) return true;
        switch (meet())
        {
            case SelfCollisionStage::Demand::Grown:
                break;
            case SelfCollisionStage::Demand::TooMuch:
                // One triangle's pairs are at most the triangles of the other side.
                if (batch.m_count == 1) m_stage.limitLists(device.maxAllocationBytes());
                if (batch.m_count == 1 && meet() == SelfCollisionStage::Demand::TooMuch)
                    return refuse("the pairs of one triangle do not fit");
                batch.m_count = (batch.m_count + 1) / 2;
                break;
            case SelfCollisionStage::Demand::Met:
                if (!take()) return false;
                walk.m_pairs += m_stage.counters().m_pairs;
                batch.m_first += batch.m_count;
        }
    }
    return !device.failed();
}

bool QueryDevice::answerPairs(Mesh& a, Mesh& b, float radius, PairDecision& decision)
{
    Device& device = *m_device;
    const cl_uint count = m_stage.counters().m_pairs;
    cl_uint demand = 0;
    do
    {
        m_answers.reserve(device, std::size_t(demand) + demand / 4 + 1024);
        m_answerDemand.fill(device, 0, 1);
        m_pairs.launch(device, count, kGroup, {count, radius, cl_uint(m_answers.capacity())}, m_stage.pairs(),
                       a.m_start, a.m_triangles, b.m_start, b.m_triangles, m_answers, m_answerDemand);
        m_answerDemand.read(device, &demand, 1);
        device.wait();
    } while (!device.failed() && demand > m_answers.capacity());
    if (device.failed()) return false;
    std::vector<PairAnswer> answers(demand);
    m_answers.read(device, answers.data(), demand);
    device.wait();
    if (device.failed()) return false;
    for (const PairAnswer& answer : answers)
        decision.take(answer);
    return true;
}

bool QueryDevice::meshPairs(QueryMesh& a, QueryMesh& b, float radius, std::uint64_t limit, std::uint64_t& candidates,
                            PairDecision& decision, bool& within)
{
    const bool self = &a == &b;
    const MeshRadii radii(a, b, radius);
    Mesh meshA, other;
    upload(a, radii.m_a, meshA);
    if (!self) upload(b, radii.m_b, other);
    Mesh& meshB = self ? meshA : other;
    const std::uint32_t kind = walkOf(a, b);
    PairWalk walk = {a.m_layout.leafCount(), limit};
    const auto enqueue = [&](const SelfCollisionStage::Batch& batch)
    { m_stage.enqueuePairs(*m_device, tree(a, meshA), tree(b, meshB), kind, batch, walk.left()); };
    const auto meet = [&] { return m_stage.meetDemand(*m_device); };
    const auto take = [&] { return answerPairs(meshA, meshB, radius, decision); };
    if (!inBatches(walk, enqueue, meet, take)) return false;
    candidates = walk.m_pairs;
    within = !walk.m_tooMany;
    if (within) return true;
    refitBoth(a, b, radius);
    candidates = countLeafPairs(a.tree(), b.tree(), kind);
    return true;
}

bool QueryDevice::takeHits(const SelfLimits& limits, SelfCollisions& found)
{
    std::vector<FeatureHit> hits(m_stage.counters().m_hits);
    m_stage.hits().read(*m_device, hits.data(), hits.size());
    m_device->wait();
    if (m_device->failed()) return false;
    for (const FeatureHit& hit : hits)
        found.add(hit, limits);
    return true;
}

bool QueryDevice::meshMotion(QueryMesh& source, const CcdSettings& settings, const SelfLimits& limits,
                             SelfCollisions& found)
{
    Mesh mesh;
    upload(source, selfRadius(settings), mesh);
    const DeviceTreeView deviceTree = tree(source, mesh);
    const DeviceMotion motion = {deviceTree, mesh.m_edges, mesh.m_start, mesh.m_end, source.m_topology.m_vertexCount};
    m_stage.enqueueVolumes(*m_device, motion, settings);
    const SelfCounters& counters = m_stage.counters();
    PairWalk walk = {source.m_layout.leafCount(), limits.m_candidates};
    const auto enqueue = [&](const SelfCollisionStage::Batch& batch)
    {
        m_stage.enqueuePairs(*m_device, deviceTree, deviceTree, DRAPE_WALK_SELF, batch, walk.left());
        m_stage.enqueueFeatures(*m_device, motion);
        if (!found.m_untested) m_stage.enqueueTests(*m_device, motion, settings);
    };
    // Lists need no room for features that are too many to test.
    const auto meet = [&]
    {
        const SelfCollisionStage::Demand pairs = m_stage.meetPairs(*m_device);
        if (pairs != SelfCollisionStage::Demand::Met) return pairs;
        const std::uint64_t features = found.m_vertexFaceCandidates + found.m_edgeCandidates +
                                       std::uint64_t(counters.m_vertexFace) + std::uint64_t(counters.m_edgeEdge);
        if (features > limits.m_candidates) found.leaveUntested();
        return found.m_untested ? pairs : m_stage.meetDemand(*m_device);
    };
    const auto take = [&]
    {
        found.m_vertexFaceCandidates += counters.m_vertexFace;
        found.m_edgeCandidates += counters.m_edgeEdge;
        return found.m_untested || takeHits(limits, found);
    };
    if (!inBatches(walk, enqueue, meet, take)) return false;
    found.m_trianglePairs = walk.m_pairs;
    if (!walk.m_tooMany) return true;
    found = SelfCollisions();
    found.leaveUntested();
    source.refit(selfRadius(settings));
    found.m_trianglePairs = countLeafPairs(source.tree(), source.tree(), DRAPE_WALK_SELF);
    return true;
}
}  // namespace drape
