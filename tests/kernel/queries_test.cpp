// Queries and self collision on a device: the host's answers bit for bit at every size, full lists counted, nothing
// written past their ends.
#include <drape/queries.h>

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_plugin/core/ordering/canonical_order.h"
#include "bullet_plugin/core/queries/query_device.h"
#include "scenes/shapes.h"
#include "tests/support/cases.h"
#include "tests/support/device_side.h"
#include "scenes/describe_mesh.h"
#include "tests/support/self_cases.h"

namespace drape::test
{
namespace
{
// Makes queries, a seventh of which touch within the step.
std::vector<CcdQuery> motionQueries(std::size_t count, std::uint32_t seed)
{
    Random random(seed);
    std::vector<CcdQuery> queries(count);
    for (CcdQuery& query : queries)
    {
        query.m_kind = random.below(2);
        for (int i = 0; i < 12; ++i)
        {
            // Some positions are on a grid, so that features touch at their borders.
            const bool whole = random.below(3) == 0;
            query.m_start[i] = whole ? float(random.below(4)) : random.uniform(0, 3);
            query.m_end[i] = whole ? float(random.below(4)) : random.uniform(0, 3);
        }
    }
    return queries;
}

std::vector<TriangleQuery> triangleQueries(std::size_t count, std::uint32_t seed)
{
    Random random(seed);
    std::vector<TriangleQuery> queries(count);
    for (TriangleQuery& query : queries)
    {
        const bool whole = random.below(2) == 0;
        for (int i = 0; i < 9; ++i)
        {
            query.m_a[i] = whole ? float(random.below(4)) : random.uniform(0, 3);
            query.m_b[i] = whole ? float(random.below(4)) : random.uniform(0, 3);
        }
    }
    return queries;
}
}  // namespace

class QueriesTest : public BackendTest
{
protected:
    void SetUp() override
    {
        BackendTest::SetUp();
        if (HasFatalFailure() || IsSkipped()) return;
        m_device = makeQueries(GetParam().m_settings);
        Settings host;
        host.m_backend = Backend::Host;
        m_host = makeQueries(host);
        ASSERT_TRUE(m_device && m_host);
        ASSERT_FALSE(m_device->deviceReport().m_onHost);
    }

    std::unique_ptr<Queries> m_device, m_host;
};

TEST_P(QueriesTest, MotionsAreTheHostsAtEverySize)
{
    for (std::size_t count : {0, 1, 63, 64, 65, 4099})
    {
        SCOPED_TRACE("seed 110, queries " + std::to_string(count));
        const std::vector<CcdQuery> queries = motionQueries(count, 110);
        for (float separation : {0.0f, 0.05f})
        {
            CcdSettings settings = defaultCcdSettings();
            settings.m_separation = separation;
            std::vector<CcdResult> device(count), host(count);
            ASSERT_TRUE(m_device->motions(queries.data(), count, settings, device.data()));
            ASSERT_TRUE(m_host->motions(queries.data(), count, settings, host.data()));
            EXPECT_TRUE(sameBytes(device, host));
            std::size_t hits = 0;
            for (const CcdResult& result : host)
                hits += result.m_hit;
            if (count < 1000) continue;
            EXPECT_GT(hits, count / 10);
            EXPECT_LT(hits, count / 2);
        }
    }
}

TEST_P(QueriesTest, TrianglesAreTheHostsAtEverySize)
{
    for (std::size_t count : {0, 1, 63, 64, 65, 5003})
    {
        SCOPED_TRACE("seed 111, queries " + std::to_string(count));
        const std::vector<TriangleQuery> queries = triangleQueries(count, 111);
        for (TriangleTest test : {TriangleTest::Certified, TriangleTest::Exact})
        {
            std::vector<std::uint32_t> device(count), host(count);
            ASSERT_TRUE(m_device->triangles(queries.data(), count, test, device.data()));
            ASSERT_TRUE(m_host->triangles(queries.data(), count, test, host.data()));
            EXPECT_TRUE(sameBytes(device, host));
            const std::size_t hits = std::size_t(std::count(host.begin(), host.end(), 1u));
            if (count < 1000) continue;
            EXPECT_GT(hits, count * 3 / 10);
            EXPECT_LT(hits, count * 8 / 10);
        }
    }
}

TEST_P(QueriesTest, MeshesAreTheHosts)
{
    for (const SelfCase& motion : selfCases())
    {
        SCOPED_TRACE(motion.m_name);
        const MeshDescription mesh = describeMesh(motion.m_mesh);
        MeshMotion device, host;
        ASSERT_TRUE(m_device->meshMotion(mesh, motion.m_end.data(), defaultCcdSettings(), device));
        ASSERT_TRUE(m_host->meshMotion(mesh, motion.m_end.data(), defaultCcdSettings(), host));
        EXPECT_EQ(device.m_trianglePairs, host.m_trianglePairs);
        EXPECT_EQ(device.m_vertexFaceCandidates, host.m_vertexFaceCandidates);
        EXPECT_EQ(device.m_edgeCandidates, host.m_edgeCandidates);
        EXPECT_TRUE(sameBytes(device.m_touching, host.m_touching));

        const TriangleMesh other = makeSphere(0.6f, 2);
        const MeshDescription second = describeMesh(other);
        for (const MeshDescription* b : {static_cast<const MeshDescription*>(nullptr), &second})
        {
            MeshPairs devicePairs, hostPairs;
            ASSERT_TRUE(m_device->meshPairs(mesh, b, 0.02f, devicePairs));
            ASSERT_TRUE(m_host->meshPairs(mesh, b, 0.02f, hostPairs));
            EXPECT_EQ(devicePairs.m_candidates, hostPairs.m_candidates);
            EXPECT_TRUE(sameBytes(devicePairs.m_within, hostPairs.m_within));
            EXPECT_TRUE(sameBytes(devicePairs.m_intersecting, hostPairs.m_intersecting));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, QueriesTest, testing::ValuesIn(openClBackends()), backendName);

// Tests the stage itself, with guarded lists.
class SelfCollisionTest : public DeviceTest
{
};

TEST_P(SelfCollisionTest, FullListsCountOnAndKeepToThemselves)
{
    const SelfCase motion = soupSelfCase(300, 112);
    QueryMesh mesh = makeQueryMesh(describeMesh(motion.m_mesh), motion.m_end.data());
    mesh.refit(0);
    std::vector<Candidate> host;
    leafPairsOnHost(mesh.tree(), mesh.tree(), DRAPE_WALK_SELF, [&](const Candidate& pair) { host.push_back(pair); });
    ASSERT_GT(host.size(), 1000u);
    sortCandidates(host);

    SelfCollisionStage stage;
    stage.create(*m_device, programOf(*m_device, "queries/self_collision"));
    Buffer<BvhNode> nodes;
    Buffer<cl_uint> order, lastLeaf;
    Buffer<Triangle> triangles;
    guardCopy(*m_device, nodes, mesh.m_nodes);
    guardCopy(*m_device, order, mesh.m_order);
    guardCopy(*m_device, lastLeaf, lastLeaves(mesh.m_nodes, mesh.m_layout.leafCount()));
    guardCopy(*m_device, triangles, mesh.m_topology.m_triangles);
    const DeviceTreeView tree = {nodes, order, triangles, lastLeaf, mesh.m_layout};
    for (std::size_t capacity : {std::size_t(1), std::size_t(17), host.size() - 1, host.size()})
    {
        SCOPED_TRACE("seed 112, capacity " + std::to_string(capacity));
        guard(*m_device, stage.pairs(), capacity);
        stage.enqueuePairs(*m_device, tree, tree, DRAPE_WALK_SELF, {0, mesh.m_layout.leafCount()});
        stage.enqueueReadCounters(*m_device);
        m_device->wait();
        EXPECT_EQ(stage.counters().m_pairs, host.size());
        EXPECT_EQ(stage.counters().m_tooDeep, 0u);
        EXPECT_TRUE(intact(*m_device, stage.pairs()));
        if (capacity < host.size()) continue;
        std::vector<Candidate> found = contents(*m_device, stage.pairs(), host.size());
        sortCandidates(found);
        EXPECT_TRUE(sameBytes(found, host));
    }
    EXPECT_FALSE(m_device->failed()) << m_device->error().text();
}

TEST_P(SelfCollisionTest, SmallBatchesFindTheSame)
{
    const SelfCase motion = soupSelfCase(400, 113);
    QueryMesh mesh = makeQueryMesh(describeMesh(motion.m_mesh), motion.m_end.data());
    mesh.refit(0);
    SelfCollisions host;
    selfCollideOnHost({mesh.tree(), mesh.m_topology.m_edges, mesh.m_start, mesh.m_end, mesh.m_topology.m_vertexCount},
                      defaultCcdSettings(), SelfLimits(), host);
    ASSERT_GT(host.m_hits.size(), 500u);
    QueryDevice device(openDevice(GetParam()), GetParam().m_settings);
    for (std::size_t bytes : {std::size_t(1) << 28, std::size_t(200000), std::size_t(40000), std::size_t(1)})
    {
        SCOPED_TRACE("seed 113, bytes a list " + std::to_string(bytes));
        device.stage() = SelfCollisionStage();
        device.stage().create(device.device(), programOf(device.device(), "queries/self_collision"));
        device.stage().limitLists(bytes);
        // Lists of one entry, so that growing and halving both take place.
        device.stage().pairs() = Buffer<Candidate>();
        device.stage().pairs().reserve(device.device(), 1);
        SelfCollisions found;
        ASSERT_TRUE(device.meshMotion(mesh, defaultCcdSettings(), SelfLimits(), found))
            << device.device().error().text();
        EXPECT_EQ(found.m_trianglePairs, host.m_trianglePairs);
        EXPECT_EQ(found.m_vertexFaceCandidates, host.m_vertexFaceCandidates);
        EXPECT_EQ(found.m_edgeCandidates, host.m_edgeCandidates);
        sortHits(found.m_hits);
        EXPECT_TRUE(sameBytes(found.m_hits, host.m_hits));
    }
}

// The root has more children than the traversal's stack has room for. The device stays usable.
TEST_P(SelfCollisionTest, ATreeTooDeepForTheStackIsRefused)
{
    const TriangleMesh sphere = makeSphere(0.5f, 2);
    QueryMesh mesh = makeQueryMesh(describeMesh(sphere), sphere.m_positions.data());
    QueryDevice device(openDevice(GetParam()), GetParam().m_settings);
    SelfCollisions found;
    BvhNode& root = mesh.m_nodes[mesh.m_layout.root()];
    const BvhNode good = root;
    root.m_first = 0;
    root.m_count = DRAPE_STACK_DEPTH + 1;
    EXPECT_FALSE(device.meshMotion(mesh, defaultCcdSettings(), SelfLimits(), found));
    EXPECT_EQ(device.error().text(),
              "traversal on " + device.device().info().m_name + "\nthe hierarchy is too deep for its stack");
    EXPECT_FALSE(device.device().failed());
    root = good;
    EXPECT_TRUE(device.meshMotion(mesh, defaultCcdSettings(), SelfLimits(), found)) << device.error().text();
    EXPECT_GT(found.m_trianglePairs, 0u);
}

// Limits that are reached in the first batch, in a later one, or met just so, give what the host gives.
TEST_P(SelfCollisionTest, LimitsInAnyBatchAreTheHosts)
{
    const SelfCase motion = soupSelfCase(400, 114);
    QueryMesh mesh = makeQueryMesh(describeMesh(motion.m_mesh), motion.m_end.data());
    mesh.refit(0);
    const HostMotion hostMotion = {mesh.tree(), mesh.m_topology.m_edges, mesh.m_start, mesh.m_end,
                                   mesh.m_topology.m_vertexCount};
    SelfCollisions whole;
    selfCollideOnHost(hostMotion, defaultCcdSettings(), SelfLimits(), whole);
    const std::uint64_t pairs = whole.m_trianglePairs;
    const std::uint64_t features = whole.m_vertexFaceCandidates + whole.m_edgeCandidates;
    QueryDevice device(openDevice(GetParam()), GetParam().m_settings);
    device.stage().limitLists(40000);
    device.stage().pairs() = Buffer<Candidate>();
    device.stage().pairs().reserve(device.device(), 1);
    const SelfLimits limits[] = {{10, 10},           {pairs - 1, 10},
                                 {pairs, 10},        {features / 2, 1000000},
                                 {features - 1, 10}, {features, whole.hits() - 1},
                                 {features, 10},     {features, whole.hits()}};
    for (const SelfLimits& limit : limits)
    {
        SCOPED_TRACE("seed 114, candidates " + std::to_string(limit.m_candidates) + ", hits " +
                     std::to_string(limit.m_hits));
        SelfCollisions host, found;
        selfCollideOnHost(hostMotion, defaultCcdSettings(), limit, host);
        ASSERT_TRUE(device.meshMotion(mesh, defaultCcdSettings(), limit, found)) << device.device().error().text();
        EXPECT_EQ(host.m_untested, limit.m_candidates < features);
        EXPECT_EQ(found.m_untested, host.m_untested);
        EXPECT_EQ(found.m_trianglePairs, pairs);
        EXPECT_EQ(host.m_trianglePairs, pairs);
        EXPECT_EQ(found.m_vertexFaceCandidates, host.m_vertexFaceCandidates);
        EXPECT_EQ(found.m_edgeCandidates, host.m_edgeCandidates);
        EXPECT_EQ(found.m_hitCount[0], host.m_hitCount[0]);
        EXPECT_EQ(found.m_hitCount[1], host.m_hitCount[1]);
        sortHits(found.m_hits);
        EXPECT_TRUE(sameBytes(found.m_hits, host.m_hits));
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, SelfCollisionTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
