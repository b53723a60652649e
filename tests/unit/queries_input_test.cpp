// Queries that cannot be answered are refused with an error that names the call; what is usable is answered after.
#include <gtest/gtest.h>

#include <limits>

#include "drape/queries.h"
#include "scenes/describe_mesh.h"
#include "scenes/shapes.h"

namespace drape::test
{
namespace
{
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class QueriesInput : public testing::Test
{
protected:
    void SetUp() override
    {
        Settings settings;
        settings.m_backend = Backend::Host;
        Error error;
        m_queries = Queries::create(settings, error);
        ASSERT_TRUE(m_queries) << error.text();
    }

    void expectRefused(bool answered, const std::string& text)
    {
        EXPECT_FALSE(answered);
        EXPECT_EQ(m_queries->error().m_call.rfind(text, 0), 0u) << m_queries->error().m_call;
    }

    std::unique_ptr<Queries> m_queries;
};
}  // namespace

TEST_F(QueriesInput, BadSettingsAreRefused)
{
    Settings settings;
    settings.m_backend = Backend(7);
    Error error;
    EXPECT_FALSE(Queries::create(settings, error));
    EXPECT_EQ(error.m_call.rfind("Settings::m_backend", 0), 0u) << error.text();
}

TEST_F(QueriesInput, BadMotionsAreRefused)
{
    CcdQuery query = {};
    CcdResult result = {};
    const CcdSettings settings = defaultCcdSettings();
    expectRefused(m_queries->motions(nullptr, 1, settings, &result), "motions: an array");
    expectRefused(m_queries->motions(&query, 1, settings, nullptr), "motions: an array");
    query.m_kind = 7;
    expectRefused(m_queries->motions(&query, 1, settings, &result), "motions: a query with an unknown kind");
    query.m_kind = DRAPE_EDGES;
    for (const float bad : {-1.0f, kNaN, kInfinity})
    {
        CcdSettings wrong = settings;
        wrong.m_separation = bad;
        expectRefused(m_queries->motions(&query, 1, wrong, &result), "motions: CcdSettings");
        wrong = settings;
        wrong.m_timeTolerance = bad;
        expectRefused(m_queries->motions(&query, 1, wrong, &result), "motions: CcdSettings");
    }
    EXPECT_TRUE(m_queries->motions(&query, 1, settings, &result));
    EXPECT_EQ(result.m_hit, 1u);  // all four vertices are in one place
    EXPECT_TRUE(m_queries->motions(nullptr, 0, settings, nullptr));
}

TEST_F(QueriesInput, BadTrianglesAreRefused)
{
    const TriangleQuery query = {};
    std::uint32_t result = 0;
    expectRefused(m_queries->triangles(nullptr, 1, TriangleTest::Exact, &result), "triangles: an array");
    expectRefused(m_queries->triangles(&query, 1, TriangleTest::Exact, nullptr), "triangles: an array");
    expectRefused(m_queries->triangles(&query, 1, TriangleTest(7), &result), "triangles: an unknown test");
    EXPECT_TRUE(m_queries->triangles(nullptr, 0, TriangleTest::Exact, nullptr));
}

TEST_F(QueriesInput, BadMeshesAreRefused)
{
    const TriangleMesh sphere = makeSphere(0.5f, 1);
    const MeshDescription mesh = describeMesh(sphere);
    MeshPairs pairs;
    for (const float bad : {-0.1f, kNaN, kInfinity})
        expectRefused(m_queries->meshPairs(mesh, nullptr, bad, pairs), "meshPairs: a radius");
    MeshDescription half = mesh;
    half.m_positions = nullptr;
    expectRefused(m_queries->meshPairs(mesh, &half, 0.1f, pairs), "meshPairs: a mesh without");
    half = mesh;
    half.m_triangles = nullptr;
    expectRefused(m_queries->meshPairs(half, nullptr, 0.1f, pairs), "meshPairs: a mesh without");
    MeshMotion motion;
    expectRefused(m_queries->meshMotion(mesh, nullptr, defaultCcdSettings(), motion), "meshMotion: an array");
    EXPECT_TRUE(m_queries->meshMotion(mesh, mesh.m_positions, defaultCcdSettings(), motion));
    EXPECT_TRUE(m_queries->meshPairs(mesh, &mesh, 0.0f, pairs));
    EXPECT_GT(pairs.m_intersectingCount, 0u);
}
}  // namespace drape::test
