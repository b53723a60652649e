#include "query_device.h"

#include <algorithm>

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
// Queries per batch: 25 MiB of the largest kind, work for any device.
constexpr std::size_t kBatch = std::size_t(1) << 18;
}  // namespace

QueryDevice::QueryDevice(std::unique_ptr<Device> device, const Settings& settings) : m_device(std::move(device))
{
    const cl::Program queries = program("queries", settings.m_cacheFolder);
    m_motion.create(*m_device, queries, "queryMotion");
    m_triangles.create(*m_device, queries, "queryTriangles");
    m_pairs.create(*m_device, queries, "queryPairs");
    m_refit.create(*m_device, program("refit", settings.m_cacheFolder));
    m_stage.create(*m_device, program("self_collision", settings.m_cacheFolder));
    m_refitCounters.reserve(*m_device, 1);
    m_answerDemand.reserve(*m_device, 1);
}

cl::Program QueryDevice::program(const char* name, const std::string& cacheFolder)
{
    ProgramBuild build;
    const cl::Program built = buildProgram(*m_device, name, cacheFolder, build);
    m_fromCache = m_fromCache && build.m_fromCache;
    return built;
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
        m_motion.launch(device, some, kGroup, m_motionQueries.handle(), cl_uint(some), settings.m_separation,
                        settings.m_tolerance, settings.m_timeTolerance, cl_uint(settings.m_boxLimit),
                        m_motionResults.handle());
        m_motionResults.read(device, results + first, some);
        device.wait();
    }
    return !device.failed();
}

bool QueryDevice::triangles(const TriangleQuery* queries, std::size_t count, std::uint32_t test, std::uint32_t* results)
{
    Device& device = *m_device;
    for (std::size_t first = 0; first < count; first += kBatch)
    {
        const std::size_t some = std::min(kBatch, count - first);
        m_triangleQueries.reserve(device, some);
        m_triangleResults.reserve(device, some);
        m_triangleQueries.write(device, queries + first, some);
        m_triangles.launch(device, some, kGroup, m_triangleQueries.handle(), cl_uint(some), cl_uint(test),
                           m_triangleResults.handle());
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
    device.wait();  // locals were uploaded
}

DeviceTree QueryDevice::tree(const QueryMesh& source, Mesh& mesh) const
{
    return {mesh.m_nodes, mesh.m_order, mesh.m_triangles, mesh.m_lastLeaf, source.m_layout};
}

// Runs enqueue(batch) over all leaves; take() reads what a batch found. Lists grow to their limit, then batches shrink.
template <typename Enqueue, typename Take>
bool QueryDevice::inBatches(std::uint32_t leafCount, Enqueue enqueue, Take take)
{
    Device& device = *m_device;
    SelfCollisionStage::Batch batch;
    batch.m_count = leafCount;
    while (batch.m_first < leafCount)
    {
        batch.m_count = std::min(batch.m_count, leafCount - batch.m_first);
        enqueue(batch);
        m_stage.enqueueReadCounters(device);
        device.wait();
        if (!device.failed() && m_stage.counters().m_tooDeep > 0)
            device.check(CL_OUT_OF_RESOURCES, "traversal", "the hierarchy is too deep for its stack");
        if (device.failed()) return false;
        switch (m_stage.meetDemand(device))
        {
            case SelfCollisionStage::Demand::Grown:
                break;
            case SelfCollisionStage::Demand::TooMuch:
                // One triangle's pairs are at most the triangles of the other side.
                if (batch.m_count == 1) m_stage.limitLists(device.maxAllocationBytes());
                if (batch.m_count == 1 && m_stage.meetDemand(device) == SelfCollisionStage::Demand::TooMuch)
                    device.check(CL_MEM_OBJECT_ALLOCATION_FAILURE, "traversal", "the pairs of one triangle do not fit");
                batch.m_count = (batch.m_count + 1) / 2;
                break;
            case SelfCollisionStage::Demand::Met:
                if (!take()) return false;
                batch.m_first += batch.m_count;
        }
    }
    return !device.failed();
}

bool QueryDevice::answerPairs(Mesh& a, Mesh& b, float radius, std::vector<PairAnswer>& answers)
{
    Device& device = *m_device;
    const cl_uint count = m_stage.counters().m_pairs;
    cl_uint demand = 0;
    do
    {
        m_answers.reserve(device, std::size_t(demand) + demand / 4 + 1024);
        m_answerDemand.fill(device, 0, 1);
        m_pairs.launch(device, count, kGroup, m_stage.pairs().handle(), count, a.m_start.handle(),
                       a.m_triangles.handle(), b.m_start.handle(), b.m_triangles.handle(), radius, m_answers.handle(),
                       cl_uint(m_answers.capacity()), m_answerDemand.handle());
        m_answerDemand.read(device, &demand, 1);
        device.wait();
    } while (!device.failed() && demand > m_answers.capacity());
    if (device.failed()) return false;
    answers.resize(answers.size() + demand);
    m_answers.read(device, answers.data() + answers.size() - demand, demand);
    device.wait();
    return !device.failed();
}

bool QueryDevice::meshPairs(const QueryMesh& a, const QueryMesh& b, float radius, std::uint64_t& candidates,
                            std::vector<PairAnswer>& answers)
{
    const bool self = &a == &b;
    Mesh meshA, other;
    upload(a, self ? 0.5f * radius : radius, meshA);
    if (!self) upload(b, 0.0f, other);
    Mesh& meshB = self ? meshA : other;
    const std::uint32_t kind = self ? DRAPE_WALK_SELF_APART : DRAPE_WALK_OTHER;
    const auto enqueue = [&](const SelfCollisionStage::Batch& batch)
    { m_stage.enqueuePairs(*m_device, tree(a, meshA), tree(b, meshB), kind, batch); };
    const auto take = [&]
    {
        candidates += m_stage.counters().m_pairs;
        return answerPairs(meshA, meshB, radius, answers);
    };
    return inBatches(a.m_layout.leafCount(), enqueue, take);
}

bool QueryDevice::meshMotion(const QueryMesh& source, const CcdSettings& settings, SelfCollisions& found)
{
    Mesh mesh;
    upload(source, selfRadius(settings), mesh);
    const DeviceTree deviceTree = tree(source, mesh);
    const DeviceMotion motion = {deviceTree, mesh.m_edges, mesh.m_start, mesh.m_end, source.m_topology.m_vertexCount};
    m_stage.enqueueVolumes(*m_device, motion, settings);
    const auto enqueue = [&](const SelfCollisionStage::Batch& batch)
    {
        m_stage.enqueuePairs(*m_device, deviceTree, deviceTree, DRAPE_WALK_SELF, batch);
        m_stage.enqueueTests(*m_device, motion, settings);
    };
    const auto take = [&]
    {
        const SelfCounters& counters = m_stage.counters();
        found.m_trianglePairs += counters.m_pairs;
        found.m_vertexFaceCandidates += counters.m_vertexFace;
        found.m_edgeCandidates += counters.m_edgeEdge;
        found.m_hits.resize(found.m_hits.size() + counters.m_hits);
        m_stage.hits().read(*m_device, found.m_hits.data() + found.m_hits.size() - counters.m_hits, counters.m_hits);
        m_device->wait();
        return !m_device->failed();
    };
    return inBatches(source.m_layout.leafCount(), enqueue, take);
}
}  // namespace drape
