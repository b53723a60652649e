// The published queries with exact answers, on every back end: nothing missed, few false hits.
//
// The data and what happens without it: tests/support/published_data.h.
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "scenes/mesh_loader.h"
#include "tests/support/backends.h"
#include "scenes/describe_mesh.h"
#include "scenes/query_records.h"
#include "tests/support/published_data.h"
#include "tests/support/self_cases.h"

namespace drape::test
{
namespace
{
// Layers 1 mm apart: the twelfth of the sets of 4,000 that follow the first 10,000 pairs.
constexpr std::size_t kLayersFirst = 10000 + 11 * 4000, kLayersLast = kLayersFirst + 4000;

struct Score
{
    std::size_t m_true = 0, m_missed = 0, m_false = 0;

    void add(bool truth, bool hit)
    {
        m_true += truth;
        m_missed += truth && !hit;
        m_false += hit && !truth;
    }
};

// The position of a vertex at the step's start and end.
using Place = std::array<float, 6>;

Place placeOf(const float* start, const float* end)
{
    return {start[0], start[1], start[2], end[0], end[1], end[2]};
}

// A pair of features by its vertices' places, each feature's sorted.
using PlacedPair = std::array<std::set<Place>, 2>;

PlacedPair placed(std::uint32_t kind, const Place places[4])
{
    const int split = kind == DRAPE_VERTEX_FACE ? 1 : 2;
    PlacedPair pair;
    for (int i = 0; i < 4; ++i)
        pair[i < split ? 0 : 1].insert(places[i]);
    if (kind == DRAPE_EDGES && pair[1] < pair[0]) std::swap(pair[0], pair[1]);
    return pair;
}
}  // namespace

class Truth : public BackendTest
{
protected:
    void SetUp() override
    {
        BackendTest::SetUp();
        if (HasFatalFailure() || IsSkipped()) return;
        m_queries = makeQueries(GetParam().m_settings);
        ASSERT_TRUE(m_queries);
    }

    // Returns false if the test must return, like findTruth().
    template <typename Records>
    bool read(const std::string& name, Records& records)
    {
        std::string path, error;
        if (!findTruth(name, path)) return false;
        const bool good = readRecords(path, records, error);
        EXPECT_TRUE(good) << error;
        return good;
    }

    std::unique_ptr<Queries> m_queries;
};

TEST_P(Truth, MovingFeatures)
{
    MotionRecords records;
    if (!read("ccd_queries.bin", records)) return;
    for (float timeTolerance : {1.0f, defaultCcdSettings().m_timeTolerance})
    {
        CcdSettings settings = defaultCcdSettings();
        settings.m_timeTolerance = timeTolerance;
        std::vector<CcdResult> results(records.m_queries.size());
        ASSERT_TRUE(m_queries->motions(records.m_queries.data(), results.size(), settings, results.data()));
        Score score;
        for (std::size_t i = 0; i < results.size(); ++i)
            score.add(records.m_truth[i], results[i].m_hit != 0);
        EXPECT_EQ(score.m_true, 114540u);
        EXPECT_EQ(score.m_missed, 0u);
        EXPECT_LE(score.m_false, 200u);
    }
}

TEST_P(Truth, TrianglePairs)
{
    TriangleRecords records;
    if (!read("triangle_pairs.bin", records)) return;
    const std::size_t count = records.m_queries.size();
    ASSERT_GE(count, kLayersLast);
    for (TriangleTest test : {TriangleTest::Certified, TriangleTest::Exact})
    {
        std::vector<std::uint32_t> results(count);
        ASSERT_TRUE(m_queries->triangles(records.m_queries.data(), count, test, results.data()));
        Score score, layers;
        for (std::size_t i = 0; i < count; ++i)
        {
            score.add(records.m_truth[i], results[i] != 0);
            if (i >= kLayersFirst && i < kLayersLast) layers.add(records.m_truth[i], results[i] != 0);
        }
        EXPECT_EQ(score.m_missed, 0u);
        EXPECT_LE(score.m_false, test == TriangleTest::Exact ? 0u : 50u);
        EXPECT_EQ(layers.m_true, 0u);
        EXPECT_EQ(layers.m_false, 0u);
    }
}

TEST_P(Truth, ClothBallStep)
{
    MotionRecords records;
    if (!read("ccd_queries.bin", records)) return;
    TriangleMesh mesh;
    std::vector<float> end;
    std::string first, second, error;
    if (!findTruth("cloth_ball92.ply", first) || !findTruth("cloth_ball93.ply", second)) return;
    ASSERT_TRUE(loadMotion(first, second, mesh, end, error)) << error;
    ASSERT_EQ(mesh.vertexCount(), 46598u);
    MeshMotion found;
    CcdSettings settings = defaultCcdSettings();
    settings.m_timeTolerance = 1;
    ASSERT_TRUE(m_queries->meshMotion(describeMesh(mesh), end.data(), settings, found));
    // Boxes padded by one ulp give this many candidates; 18 directions must not give more.
    EXPECT_LE(found.m_vertexFaceCandidates, 1655541u);
    EXPECT_LE(found.m_edgeCandidates, 5197332u);

    std::set<PlacedPair> pairs[2];
    for (const TouchingFeatures& touching : found.m_touching)
    {
        Place places[4];
        for (int i = 0; i < 4; ++i)
            places[i] = placeOf(&mesh.m_positions[3 * touching.m_vertices[i]], &end[3 * touching.m_vertices[i]]);
        pairs[touching.m_kind].insert(placed(touching.m_kind, places));
    }
    // The step's true pairs are the records after the hand-made ones.
    std::size_t expected[2] = {0, 0}, contained[2] = {0, 0};
    for (std::size_t i = 3085 + 4194; i < records.m_queries.size(); ++i)
    {
        const CcdQuery& query = records.m_queries[i];
        if (!records.m_truth[i]) continue;
        Place places[4];
        for (int k = 0; k < 4; ++k)
            places[k] = placeOf(query.m_start + 3 * k, query.m_end + 3 * k);
        ++expected[query.m_kind];
        contained[query.m_kind] += pairs[query.m_kind].count(placed(query.m_kind, places));
    }
    EXPECT_EQ(expected[0], 19032u);
    EXPECT_EQ(expected[1], 94822u);
    EXPECT_EQ(contained[0], expected[0]);
    EXPECT_EQ(contained[1], expected[1]);
    EXPECT_LE(found.m_touching.size(), expected[0] + expected[1] + 20);
}

TEST_P(Truth, ClothBallIntersections)
{
    const std::pair<const char*, std::size_t> frames[] = {{"cloth_ball92.ply", 61530}, {"cloth_ball93.ply", 97320}};
    for (const auto& [name, truth] : frames)
    {
        TriangleMesh mesh;
        std::string path, error;
        if (!findTruth(name, path)) return;
        ASSERT_TRUE(loadMesh(path, mesh, error)) << error;
        MeshPairs found;
        ASSERT_TRUE(m_queries->meshPairs(describeMesh(mesh), nullptr, 0, found));
        EXPECT_EQ(found.m_intersecting.size(), truth);
        EXPECT_EQ(found.m_within.size(), truth);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, Truth, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
