// Rows 14 and 22 of the stress cases: fast obstacles through thin cloth, and features that meet more than once,
// collapse or move in one plane within a step.
#include <gtest/gtest.h>

#include <set>

#include "kernels/lib/ccd/ccd.h"
#include "scenes/cloth_grid.h"
#include "oracle/exact_predicates.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/cases.h"
#include "tests/support/oracle.h"
#include "scenes/describe_mesh.h"
#include "tests/support/self_cases.h"

namespace drape::test
{
namespace
{
constexpr float kStep = 1.0f / 60.0f;  // s

// Makes a cloth at rest and a plate 1 mm thick that flies through it at a speed, m/s. The plate's vertices come last.
SelfCase plateThroughCloth(float speed)
{
    SelfCase motion;
    motion.m_name = "plate at " + std::to_string(speed) + " m/s";
    motion.m_mesh = makeClothGrid(17, 17, 1.0f, 0.0f).m_mesh;
    TriangleMesh plate = makeBox(0.4f, 0.001f, 0.3f);
    // The plate's middle is at the cloth at 0.37 of the step.
    translate(plate.m_positions, 0.013f, 0.37f * speed * kStep, 0.021f);
    const std::int32_t first = std::int32_t(motion.m_mesh.vertexCount());
    motion.m_mesh.m_positions.insert(motion.m_mesh.m_positions.end(), plate.m_positions.begin(),
                                     plate.m_positions.end());
    for (std::int32_t index : plate.m_triangles)
        motion.m_mesh.m_triangles.push_back(first + index);
    motion.m_end = motion.m_mesh.m_positions;
    for (std::size_t i = 3 * std::size_t(first) + 1; i < motion.m_end.size(); i += 3)
        motion.m_end[i] -= speed * kStep;
    return motion;
}

struct FourPoints
{
    std::uint32_t m_kind;
    Vec3 m_start[4], m_end[4];
};

// Cases of row 22 with their true answers, and the time of the first touch.
struct NamedMotion
{
    const char* m_name;
    FourPoints m_points;
    bool m_touches;
    float m_time;
};

// Makes a hinge that swings about the y axis from slope -1 to slope 1, and a vertex at height z that moves along x
// against it. The vertex' height above the face is z - (2t - 1)². It is below at both ends of the step and above in
// between.
FourPoints hinge(float z)
{
    return {DRAPE_VERTEX_FACE,
            {vec3(-1, 0, z), vec3(-4, -4, 4), vec3(4, -4, -4), vec3(0, 8, 0)},
            {vec3(1, 0, z), vec3(-4, -4, -4), vec3(4, -4, 4), vec3(0, 8, 0)}};
}

// Makes a face whose second and third corners change places. In the middle of the step it is a segment along x.
FourPoints hourglass(Vec3 start, Vec3 end)
{
    return {DRAPE_VERTEX_FACE,
            {start, vec3(0, 0, 0), vec3(4, 4, 0), vec3(4, -4, 0)},
            {end, vec3(0, 0, 0), vec3(4, -4, 0), vec3(4, 4, 0)}};
}

// Makes a face that slides over a vertex at (x, y), everything in the plane z = 0.
FourPoints sliding(float x, float y)
{
    return {DRAPE_VERTEX_FACE,
            {vec3(x, y, 0), vec3(-6, -1, 0), vec3(-4, -1, 0), vec3(-5, 1, 0)},
            {vec3(x, y, 0), vec3(4, -1, 0), vec3(6, -1, 0), vec3(5, 1, 0)}};
}

// Makes two edges in the plane z = 0: the first rises from y = -2 to y = 2, the second goes from x0 to x1 at y = 0.
FourPoints edgesInPlane(float x0, float x1)
{
    return {DRAPE_EDGES,
            {vec3(-1, -2, 0), vec3(1, -2, 0), vec3(x0, 0, 0), vec3(x1, 0, 0)},
            {vec3(-1, 2, 0), vec3(1, 2, 0), vec3(x0, 0, 0), vec3(x1, 0, 0)}};
}

std::vector<NamedMotion> row22()
{
    return {
        {"in and out", hinge(0.25f), true, 0.25f},
        {"in and out, hardly", hinge(0.0001220703125f), true, 0.4944f},
        {"double root", hinge(0), true, 0.5f},
        {"no root", hinge(-0.001f), false, 1},
        {"hourglass, on the segment that the face becomes", hourglass(vec3(2, 0, 1), vec3(2, 0, -1)), true, 0.5f},
        {"hourglass, beside that segment", hourglass(vec3(2, 0.01f, 1), vec3(2, 0.01f, -1)), false, 1},
        {"hourglass, before it collapses", hourglass(vec3(2, 0.5f, 1), vec3(2, 0.5f, -3)), true, 0.25f},
        {"hourglass, in its plane at rest", hourglass(vec3(2, 1, 0), vec3(2, 1, 0)), true, 0},
        {"in one plane, swept over", sliding(0, 0), true, 0.45f},
        {"in one plane, at the tip", sliding(0, 1), true, 0.5f},
        {"in one plane, beyond the tip", sliding(0, 1.001f), false, 1},
        {"in one plane, beside the way", sliding(6.001f, -1), false, 1},
        {"edges in one plane", edgesInPlane(0.5f, 3), true, 0.5f},
        {"edges in one plane, at an end", edgesInPlane(1, 3), true, 0.5f},
        {"edges in one plane, apart", edgesInPlane(1.001f, 3), false, 1},
    };
}
}  // namespace

class Continuous : public BackendTest
{
protected:
    void SetUp() override
    {
        BackendTest::SetUp();
        if (HasFatalFailure() || IsSkipped()) return;
        m_queries = makeQueries(GetParam().m_settings);
        ASSERT_TRUE(m_queries);
    }

    std::unique_ptr<Queries> m_queries;
};

TEST_P(Continuous, Row14FastObstacleThroughThinCloth)
{
    for (float speed : {10.0f, 100.0f, 1000.0f})
    {
        const SelfCase motion = plateThroughCloth(speed);
        SCOPED_TRACE(motion.m_name);
        const std::uint32_t plate = std::uint32_t(motion.m_mesh.vertexCount()) - 8;
        MeshMotion found;
        ASSERT_TRUE(
            m_queries->meshMotion(describeMesh(motion.m_mesh), motion.m_end.data(), defaultCcdSettings(), found));
        std::set<std::uint32_t> passed, corners;
        for (const TouchingFeatures& touching : found.m_touching)
        {
            if (touching.m_kind != DRAPE_VERTEX_FACE) continue;
            const std::uint32_t vertex = touching.m_vertices[0];
            (vertex < plate ? passed : corners).insert(vertex);
            // The plate's lower or upper side meets the cloth.
            EXPECT_NEAR(touching.m_time, 0.37f, 0.51f * 0.001f / (speed * kStep) + 1e-4f);
        }
        // Counts every cloth vertex in the plate's path, and no other; each of the plate's corners passes the cloth.
        std::size_t inTheWay = 0;
        for (std::uint32_t vertex = 0; vertex < plate; ++vertex)
        {
            const float* p = &motion.m_mesh.m_positions[3 * vertex];
            const bool hit = std::fabs(p[0] - 0.013f) < 0.2f && std::fabs(p[2] - 0.021f) < 0.15f;
            inTheWay += hit;
            EXPECT_EQ(passed.count(vertex), std::size_t(hit)) << vertex;
        }
        EXPECT_GT(inTheWay, 20u);
        EXPECT_EQ(corners.size(), 8u);
        // Tests of the step's ends alone find nothing: nothing intersects there.
        for (const std::vector<float>* positions : {&motion.m_mesh.m_positions, &motion.m_end})
        {
            TriangleMesh frozen = motion.m_mesh;
            frozen.m_positions = *positions;
            MeshPairs pairs;
            ASSERT_TRUE(m_queries->meshPairs(describeMesh(frozen), nullptr, 0, pairs));
            EXPECT_EQ(pairs.m_intersecting.size(), 0u);
        }
    }
}

TEST_P(Continuous, Row22DoubleRootsHourglassesAndMotionInOnePlane)
{
    for (const NamedMotion& motion : row22())
    {
        SCOPED_TRACE(motion.m_name);
        CcdQuery query;
        query.m_kind = motion.m_points.m_kind;
        for (int i = 0; i < 12; ++i)
        {
            query.m_start[i] = (&motion.m_points.m_start[i / 3].x)[i % 3];
            query.m_end[i] = (&motion.m_points.m_end[i / 3].x)[i % 3];
        }
        CcdResult result;
        const CcdSettings settings = defaultCcdSettings();
        ASSERT_TRUE(m_queries->motions(&query, 1, settings, &result));
        EXPECT_EQ(result.m_hit != 0, motion.m_touches);
        if (!motion.m_touches) continue;
        // The time is never late. It is early by the tolerance of the time, or by the root of rounding if the approach
        // is a tangent.
        EXPECT_LE(result.m_time, motion.m_time + 1e-6f);
        EXPECT_GE(result.m_time, motion.m_time - 3 * settings.m_timeTolerance - 3e-3f);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Continuous, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
