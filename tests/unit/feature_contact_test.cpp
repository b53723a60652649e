// Named cases of kernels/lib/narrow_phase/feature_contact.h: what is reported, with which normal, gaps, weights and
// time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kReach = 0.1f;

struct Step
{
    Side m_cloth, m_obstacle;
};

Step makeStep(const TriangleMesh& cloth, const std::vector<float>& end, const TriangleMesh& obstacle)
{
    Step step = {makeSide({cloth}), makeSide({obstacle})};
    step.m_cloth.m_end = end;
    return step;
}

std::vector<Contact> contacts(const Step& step, std::uint32_t kind, float reach = kReach)
{
    std::vector<Contact> found;
    for (const Contact& contact : contactsOfAllPairs(step.m_cloth, step.m_obstacle, reach))
    {
        for (int i = 0; i < 3; ++i)
        {
            EXPECT_TRUE(std::isfinite(contact.m_normal[i]) && std::isfinite(contact.m_point[i]) &&
                        std::isfinite(contact.m_weights[i]));
        }
        if (contact.m_kind == kind) found.push_back(contact);
    }
    return found;
}

// Times are no later than the true one, and earlier by twice the tolerance at most: a hundredth of the reach along the
// way (feature_meeting.h).
void expectTime(const Contact& contact, float time, float way)
{
    EXPECT_LE(contact.m_time, time);
    EXPECT_GT(contact.m_time, time == 1.0f ? 0.99999f : time - 2.05f * 0.01f * kReach / way);
}

void expectNormal(const Contact& contact, float x, float y, float z)
{
    EXPECT_NEAR(contact.m_normal[0], x, 1e-6f);
    EXPECT_NEAR(contact.m_normal[1], y, 1e-6f);
    EXPECT_NEAR(contact.m_normal[2], z, 1e-6f);
}

// Makes a large face in the plane y = 0, counter-clockwise seen from above.
TriangleMesh floorTriangle()
{
    return looseTriangles({-4, 0, 4, 4, 0, 4, 0, 0, -4});
}
// Makes a small triangle whose node 0 hangs lowest, at height y.
std::vector<float> hangingTriangle(float y)
{
    return {0, y, 0, 1, y + 1, 0, 0, y + 1, 1};
}
}  // namespace

// A face fifty times as long as it is wide is not thin yet, but its closest point to where a path went through it may
// slide along it by more than the seam.
TEST(FeatureContact, NodesThatWentThroughALongFaceMetIt)
{
    Random random(880);
    for (int i = 0; i < 20000; ++i)
    {
        SCOPED_TRACE(i);
        const float length = random.uniform(1.0f, 2.0f), width = length * random.uniform(0.0202f, 0.05f);
        const float shift = random.uniform(0.0f, 1.0f) * length, rise = random.uniform(-0.5f, 0.5f);
        const float turn = random.uniform(0.0f, 3.14f), cosine = std::cos(turn), sine = std::sin(turn);
        const float corners[3][2] = {{-1.0f, 0}, {length - 1.0f, 0}, {shift - 1.0f, width}};
        std::vector<float> face;
        for (std::uint32_t k = 0, first = random.below(3); k < 3; ++k)
        {
            const float* const corner = corners[(first + k) % 3];
            face.insert(face.end(), {corner[0], corner[1] * cosine + rise * corner[0], corner[1] * sine});
        }
        const float weights[3] = {random.uniform(0.05f, 1.0f), random.uniform(0.05f, 1.0f),
                                  random.uniform(0.05f, 1.0f)};
        const float sum = weights[0] + weights[1] + weights[2];
        float hit[3] = {0, 0, 0};
        for (std::size_t k = 0; k < 9; ++k)
            hit[k % 3] += weights[k / 3] / sum * face[k];
        // The node goes through the face, across its plane, and to within the reach on the other side.
        const float normal[3] = {rise * sine, -sine, cosine};
        std::vector<float> start, end;
        for (const float aside : {0.0f, 0.3f, 0.6f})
        {
            for (int axis = 0; axis < 3; ++axis)
            {
                start.push_back(hit[axis] + aside + 0.1f * normal[axis]);
                end.push_back(hit[axis] + aside - 0.03f * normal[axis]);
            }
        }
        const std::vector<Contact> found =
            contacts(makeStep(looseTriangles(start), end, looseTriangles(face)), DRAPE_NODE_FACE);
        const auto ofFirst = std::find_if(found.begin(), found.end(),
                                          [](const Contact& contact) { return contact.m_clothFeature == 0; });
        ASSERT_NE(ofFirst, found.end());
        ASSERT_LT(ofFirst->m_time, 1.0f);
        ASSERT_GT(ofFirst->m_gap0, 0.0f) << "the side that it came from";
    }
}

TEST(NodeFace, NearAtTheEndOfTheStep)
{
    const Step step = makeStep(looseTriangles(hangingTriangle(0.5f)), hangingTriangle(0.05f), floorTriangle());
    const std::vector<Contact> found = contacts(step, DRAPE_NODE_FACE);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].m_clothFeature, 0u);
    expectNormal(found[0], 0, 1, 0);
    EXPECT_NEAR(found[0].m_gap0, 0.5f, 1e-6f);
    EXPECT_NEAR(found[0].m_gap1, 0.05f, 1e-6f);
    EXPECT_EQ(found[0].m_time, 1.0f);
    EXPECT_EQ(found[0].m_weights[0], 1.0f);
    EXPECT_NEAR(found[0].m_point[1], 0.0f, 1e-6f);
}

TEST(NodeFace, PassesFromAboveAndFromBelow)
{
    for (float side : {1.0f, -1.0f})
    {
        std::vector<float> start = hangingTriangle(0.3f), end = hangingTriangle(-0.6f);
        for (std::size_t i = 1; i < 9; i += 3)
        {
            start[i] *= side;
            end[i] *= side;
        }
        const std::vector<Contact> found =
            contacts(makeStep(looseTriangles(start), end, floorTriangle()), DRAPE_NODE_FACE);
        ASSERT_EQ(found.size(), 1u);
        expectNormal(found[0], 0, side, 0);
        EXPECT_NEAR(found[0].m_gap0, 0.3f, 1e-6f);
        EXPECT_NEAR(found[0].m_gap1, -0.6f, 1e-6f);
        EXPECT_NEAR(found[0].m_time, 1.0f / 3, 1e-6f);
    }
}

TEST(NodeFace, PathBesideTheFaceIsNone)
{
    std::vector<float> start = hangingTriangle(0.3f), end = hangingTriangle(-0.6f);
    translate(start, 20, 0, 0);
    translate(end, 20, 0, 0);
    EXPECT_TRUE(contacts(makeStep(looseTriangles(start), end, floorTriangle()), DRAPE_NODE_FACE).empty());
}

TEST(NodeFace, ReachIsTheBorder)
{
    for (float height : {0.0999f, 0.1001f})
    {
        const Step step = makeStep(looseTriangles(hangingTriangle(height)), hangingTriangle(height), floorTriangle());
        EXPECT_EQ(contacts(step, DRAPE_NODE_FACE).size(), height < kReach ? 1u : 0u) << height;
    }
}

// Paths through the diagonal that two faces share, and through the vertex that six share: never between them.
TEST(NodeFace, PathsThroughSeamsAreCaught)
{
    const TriangleMesh floor = makeClothGrid(5, 5, 4.0f, 0.0f).m_mesh;
    Random random(17);
    for (int i = 0; i < 3000; ++i)
    {
        SCOPED_TRACE("seed 17, path " + std::to_string(i));
        // The node is on a grid line or a grid point, approached at a slant.
        const float x = i % 3 == 0 ? 0.0f : i % 3 == 1 ? random.uniform(-1.9f, 1.9f) : float(random.below(3)) - 1.0f;
        const float z = i % 3 == 1 ? 0.0f : i % 3 == 0 ? random.uniform(-1.9f, 1.9f) : float(random.below(3)) - 1.0f;
        const float dx = random.uniform(-1, 1), dz = random.uniform(-1, 1), t = random.uniform(0.1f, 0.9f);
        std::vector<float> start = hangingTriangle(0), end = hangingTriangle(0);
        translate(start, x - t * dx, t, z - t * dz);
        translate(end, x + (1 - t) * dx, t - 1, z + (1 - t) * dz);
        int caught = 0;
        for (const Contact& contact : contacts(makeStep(looseTriangles(start), end, floor), DRAPE_NODE_FACE, 0.01f))
        {
            if (contact.m_clothFeature != 0) continue;
            ++caught;
            EXPECT_GT(contact.m_normal[1], 0.99f);
            EXPECT_LT(contact.m_gap1, 0.0f);
        }
        ASSERT_GE(caught, 1);
    }
}

// A node over a flat floor of many faces has one contact, with the face below it. The neighbours' edges are nearer to
// no other point than the face, so their cones reject the node.
TEST(NodeFace, ConesRejectNeighboursOnAFlatFloor)
{
    const TriangleMesh floor = makeClothGrid(9, 9, 0.8f, 0.0f).m_mesh;
    Random random(18);
    for (int i = 0; i < 300; ++i)
    {
        SCOPED_TRACE("seed 18, node " + std::to_string(i));
        std::vector<float> start = hangingTriangle(0.05f);
        // Farther from every edge of the floor than the cones' two degrees reach at this height, 1.8 mm.
        translate(start, 0.1f * float(random.below(6)) - 0.25f + random.uniform(0.01f, 0.04f), 0,
                  0.1f * float(random.below(6)) - 0.25f + random.uniform(-0.005f, 0.005f));
        std::size_t own = 0;
        for (const Contact& contact : contacts(makeStep(looseTriangles(start), start, floor), DRAPE_NODE_FACE))
        {
            own += contact.m_clothFeature == 0;
            EXPECT_GT(contact.m_normal[1], 0.999f);
        }
        ASSERT_EQ(own, 1u);
    }
}

TEST(NodeFace, ConvexEdgeAndCornerPushOutward)
{
    const TriangleMesh box = makeBox(1, 1, 1);
    const float at = 0.53f;
    for (bool corner : {false, true})
    {
        std::vector<float> start = {at, at, corner ? at : 0.1f, 2, 2, 0, 2, 3, 1};
        const std::vector<Contact> found = contacts(makeStep(looseTriangles(start), start, box), DRAPE_NODE_FACE);
        ASSERT_FALSE(found.empty());
        const float expected = 1 / std::sqrt(corner ? 3.0f : 2.0f);
        for (const Contact& contact : found)
        {
            EXPECT_NEAR(contact.m_normal[0], expected, 1e-5f);
            EXPECT_NEAR(contact.m_normal[1], expected, 1e-5f);
            EXPECT_NEAR(contact.m_gap1, 0.03f / expected, 1e-6f);
        }
    }
}

TEST(FaceVertex, FaceComesToRestOverAnApexAndPassesIt)
{
    // A pyramid whose apex points up; the cloth is one large horizontal face that comes from above.
    TriangleMesh pyramid = looseTriangles({-1, -2, -1, 1, -2, -1, 1, -2, 1, -1, -2, 1, 0, 0, 0});
    pyramid.m_triangles = {1, 0, 4, 2, 1, 4, 3, 2, 4, 0, 3, 4, 0, 1, 2, 0, 2, 3};
    for (float endHeight : {0.04f, -0.2f})
    {
        TriangleMesh cloth = floorTriangle();
        translate(cloth.m_positions, 0, 0.3f, 0);
        std::vector<float> end = cloth.m_positions;
        translate(end, 0, endHeight - 0.3f, 0);
        const std::vector<Contact> found = contacts(makeStep(cloth, end, pyramid), DRAPE_FACE_VERTEX);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].m_obstacleFeature, 4u);
        expectNormal(found[0], 0, 1, 0);
        EXPECT_NEAR(found[0].m_gap0, 0.3f, 1e-5f);
        EXPECT_NEAR(found[0].m_gap1, endHeight, 1e-5f);
        expectTime(found[0], endHeight < 0 ? 0.6f : 1.0f, 0.5f);
        EXPECT_NEAR(found[0].m_weights[0] + found[0].m_weights[1] + found[0].m_weights[2], 1.0f, 1e-6f);
        EXPECT_NEAR(found[0].m_weights[2], 0.5f, 1e-5f);
    }
}

TEST(EdgeEdge, EdgeComesToRestOverARidgeAndPassesIt)
{
    // A roof with its ridge along x; the cloth's edge 0-1 along z comes from above, its third node high up.
    TriangleMesh roof = looseTriangles({-2, 0, 0, 2, 0, 0, 0, -2, 2, 0, -2, -2});
    roof.m_triangles = {1, 0, 2, 0, 1, 3};
    for (float endHeight : {0.06f, -0.1f})
    {
        const TriangleMesh cloth = looseTriangles({0.25f, 0.2f, -1, 0.25f, 0.2f, 1, 0.25f, 3, 0});
        std::vector<float> end = cloth.m_positions;
        translate(end, 0, endHeight - 0.2f, 0);
        const std::vector<Contact> found = contacts(makeStep(cloth, end, roof), DRAPE_EDGE_EDGE);
        ASSERT_EQ(found.size(), 1u);
        expectNormal(found[0], 0, 1, 0);
        EXPECT_NEAR(found[0].m_gap0, 0.2f, 1e-5f);
        EXPECT_NEAR(found[0].m_gap1, endHeight, 1e-5f);
        expectTime(found[0], endHeight < 0 ? 2.0f / 3 : 1.0f, 0.3f);
        EXPECT_NEAR(found[0].m_weights[0], 0.5f, 1e-5f);
        EXPECT_NEAR(found[0].m_point[0], 0.25f, 1e-5f);
    }
}

TEST(Degenerate, ZeroAreasGiveFiniteContactsOnTheRightSide)
{
    const TriangleMesh slivers[] = {looseTriangles({-1, 0, 0, 0, 0, 0, 1, 0, 0}),
                                    looseTriangles({0, 0, 0, 0, 0, 0, 0, 0, 0}),
                                    looseTriangles({-1, 0, 0, 1, 0, 0, -1, 0, 1e-8f})};
    for (const TriangleMesh& sliver : slivers)
    {
        std::vector<float> node = hangingTriangle(0.05f);
        for (const Contact& contact : contacts(makeStep(looseTriangles(node), node, sliver), DRAPE_NODE_FACE))
        {
            EXPECT_GT(contact.m_normal[1], 0.99f);
            EXPECT_NEAR(contact.m_gap1, 0.05f, 1e-4f);
        }
        EXPECT_FALSE(contacts(makeStep(looseTriangles(node), node, sliver), DRAPE_NODE_FACE).empty());
        // The roles are exchanged: the cloth is the sliver.
        contacts(makeStep(sliver, sliver.m_positions, floorTriangle()), DRAPE_FACE_VERTEX);
    }
}

// Floats represent squares of lengths below 1e-18 m badly, or not at all.
TEST(Degenerate, NormalsAreUnitWhereSquaresOfDistancesAreDenormal)
{
    std::size_t found = 0;
    for (float scale : {1e-16f, 1e-19f, 1e-21f, 1e-22f})
    {
        StepCase step = soupCase(60, 60, true, 19);
        SCOPED_TRACE(step.trace() + ", times " + std::to_string(std::log10(scale)));
        for (std::vector<float>* positions : {&step.m_cloth.m_positions, &step.m_end, &step.m_obstacle.m_positions})
            for (float& coordinate : *positions)
                coordinate *= scale;
        const Step sides = makeStep(step.m_cloth, step.m_end, step.m_obstacle);
        for (const Contact& contact : contactsOfAllPairs(sides.m_cloth, sides.m_obstacle, kReach))
        {
            const float* n = contact.m_normal;
            ASSERT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1.0f, 1e-5f) << describe(contact);
            ++found;
        }
    }
    EXPECT_GT(found, 1000u);
}
}  // namespace drape::test
