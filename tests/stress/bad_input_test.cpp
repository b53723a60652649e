// Nodes that are NaN, infinite, huge or denormal; cloths without extent; meshes that are empty or repeat themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/mesh_pairs.h"
#include "tests/support/pair_batch.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
const float kInfinity = std::numeric_limits<float>::infinity();
const float kNan = std::numeric_limits<float>::quiet_NaN();

// Returns true if a contact's cloth feature uses one of the nodes.
bool touches(const Pipeline& pipeline, const Contact& contact, const std::set<std::int32_t>& nodes)
{
    const ContactView view = pipeline.view(contact);
    for (std::int32_t node : view.m_nodes)
    {
        if (nodes.count(node)) return true;
    }
    return false;
}
// A triangle's local frame has its origin at a valid vertex: at another one positions of a metre round otherwise, by
// 2^-23 each, and a normal is a difference of them over some millimetres.
constexpr float kFrameRounding = 1e-3f;

// Returns true if the list has a contact of the same features, with a normal and gap within the tolerance.
bool contains(const std::vector<Contact>& contacts, const Contact& wanted, float tolerance = 0.0f)
{
    return std::any_of(contacts.begin(), contacts.end(),
                       [&](const Contact& contact)
                       {
                           if (contact.m_featureIndex != wanted.m_featureIndex ||
                               contact.m_obstacleFeature != wanted.m_obstacleFeature)
                               return false;
                           if (tolerance == 0.0f) return std::memcmp(&contact, &wanted, sizeof wanted) == 0;
                           float off = std::fabs(contact.m_gap1 - wanted.m_gap1);
                           for (int i = 0; i < 3; ++i)
                               off = std::max(off, std::fabs(contact.m_normal[i] - wanted.m_normal[i]));
                           return off <= tolerance;
                       });
}

// Returns true if a contact's obstacle feature uses one of the vertices.
bool usesVertex(const Side& obstacle, const Contact& contact, const std::set<std::uint32_t>& vertices)
{
    if (contact.m_kind == DRAPE_FACE_VERTEX) return vertices.count(contact.m_obstacleFeature) > 0;
    const bool edge = contact.m_kind == DRAPE_EDGE_EDGE;
    const std::uint32_t* first = edge ? obstacle.m_pool.edges()[contact.m_obstacleFeature].m_vertices
                                      : obstacle.m_pool.triangles()[contact.m_obstacleFeature].m_vertices;
    return std::any_of(first, first + (edge ? 2 : 3), [&](std::uint32_t vertex) { return vertices.count(vertex) > 0; });
}
}  // namespace

class BadInputTest : public BackendTest
{
protected:
    std::vector<Contact> run(const StepCase& step)
    {
        m_pipeline = makePipeline(GetParam().m_settings);
        if (!m_pipeline) return {};
        const std::vector<Contact> contacts = runCase(*m_pipeline, step);
        expectFinite(contacts);
        EXPECT_FALSE(m_pipeline->statistics().m_status & kStepDeviceFailed) << m_pipeline->lastError().text();
        return contacts;
    }

    std::unique_ptr<Pipeline> m_pipeline;
};

TEST_P(BadInputTest, NanAndInfiniteNodesAreIsolatedAndCounted)
{
    StepCase step = fallingCase("sphere", 20, 0.03f, 900);
    SCOPED_TRACE(step.trace());
    const std::vector<Contact> sound = run(step);
    EXPECT_EQ(m_pipeline->statistics().m_invalidNodes, 0u);
    const std::set<std::int32_t> bad = {0, 205, 210, 250};
    step.m_end[3 * 0] = kNan;
    step.m_end[3 * 205 + 1] = kInfinity;
    step.m_cloth.m_positions[3 * 210 + 2] = -kInfinity;
    step.m_cloth.m_positions[3 * 250] = kNan;
    const std::vector<Contact> contacts = run(step);
    EXPECT_EQ(m_pipeline->statistics().m_invalidNodes, bad.size());
    EXPECT_TRUE(m_pipeline->statistics().m_status & kStepInvalidNodes);
    for (const Contact& contact : contacts)
        EXPECT_FALSE(touches(*m_pipeline, contact, bad)) << describe(contact);
    // No other contact is lost, whichever triangle owns it, and no other contact changes.
    std::size_t kept = 0;
    for (const Contact& contact : sound)
    {
        if (touches(*m_pipeline, contact, bad)) continue;
        ++kept;
        EXPECT_TRUE(contains(contacts, contact)) << describe(contact);
    }
    EXPECT_GT(kept, sound.size() / 2);
    EXPECT_LT(kept, sound.size());
    // New contacts belong to faces beside a bad one, whose neighbour took the contact at their common edge.
    for (const Contact& contact : contacts)
    {
        EXPECT_TRUE(contact.m_kind == DRAPE_FACE_VERTEX || contains(sound, contact)) << describe(contact);
    }
    EXPECT_LT(m_pipeline->statistics().m_candidates, 100000u);
}

TEST_P(BadInputTest, EveryNodeInvalid)
{
    StepCase step = fallingCase("sphere", 10, 0.03f, 901);
    SCOPED_TRACE(step.trace());
    for (float value : {kNan, kInfinity, -kInfinity})
    {
        step.m_end.assign(step.m_end.size(), value);
        EXPECT_TRUE(run(step).empty());
        EXPECT_EQ(m_pipeline->statistics().m_invalidNodes, step.m_cloth.vertexCount());
        EXPECT_EQ(m_pipeline->statistics().m_candidates, 0u);
    }
}

TEST_P(BadInputTest, InvalidObstacleVerticesAreIsolated)
{
    StepCase step = fallingCase("sphere", 20, 0.03f, 902);
    SCOPED_TRACE(step.trace());
    const std::vector<Contact> sound = run(step);
    // The cloth touches the two nodes.
    std::set<std::uint32_t> bad;
    for (std::size_t i = 0; i < sound.size() && bad.size() < 2; i += 7)
    {
        if (sound[i].m_kind == DRAPE_FACE_VERTEX) bad.insert(sound[i].m_obstacleFeature);
    }
    ASSERT_EQ(bad.size(), 2u);
    step.m_obstacle.m_positions[3 * *bad.begin()] = kNan;
    step.m_obstacle.m_positions[3 * *bad.rbegin() + 1] = kInfinity;
    const std::vector<Contact> contacts = run(step);
    const Side obstacle = makeSide({step.m_obstacle});
    std::size_t kept = 0;
    for (const Contact& contact : sound)
    {
        if (usesVertex(obstacle, contact, bad)) continue;
        ++kept;
        EXPECT_TRUE(contains(contacts, contact, kFrameRounding)) << describe(contact);
    }
    EXPECT_GT(kept, sound.size() / 2);
    for (const Contact& contact : contacts)
        EXPECT_FALSE(usesVertex(obstacle, contact, bad)) << describe(contact);
    EXPECT_LT(m_pipeline->statistics().m_candidates, 100000u);
}

TEST_P(BadInputTest, HugeAndDenormalNodesStayFinite)
{
    for (float value : {1e38f, -1e38f, 3.4e38f, 1e20f, -1.1e9f, 1e9f, -1e6f, 1e-40f, -1e-45f})
    {
        SCOPED_TRACE("seed 903, value " + std::to_string(value));
        StepCase step = fallingCase("sphere", 20, 0.03f, 903);
        for (std::size_t at : {0u, 600u, 601u, 602u, 700u})
            step.m_end[at] = value;
        const std::vector<Contact> contacts = run(step);
        EXPECT_GT(contacts.size(), 100u);
        // Nodes farther out than a million kilometres count as invalid: three nodes.
        EXPECT_EQ(m_pipeline->statistics().m_invalidNodes, std::fabs(value) > DRAPE_FARTHEST ? 3u : 0u);
    }
}

TEST_P(BadInputTest, ClothCollapsedToAPointOrALine)
{
    for (bool line : {false, true})
    {
        for (float height : {0.51f, 0.49f})
        {
            StepCase step = fallingCase("sphere", 12, 0.03f, 904);
            SCOPED_TRACE(step.trace());
            for (std::size_t node = 0; node < step.m_cloth.vertexCount(); ++node)
            {
                const float x = line ? 0.001f * float(node) : 0.0f;
                for (std::vector<float>* positions : {&step.m_cloth.m_positions, &step.m_end})
                {
                    float* p = &(*positions)[3 * node];
                    p[0] = x;
                    p[1] = positions == &step.m_end ? height : 0.55f;
                    p[2] = 0.0f;
                }
            }
            // Every node is near the pole or below it.
            std::set<std::uint32_t> nodes;
            for (const Contact& contact : run(step))
            {
                if (contact.m_kind == DRAPE_NODE_FACE) nodes.insert(contact.m_clothFeature);
            }
            EXPECT_GE(nodes.size(), line ? 20u : step.m_cloth.vertexCount());
        }
    }
}

TEST_P(BadInputTest, EmptyAndTinyMeshes)
{
    const TriangleMesh one = looseTriangles({-1, 0, -1, 1, 0, -1, 0, 0, 1});
    TriangleMesh two = looseTriangles({-1, 0, -1, 1, 0, -1, 0, 0, 1, 0, 0, -3});
    two.m_triangles = {0, 1, 2, 1, 0, 3};
    TriangleMesh unused = looseTriangles({9, 9, 9, -1, 0, -1, 1, 0, -1, 0, 0, 1, 7, 7, 7});
    unused.m_triangles = {1, 2, 3};
    TriangleMesh repeated = one;
    repeated.m_triangles = {0, 0, 1};
    const TriangleMesh meshes[] = {one, two, unused, TriangleMesh(), repeated};
    constexpr int kWithTriangles = 3;  // the first meshes have triangles
    for (int i = 0; i < 5; ++i)
    {
        for (int j = 0; j < 5; ++j)
        {
            const TriangleMesh &cloth = meshes[i], &obstacle = meshes[j];
            StepCase step = {"tiny meshes", 0, cloth, obstacle, cloth.m_positions, 0.1f};
            translate(step.m_cloth.m_positions, 0.05f, 0.2f, 0.0f);
            translate(step.m_end, 0.05f, 0.04f, 0.0f);
            const std::vector<Contact> contacts = run(step);
            EXPECT_EQ(contacts.empty(), i >= kWithTriangles || j >= kWithTriangles);
            // The features are 4 cm above each other, or beside each other's border and farther, up to one and a half
            // thicknesses.
            for (const Contact& contact : contacts)
            {
                EXPECT_TRUE(contact.m_gap1 > 0.0399f && contact.m_gap1 < 0.1501f) << describe(contact);
            }
        }
    }
}

// Vertices of no triangle all about, on both sides: as many candidates as without them.
TEST_P(BadInputTest, UnusedVerticesWidenNoVolume)
{
    const StepCase step = fallingCase("sphere", 16, 0.03f, 905);
    SCOPED_TRACE(step.trace());
    StepCase strewn = step;
    Random random(905);
    for (std::vector<float>* positions : {&strewn.m_obstacle.m_positions, &strewn.m_cloth.m_positions, &strewn.m_end})
        for (int i = 0; i < 3 * 50; ++i)
            positions->push_back(random.uniform(-5, 5));
    const std::size_t contacts = run(step).size();
    ASSERT_TRUE(m_pipeline);
    const std::size_t candidates = m_pipeline->statistics().m_candidates;
    EXPECT_GT(contacts, 100u);
    EXPECT_EQ(run(strewn).size(), contacts);
    ASSERT_TRUE(m_pipeline);
    EXPECT_EQ(m_pipeline->statistics().m_candidates, candidates);
}

// A triangle with a corner outside of the valid range is in no pair, wherever its other corners are.
TEST_P(BadInputTest, TrianglesWithAnInvalidCornerAreInNoPair)
{
    const TriangleMesh sound = looseTriangles({-1, 0, -1, 1, 0, -1, 0, 0, 1});
    for (const float value : {kNan, kInfinity, -1.1e9f, -3e38f})
    {
        SCOPED_TRACE(value);
        // The triangle's two other corners are on either side of the sound triangle, in it, and away from it.
        for (const float height : {-0.5f, 0.0f, 5.0f})
        {
            const TriangleMesh broken = looseTriangles({value, 1, 0, 0, height, 0, 0, 0.5f, 0});
            for (const bool swapped : {false, true})
            {
                const MeshPairs found = swapped ? meshPairsOn(GetParam().m_settings, broken, sound, 0.1f)
                                                : meshPairsOn(GetParam().m_settings, sound, broken, 0.1f);
                EXPECT_TRUE(found.m_within.empty() && found.m_intersecting.empty());
            }
        }
    }
}

TEST_P(BadInputTest, TwoIdenticalMeshes)
{
    const TriangleMesh mesh = makeSphere(0.5f, 2);
    StepCase step = {"identical meshes", 0, mesh, mesh, mesh.m_positions, 0.01f};
    const Settings settings = GetParam().m_settings;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
    ASSERT_TRUE(pipeline);
    const std::vector<Contact> contacts = runCase(*pipeline, step);
    expectFinite(contacts);
    // Each triangle meets itself and those around its corners, and no others.
    const std::vector<NearTriangles> meeting = meetingPairs(mesh, mesh);
    ASSERT_GT(meeting.size(), 10 * mesh.triangleCount());
    EXPECT_TRUE(sameBytes(meshPairsOn(settings, mesh, mesh, 0.0f).m_intersecting, meeting));
    std::set<std::uint32_t> nodes;
    for (const Contact& contact : contacts)
    {
        if (contact.m_kind == DRAPE_NODE_FACE) nodes.insert(contact.m_clothFeature);
    }
    EXPECT_EQ(nodes.size(), mesh.vertexCount());
}

INSTANTIATE_TEST_SUITE_P(Backends, BadInputTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
