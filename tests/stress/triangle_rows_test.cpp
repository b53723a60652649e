// Rows of the stress table that are about single triangles: each through a whole pipeline, on every back end.
// tests/README.md has the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/cloth_grid.h"
#include "scenes/describe_mesh.h"
#include "oracle/exact_predicates.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/mesh_pairs.h"
#include "tests/support/pair_batch.h"
#include "tests/support/self_cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kThickness = 0.01f;  // m

const Corners kFace = {0, 0, 0, 4, 0, 0, 0, 0, 4};

bool exactlyIntersect(const TrianglePair& pair)
{
    Vector3 a[3], b[3];
    for (std::size_t i = 0; i < 3; ++i)
    {
        a[i] = {pair.m_cloth[3 * i], pair.m_cloth[3 * i + 1], pair.m_cloth[3 * i + 2]};
        b[i] = {pair.m_obstacle[3 * i], pair.m_obstacle[3 * i + 1], pair.m_obstacle[3 * i + 2]};
    }
    return drape::trianglesIntersect(a, b);
}

// Returns true if the pair has a node-face or face-vertex contact with a gap of at most `gap` (m).
bool touchesWithin(const std::vector<Contact>& contacts, float gap)
{
    return std::any_of(contacts.begin(), contacts.end(),
                       [&](const Contact& contact)
                       { return contact.m_kind != DRAPE_EDGE_EDGE && std::fabs(contact.m_gap1) <= gap; });
}
}  // namespace

class StressRows : public BackendTest
{
protected:
    BatchResult run(const std::vector<TrianglePair>& pairs, float thickness = kThickness)
    {
        const BatchResult result = runBatch(GetParam().m_settings, pairs, thickness);
        expectFinite(result.m_all);
        return result;
    }
    void expectAllHit(const TrianglePair& pair)
    {
        const std::vector<TrianglePair> pairs = allOrders(pair);
        EXPECT_EQ(run(pairs).m_intersecting, pairs.size());
    }
    void expectNoneHit(const TrianglePair& pair) { EXPECT_EQ(run(allOrders(pair)).m_intersecting, 0u); }
};

TEST_P(StressRows, Row01CoplanarOverlappingAndDisjoint)
{
    const TrianglePair overlapping = {{0.5f, 0, 0.5f, 2, 0, 2, 0.5f, 0, 2}, kFace};
    const TrianglePair disjoint = {{4, 0, 4, 5, 0, 4, 4, 0, 5}, kFace};
    expectAllHit(overlapping);
    expectNoneHit(disjoint);
    for (const std::vector<Contact>& contacts : run(allOrders(overlapping)).m_contacts)
        EXPECT_TRUE(touchesWithin(contacts, 0.0f)) << "the cloth's nodes lie in the face";
    EXPECT_TRUE(run(allOrders(disjoint)).m_all.empty());
}

// The meshes are separate and have one vertex in common, two, or all.
TEST_P(StressRows, Row02SharedByPositionTouchesAtDistanceZero)
{
    const TrianglePair vertex = {{0, 0, 0, -1, 1, 0, -1, 1, -1}, kFace};
    const TrianglePair edge = {{0, 0, 0, 4, 0, 0, 2, 3, -1}, kFace};
    for (const TrianglePair& pair : {vertex, edge, TrianglePair{kFace, kFace}})
    {
        expectAllHit(pair);
        for (const std::vector<Contact>& contacts : run(allOrders(pair)).m_contacts)
        {
            EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(),
                                    [](const Contact& contact) { return std::fabs(contact.m_gap1) < 1e-6f; }));
        }
    }
}

namespace
{
// Makes the face and a second triangle in one mesh. The first `shared` of its corners are the face's, by index or by
// position only.
TriangleMesh twoTriangles(const Corners& second, std::int32_t shared, bool byIndex)
{
    std::vector<float> corners(kFace.begin(), kFace.end());
    corners.insert(corners.end(), second.begin(), second.end());
    TriangleMesh mesh = looseTriangles(corners);
    for (std::int32_t i = 0; byIndex && i < shared; ++i)
        mesh.m_triangles[std::size_t(3 + i)] = i;
    return mesh;
}

// Makes a step at rest of a cloth whose second triangle was far from its first before.
SelfStepCase restingOnItself(const TriangleMesh& mesh)
{
    SelfStepCase step = {{"two triangles", mesh, mesh.m_positions}, mesh.m_positions, kThickness};
    for (std::size_t vertex = 3; vertex < mesh.vertexCount(); ++vertex)
        step.m_rest[3 * vertex + 1] += 5.0f;
    return step;
}
}  // namespace

// Tests one mesh against itself. No query reports a crossing of triangles that share a vertex by index. Features that
// share one touch neither in a motion nor in a step. Features that share only a position do.
TEST_P(StressRows, Row02SharedByIndexIsSkipped)
{
    const std::unique_ptr<Queries> queries = makeQueries(GetParam().m_settings);
    ASSERT_TRUE(queries);
    const Corners acrossTheFace = {0, 0, 0, 2, 1, 1, 1, -1, 2}, alongAnEdge = {0, 0, 0, 4, 0, 0, 1, 1, 1};
    for (const std::int32_t shared : {1, 2})
    {
        const Corners& second = shared == 1 ? acrossTheFace : alongAnEdge;
        for (const bool byIndex : {true, false})
        {
            SCOPED_TRACE(std::to_string(shared) + (byIndex ? " by index" : " by position"));
            const TriangleMesh mesh = twoTriangles(second, shared, byIndex);
            const std::size_t pairs = byIndex ? 0 : 1;
            MeshPairs near;
            ASSERT_TRUE(queries->meshPairs(describeMesh(mesh), nullptr, kThickness, near));
            EXPECT_EQ(near.m_intersecting.size(), pairs);
            EXPECT_EQ(near.m_within.size(), pairs);
            MeshMotion motion;
            ASSERT_TRUE(queries->meshMotion(describeMesh(mesh), mesh.m_positions.data(), defaultCcdSettings(), motion));
            EXPECT_EQ(motion.m_touching.empty(), byIndex);
            const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
            ASSERT_TRUE(pipeline);
            EXPECT_EQ(runSelfCase(*pipeline, restingOnItself(mesh)).empty(), byIndex);
        }
    }
}

TEST_P(StressRows, Row03VertexExactlyOnAFaceInAllOrders)
{
    const TrianglePair touching = {{1, 0, 1, 1, 2, 2, 2, 3, 1}, kFace};
    expectAllHit(touching);
    for (const std::vector<Contact>& contacts : run(allOrders(touching)).m_contacts)
        EXPECT_TRUE(touchesWithin(contacts, 0.0f));
    // The second case is an obstacle's vertex on the cloth's face.
    expectAllHit({kFace, touching.m_cloth});
}

TEST_P(StressRows, Row04InTheOthersPlaneButOutside)
{
    expectNoneHit({{3, 0, 3, 3, 1, 3, 4, 1, 3}, kFace});
    expectNoneHit({{-1, 0, -1, -1, 1, -1, -2, -1, -2}, kFace});
    EXPECT_TRUE(run(allOrders({{3, 0, 3, 3, 1, 3, 4, 1, 3}, kFace})).m_all.empty());
}

TEST_P(StressRows, Row05NeedlesZeroAreasAndDuplicateVertices)
{
    const Corners needle = {1, -1, 1, 1, 1, 1, 1, 1, 1.001f},
                  thinnest = {1, -1, 1, 1, 1, 1, std::nextafter(1.0f, 2.0f), 1, 1};
    const Corners segment = {1, -1, 1, 1, 0.5f, 1, 1, 1, 1}, doubled = {1, -1, 1, 1, 1, 1, 1, 1, 1};
    const Corners point = {1, 0, 1, 1, 0, 1, 1, 0, 1};
    for (const Corners& shape : {needle, thinnest, segment, doubled, point})
    {
        expectAllHit({shape, kFace});
        expectAllHit({kFace, shape});
        Corners away = shape;
        for (std::size_t i = 0; i < 9; i += 3)
            away[i] -= 3;
        expectNoneHit({away, kFace});
        expectNoneHit({kFace, away});
    }
    // The shapes are near but do not touch: the segment's end and the point are within the thickness.
    for (const Corners& shape : {segment, doubled, point})
    {
        Corners above = shape;
        for (std::size_t i = 1; i < 9; i += 3)
            above[i] = std::max(above[i], 0.0f) + 0.5f * kThickness;
        for (const std::vector<Contact>& contacts : run(allOrders({above, kFace})).m_contacts)
            EXPECT_TRUE(touchesWithin(contacts, 0.5001f * kThickness));
    }
    // Random needles: none that truly meets the face is missed.
    Random random(1005);
    std::vector<TrianglePair> meeting;
    while (meeting.size() < 200)
    {
        TrianglePair pair = {{}, kFace};
        for (float& coordinate : pair.m_cloth)
            coordinate = random.uniform(-1, 3);
        const float width = std::pow(10.0f, random.uniform(-7, -3));
        for (std::size_t i = 0; i < 3; ++i)
            pair.m_cloth[6 + i] = pair.m_cloth[3 + i] + random.uniform(-width, width);
        if (exactlyIntersect(pair)) meeting.push_back(pair);
    }
    EXPECT_EQ(run(meeting).m_intersecting, meeting.size()) << "seed 1005";
}

// Uses the narrowest needles that only floats near zero can represent: 1e-8 m, around the origin.
TEST_P(StressRows, Row05NeedlesOfTenNanometresAtTheOrigin)
{
    constexpr float kWidth = 1e-8f;  // m
    const Corners around = {-1, 0, -1, 3, 0, -1, -1, 0, 3};
    const Corners upright = {0, -1, 0, 0, 1, 0, kWidth, 1, 0}, lying = {-0.5f, 0, 0, 0.5f, 0, 0, 0.5f, 0, kWidth},
                  tiny = {0, -kWidth, 0, 0, kWidth, 0, kWidth, kWidth, 0};
    for (const Corners& needle : {upright, lying, tiny})
    {
        for (const Corners& face : {around, kFace})  // over its middle, and at its corner
        {
            expectAllHit({needle, face});
            expectAllHit({face, needle});
        }
        Corners below = around;
        for (std::size_t i = 1; i < 9; i += 3)
            below[i] = -1.5f;
        expectNoneHit({needle, below});
        expectNoneHit({below, needle});
    }
    for (const Corners& needle : {lying, tiny})
    {
        Corners below = around;
        for (std::size_t i = 1; i < 9; i += 3)
            below[i] = -0.5f * kThickness;
        for (const std::vector<Contact>& contacts : run(allOrders({needle, below})).m_contacts)
            EXPECT_TRUE(touchesWithin(contacts, 0.5001f * kThickness));
    }
    // Random needles with their tips at the origin: none that truly meets the face is missed, with either of the two as
    // the cloth.
    Random random(1006);
    std::vector<TrianglePair> meeting, swapped;
    for (int tries = 0; tries < 1000; ++tries)
    {
        TrianglePair pair = {{}, around};
        for (std::size_t i = 0; i < 3; ++i)
        {
            pair.m_cloth[i] = random.uniform(-1, 1);
            pair.m_cloth[3 + i] = random.uniform(-10 * kWidth, 10 * kWidth);
            pair.m_cloth[6 + i] = pair.m_cloth[3 + i] + random.uniform(-kWidth, kWidth);
        }
        if (!exactlyIntersect(pair)) continue;
        meeting.push_back(pair);
        swapped.push_back({pair.m_obstacle, pair.m_cloth});
    }
    EXPECT_GT(meeting.size(), 300u);
    EXPECT_EQ(run(meeting).m_intersecting, meeting.size()) << "seed 1006";
    EXPECT_EQ(run(swapped).m_intersecting, swapped.size()) << "seed 1006";
}

// Zero and less is a hit, a proved distance none; in between either answer is good, but it is the same each time, and
// the contact within the thickness is there in any case.
TEST_P(StressRows, Row06GapOfOneUlp)
{
    Settings host;
    host.m_backend = Backend::Host;
    for (const float height : {1.0f, 1000.0f, 1e-3f})
    {
        SCOPED_TRACE(height);
        const float above = std::nextafter(height, 2 * height);
        const auto pairAt = [&](float cloth) {
            return TrianglePair{{1, cloth, 1, 2, cloth, 1, 1, cloth, 2}, {0, height, 0, 4, height, 0, 0, height, 4}};
        };
        expectAllHit(pairAt(height));
        expectNoneHit(pairAt(height + 1e-4f * std::max(4.0f, height)));
        const std::vector<TrianglePair> pairs = allOrders(pairAt(above));
        const BatchResult first = run(pairs), second = run(pairs), onHost = runBatch(host, pairs, kThickness);
        EXPECT_EQ(first.m_intersecting, second.m_intersecting);
        EXPECT_EQ(first.m_intersecting, onHost.m_intersecting);
        EXPECT_TRUE(sameBytes(first.m_all, second.m_all) && sameBytes(first.m_all, onHost.m_all));
        for (const std::vector<Contact>& contacts : first.m_contacts)
            EXPECT_TRUE(touchesWithin(contacts, 2 * (above - height)));
    }
}

// Five layers of 1 cm edges, 1 mm apart, each shifted and turned a little: nothing intersects, everything is near.
TEST_P(StressRows, Row07LayersOneMillimetreApart)
{
    const Settings settings = GetParam().m_settings;
    for (const float offset : {0.0f, 100.0f})
    {
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
        ASSERT_TRUE(pipeline);
        Random random(1007);
        SCOPED_TRACE("seed 1007, offset " + std::to_string(offset));
        const auto layer = [&](int number)
        {
            TriangleMesh mesh = makeClothGrid(21, 21, 0.2f, 0.001f * float(number)).m_mesh;
            translate(mesh.m_positions, offset + random.uniform(-0.01f, 0.01f), 0, random.uniform(-0.01f, 0.01f));
            return mesh;
        };
        const TriangleMesh lowest = layer(0);
        const MeshId obstacle = addObstacle(*pipeline, lowest);
        std::vector<TriangleMesh> layers;
        std::vector<MeshId> cloths;
        for (int i = 1; i < 5; ++i)
        {
            layers.push_back(layer(i));
            cloths.push_back(addCloth(*pipeline, layers.back()));
        }
        for (std::size_t i = 0; i < cloths.size(); ++i)
        {
            setMotion(*pipeline, cloths[i], layers[i].m_positions, layers[i].m_positions);
            pipeline->addPair(cloths[i], obstacle, 0.01f);
            EXPECT_TRUE(meshPairsOn(settings, layers[i], lowest, 0.0f).m_intersecting.empty());
        }
        expectFinite(runStep(*pipeline));
        EXPECT_GT(pipeline->statistics().m_contacts, 4u * 21 * 21 / 2);
        EXPECT_GT(pipeline->statistics().m_candidates, 4u * 800);
    }
}

TEST_P(StressRows, Row10TwoIdenticalMeshesMeetInEveryPair)
{
    const TriangleMesh mesh = makeSphere(0.5f, 2);
    std::vector<TrianglePair> pairs;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    {
        Corners corners;
        for (std::size_t i = 0; i < 3; ++i)
            std::copy_n(&mesh.m_positions[3 * std::size_t(mesh.m_triangles[3 * t + i])], 3, &corners[3 * i]);
        pairs.push_back({corners, corners});
    }
    EXPECT_EQ(run(pairs).m_intersecting, mesh.triangleCount());
}

TEST_P(StressRows, Row21ParallelAndCollinearEdges)
{
    // The edges lie on one line and overlap in part, wholly, or in one point, with faces to opposite sides.
    expectAllHit({{1, 0, 0, 3, 0, 0, 2, 1, -1}, kFace});
    expectAllHit({{-1, 0, 0, 5, 0, 0, 2, 1, -1}, kFace});
    expectAllHit({{4, 0, 0, 6, 0, 0, 5, 1, -1}, kFace});
    expectNoneHit({{4.01f, 0, 0, 6, 0, 0, 5, 1, -1}, kFace});
    // The edges are parallel, half a thickness apart.
    for (const std::vector<Contact>& contacts :
         run(allOrders({{1, 0, -0.005f, 3, 0, -0.005f, 2, 1, -1}, kFace})).m_contacts)
    {
        ASSERT_FALSE(contacts.empty());
        for (const Contact& contact : contacts)
            EXPECT_NEAR(contact.m_gap1, 0.005f, 1e-5f) << describe(contact);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, StressRows, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
