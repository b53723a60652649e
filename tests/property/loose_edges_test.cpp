// Edges of a cloth that are not a triangle's: the same contacts on every back end, and of what is near an
// obstacle none is missing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "bullet_plugin/core/exact/triangles.h"
#include "bullet_plugin/core/scene/topology.h"
#include "scenes/describe_mesh.h"
#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/self_cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
// Takes triangles out of the cloth, all but every `kept`-th, and leaves their edges; 0 takes all out. Returns the
// edges.
std::vector<std::int32_t> unravel(TriangleMesh& cloth, std::size_t kept)
{
    std::vector<std::int32_t> edges, triangles;
    for (std::size_t t = 0; t < cloth.triangleCount(); ++t)
    {
        const std::int32_t* const v = &cloth.m_triangles[3 * t];
        if (kept > 0 && t % kept == 0) triangles.insert(triangles.end(), v, v + 3);
        for (int i = 0; i < 3; ++i)
            edges.insert(edges.end(), {v[i], v[(i + 1) % 3]});
    }
    cloth.m_triangles = triangles;
    return edges;
}

MeshId addNet(Pipeline& pipeline, const TriangleMesh& cloth, const std::vector<std::int32_t>& edges)
{
    MeshDescription description = describeMesh(cloth);
    description.m_edges = edges.data();
    description.m_edgeCount = edges.size() / 2;
    description.m_looseVertices = true;
    return pipeline.addCloth(description);
}

std::vector<Contact> runNet(Pipeline& pipeline, const StepCase& step, const std::vector<std::int32_t>& edges)
{
    const MeshId cloth = addNet(pipeline, step.m_cloth, edges), obstacle = addObstacle(pipeline, step.m_obstacle);
    setMotion(pipeline, cloth, step.m_cloth.m_positions, step.m_end);
    pipeline.addPair(cloth, obstacle, step.m_thickness);
    return runStep(pipeline);
}

bool isOfSegment(const Contact& contact, const Side& cloth)
{
    const auto& triangles = cloth.m_pool.triangles();
    return contact.m_kind == DRAPE_FACE_VERTEX &&
           triangles[contact.m_clothFeature].m_vertices[1] == triangles[contact.m_clothFeature].m_vertices[2];
}

std::vector<StepCase> netCases()
{
    std::vector<StepCase> cases;
    for (const char* shape : {"sphere", "box", "stairs", "torus", "terrain"})
    {
        cases.push_back(drapedCase(shape, 12, 0.03f, 860));
        cases.push_back(fallingCase(shape, 12, 0.03f, 861));
    }
    cases.push_back(soupCase(120, 160, true, 862));
    cases.push_back(needleCase(Thin::Obstacle, 100, 0.1f, true, 863));
    return cases;
}

// Returns the exact distance between a segment, given by its two ends, and a mesh. Returns zero if they meet.
double distanceTo(const TriangleMesh& mesh, const float* ends)
{
    const float corners[9] = {ends[0], ends[1], ends[2], ends[3], ends[4], ends[5], ends[3], ends[4], ends[5]};
    const ExactTriangle segment = exactTriangle(corners);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    {
        float other[9];
        for (std::size_t k = 0; k < 9; ++k)
            other[k] = mesh.m_positions[3 * std::size_t(mesh.m_triangles[3 * t + k / 3]) + k % 3];
        const ExactTriangle triangle = exactTriangle(other);
        if (trianglesMeet(segment, triangle)) return 0;
        least = std::min(least, std::sqrt(squaredDistance(segment, triangle)));
    }
    return least;
}
}  // namespace

class LooseEdges : public BackendTest
{
};

TEST_P(LooseEdges, FindsTheContactsOfAllPairs)
{
    std::size_t all = 0, ofSegments = 0;
    for (StepCase step : netCases())
    {
        SCOPED_TRACE(step.trace());
        const std::vector<std::int32_t> edges = unravel(step.m_cloth, step.m_seed % 2 == 0 ? 0 : 3);
        Side cloth = makeSide({step.m_cloth}, edges);
        const Side obstacle = makeSide({step.m_obstacle});
        cloth.m_end = step.m_end;
        Settings settings = GetParam().m_settings;
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
        ASSERT_TRUE(pipeline);
        const std::vector<Contact> found = runNet(*pipeline, step, edges);
        const std::vector<Contact> expected =
            contactsOfAllPairs(cloth, obstacle, step.m_thickness * (1 + settings.m_activation));
        ASSERT_TRUE(sameBytes(found, expected)) << difference(found, expected);
        EXPECT_EQ(pipeline->statistics().m_clothTriangles, step.m_cloth.triangleCount());
        all += found.size();
        for (const Contact& contact : found)
        {
            if (!isOfSegment(contact, cloth)) continue;
            ++ofSegments;
            EXPECT_EQ(contact.m_weights[2], 0.0f);
            const ContactView view = pipeline->view(contact);
            EXPECT_EQ(view.m_nodes[2], -1);
            EXPECT_EQ(view.m_triangle, -1);
        }
    }
    EXPECT_GT(all, 5000u);
    EXPECT_GT(ofSegments, 100u);
}

TEST_P(LooseEdges, HaveTheHostsContactsOnEveryBackend)
{
    std::size_t contacts = 0;
    for (StepCase step : netCases())
    {
        SCOPED_TRACE(step.trace());
        const std::vector<std::int32_t> edges = unravel(step.m_cloth, 4);
        const std::unique_ptr<Pipeline> host = makePipeline(allBackends()[0].m_settings);
        const std::unique_ptr<Pipeline> own = makePipeline(GetParam().m_settings);
        ASSERT_TRUE(host && own);
        const std::vector<Contact> expected = runNet(*host, step, edges);
        const std::vector<Contact> found = runNet(*own, step, edges);
        ASSERT_TRUE(sameBytes(found, expected)) << difference(found, expected);
        contacts += found.size();
    }
    EXPECT_GT(contacts, 1000u);
}

// Segments at rest at random beside an obstacle: each that is within the thickness has a contact with a point of it
// that is as near as any.
TEST_P(LooseEdges, EachHasAContactAtItsNearestPoint)
{
    constexpr float kReach = 0.05f;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    Random random(870);
    int near = 0, atVertices = 0;
    for (const char* shape : {"box", "sphere", "torus", "stairs"})
    {
        SCOPED_TRACE(shape);
        StepCase step = {shape, 870, {}, shapeNamed(shape), {}, kReach};
        constexpr int kSegments = 400;
        std::vector<std::int32_t> edges;
        for (int i = 0; i < kSegments; ++i)
        {
            // The position is around a vertex of the obstacle.
            const std::uint32_t vertex = random.below(std::uint32_t(step.m_obstacle.vertexCount()));
            float middle[3], along[3];
            for (int axis = 0; axis < 3; ++axis)
            {
                middle[axis] =
                    step.m_obstacle.m_positions[3 * vertex + std::size_t(axis)] + random.uniform(-0.1f, 0.1f);
                along[axis] = random.uniform(-0.15f, 0.15f);
            }
            for (const float side : {-1.0f, 1.0f})
                for (int axis = 0; axis < 3; ++axis)
                    step.m_cloth.m_positions.push_back(middle[axis] + side * along[axis]);
            edges.insert(edges.end(), {2 * i, 2 * i + 1});
        }
        step.m_end = step.m_cloth.m_positions;
        const std::vector<Contact> contacts = runNet(*pipeline, step, edges);
        std::vector<double> nearest(kSegments, std::numeric_limits<double>::infinity());
        for (const Contact& contact : contacts)
        {
            const ContactView view = pipeline->view(contact);
            double& own = nearest[std::size_t(view.m_nodes[0] / 2)];
            own = std::min(own, double(contact.m_gap1));
            atVertices += contact.m_kind == DRAPE_FACE_VERTEX;
        }
        for (std::size_t i = 0; i < kSegments; ++i)
        {
            const double least = distanceTo(step.m_obstacle, &step.m_cloth.m_positions[6 * i]);
            if (least < 1e-3 || least > double(kReach)) continue;
            ++near;
            EXPECT_NEAR(nearest[i], least, 1e-5) << "segment " << i;
        }
        pipeline->remove(pipeline->view(contacts[0]).m_cloth);
    }
    EXPECT_GT(near, 200);
    EXPECT_GT(atVertices, 50);
}

// Queries find the edges that meet an obstacle, or are near it, exactly, and name them as they were given.
TEST_P(LooseEdges, QueriesTakeThemTogetherWithTriangles)
{
    const std::unique_ptr<Queries> queries = makeQueries(GetParam().m_settings);
    ASSERT_TRUE(queries);
    StepCase step = fallingCase("torus", 16, 0.03f, 872);
    std::vector<std::int32_t> edges = unravel(step.m_cloth, 5);
    edges.insert(edges.begin(), {3, 3, edges[0], edges[1], edges[1], edges[0]});  // ignored, or the later ones are
    const std::size_t triangles = step.m_cloth.triangleCount();
    MeshDescription cloth = describeMesh(step.m_cloth);
    cloth.m_positions = step.m_end.data();
    cloth.m_edges = edges.data();
    cloth.m_edgeCount = edges.size() / 2;
    const MeshDescription obstacle = describeMesh(step.m_obstacle);
    MeshPairs found;
    ASSERT_TRUE(queries->meshPairs(cloth, &obstacle, 0.0f, found)) << queries->error().text();
    const auto cornersOf = [](const std::vector<float>& positions, std::int32_t a, std::int32_t b, std::int32_t c)
    {
        float corners[9];
        const std::int32_t vertices[3] = {a, b, c};
        for (std::size_t k = 0; k < 9; ++k)
            corners[k] = positions[3 * std::size_t(vertices[k / 3]) + k % 3];
        return exactTriangle(corners);
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected, reported;
    const Topology known = buildTopology(step.m_cloth.m_triangles.data(), triangles, step.m_cloth.vertexCount());
    std::set<std::pair<std::int32_t, std::int32_t>> seen;
    for (const Edge& edge : known.m_edges)
        seen.insert(std::minmax(std::int32_t(edge.m_vertices[0]), std::int32_t(edge.m_vertices[1])));
    for (std::size_t i = 0; i < triangles + cloth.m_edgeCount; ++i)
    {
        const std::int32_t* const v = i < triangles ? &step.m_cloth.m_triangles[3 * i] : &edges[2 * (i - triangles)];
        if (i >= triangles && (v[0] == v[1] || !seen.insert(std::minmax(v[0], v[1])).second)) continue;
        const ExactTriangle own = cornersOf(step.m_end, v[0], v[1], i < triangles ? v[2] : v[1]);
        for (std::size_t t = 0; t < step.m_obstacle.triangleCount(); ++t)
        {
            const std::int32_t* const w = &step.m_obstacle.m_triangles[3 * t];
            if (trianglesMeet(own, cornersOf(step.m_obstacle.m_positions, w[0], w[1], w[2])))
                expected.emplace_back(std::uint32_t(i), std::uint32_t(t));
        }
    }
    for (const NearTriangles& pair : found.m_intersecting)
        reported.emplace_back(pair.m_a, pair.m_b);
    EXPECT_EQ(reported, expected);
    EXPECT_GT(
        std::count_if(expected.begin(), expected.end(), [&](const auto& pair) { return pair.first >= triangles; }), 50);
}

// The rope collides with itself. It has no contacts at rest, and the crossing if it lies over itself.
TEST_P(LooseEdges, CollideWithThemselvesOnlyAtFolds)
{
    TriangleMesh rope;
    std::vector<std::int32_t> edges;
    constexpr int kLinks = 20;
    for (int i = 0; i <= kLinks; ++i)
    {
        const float p[3] = {0.01f * float(i), 0, 0};
        rope.m_positions.insert(rope.m_positions.end(), p, p + 3);
        if (i > 0) edges.insert(edges.end(), {i - 1, i});
    }
    std::vector<float> crossed = rope.m_positions;
    for (int i = 0; i <= kLinks; ++i)  // the second half goes back across the first one, above it
    {
        if (i <= kLinks / 2) continue;
        float* const p = &crossed[3 * std::size_t(i)];
        p[0] = 0.055f;
        p[1] = 0.004f;
        p[2] = 0.01f * float(i - 16);
    }
    MeshDescription description = describeMesh(rope);
    description.m_edges = edges.data();
    description.m_edgeCount = edges.size() / 2;
    description.m_selfThickness = 0.01f;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    const MeshId id = pipeline->addCloth(description);
    for (const bool folded : {false, true})
    {
        SCOPED_TRACE(folded);
        const std::vector<float>& places = folded ? crossed : rope.m_positions;
        setMotion(*pipeline, id, places, places);
        pipeline->addSelf(id);
        runStep(*pipeline);
        EXPECT_EQ(pipeline->statistics().m_selfContacts > 0, folded);
    }
}

INSTANTIATE_TEST_SUITE_P(Backend, LooseEdges, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
