// Queries of whole meshes that would find more than fits: counted exactly, said to be so, bounded in memory and time.
#include <drape/queries.h>

#include <gtest/gtest.h>

#include "scenes/describe_mesh.h"
#include "tests/support/backends.h"
#include "tests/support/cases.h"
#include "tests/support/memory.h"
#include "tests/support/self_cases.h"
#include "tests/support/side.h"

namespace drape::test
{
class QueryLimitsTest : public BackendTest
{
protected:
    static std::unique_ptr<Queries> queriesWith(std::size_t candidates, std::size_t answers)
    {
        Settings settings = GetParam().m_settings;
        settings.m_candidateLimit = candidates;
        settings.m_contactLimit = answers;
        return makeQueries(settings);
    }
};

// Row 11 of the stress table: five thousand million pairs of a mesh with itself, half of that with another. Twice, with
// a query that fits between.
TEST_P(QueryLimitsTest, Row11HundredThousandCoincidentTriangles)
{
    constexpr int kTriangles = 100000;
    constexpr std::uint64_t kOwnPairs = std::uint64_t(kTriangles) * (kTriangles - 1) / 2;
    const TriangleMesh crowd = coincidentTriangles(kTriangles, 0.0f);
    const TriangleMesh half = coincidentTriangles(kTriangles / 4, 0.01f), few = coincidentTriangles(20, 0.0f);
    const MeshDescription mesh = describeMesh(crowd), other = describeMesh(half), small = describeMesh(few);
    const std::unique_ptr<Queries> queries = makeQueries(GetParam().m_settings);
    ASSERT_TRUE(queries);
    const std::size_t before = peakResidentBytes();
    for (int repetition = 0; repetition < 2; ++repetition)
    {
        MeshPairs own, both, fitting;
        ASSERT_TRUE(queries->meshPairs(mesh, nullptr, 0.02f, own)) << queries->error().text();
        EXPECT_EQ(own.m_candidates, kOwnPairs);
        ASSERT_TRUE(queries->meshPairs(mesh, &other, 0.02f, both)) << queries->error().text();
        EXPECT_EQ(both.m_candidates, std::uint64_t(kTriangles) * (kTriangles / 4));
        for (const MeshPairs* found : {&own, &both})
        {
            EXPECT_EQ(found->m_limits, std::uint32_t(kQueryCandidateLimit));
            EXPECT_EQ(found->m_withinCount + found->m_intersectingCount, 0u);
            EXPECT_TRUE(found->m_within.empty() && found->m_intersecting.empty());
        }
        MeshMotion motion;
        ASSERT_TRUE(queries->meshMotion(mesh, mesh.m_positions, defaultCcdSettings(), motion));
        EXPECT_EQ(motion.m_limits, std::uint32_t(kQueryCandidateLimit));
        EXPECT_EQ(motion.m_trianglePairs, kOwnPairs);
        EXPECT_EQ(motion.m_vertexFaceHits + motion.m_edgeHits + motion.m_touching.size(), 0u);
        ASSERT_TRUE(queries->meshPairs(small, nullptr, 0.02f, fitting));
        EXPECT_EQ(fitting.m_limits, std::uint32_t(kQueryWhole));
        EXPECT_EQ(fitting.m_intersecting.size(), 190u);
    }
    // Hierarchies of these meshes, on both sides of a query and a device, and the lists that a batch may fill.
    EXPECT_LT(peakResidentBytes(), before + (std::size_t(300) << 20) + kGrowthBytes);
}

// All pairs are candidates and answers, so that the limits are met or passed by one.
TEST_P(QueryLimitsTest, LimitsArePassedByOne)
{
    constexpr std::uint64_t kTriangles = 300, kPairs = kTriangles * (kTriangles - 1) / 2;
    const TriangleMesh crowd = coincidentTriangles(int(kTriangles), 0.0f);
    const MeshDescription mesh = describeMesh(crowd);
    for (const bool candidatesFit : {true, false})
        for (const bool answersFit : {true, false})
        {
            SCOPED_TRACE(std::string(candidatesFit ? "candidates fit" : "too many candidates") +
                         (answersFit ? ", answers fit" : ", too many answers"));
            const std::unique_ptr<Queries> queries =
                queriesWith(kPairs - (candidatesFit ? 0 : 1), kPairs - (answersFit ? 0 : 1));
            ASSERT_TRUE(queries);
            MeshPairs found;
            ASSERT_TRUE(queries->meshPairs(mesh, nullptr, 0.0f, found));
            EXPECT_EQ(found.m_candidates, kPairs);
            EXPECT_EQ(found.m_withinCount, candidatesFit ? kPairs : 0u);
            EXPECT_EQ(found.m_intersectingCount, candidatesFit ? kPairs : 0u);
            const std::size_t listed = candidatesFit && answersFit ? kPairs : 0;
            EXPECT_EQ(found.m_within.size(), listed);
            EXPECT_EQ(found.m_intersecting.size(), listed);
            const std::uint32_t expected = !candidatesFit ? kQueryCandidateLimit
                                           : !answersFit  ? kQueryAnswerLimit
                                                          : kQueryWhole;
            EXPECT_EQ(found.m_limits, expected);
        }
}

// The hits of a motion are counted in full when they are too many to list, and when its features are too many to test.
TEST_P(QueryLimitsTest, MotionsBeyondTheirLimits)
{
    const SelfCase motion = soupSelfCase(300, 116);
    SCOPED_TRACE(motion.m_name);
    const MeshDescription mesh = describeMesh(motion.m_mesh);
    const auto find = [&](std::size_t candidates, std::size_t answers)
    {
        MeshMotion found;
        const std::unique_ptr<Queries> queries = queriesWith(candidates, answers);
        EXPECT_TRUE(queries && queries->meshMotion(mesh, motion.m_end.data(), defaultCcdSettings(), found));
        return found;
    };
    const MeshMotion whole = find(Settings().m_candidateLimit, Settings().m_contactLimit);
    const std::size_t hits = whole.m_touching.size(), pairs = std::size_t(whole.m_trianglePairs);
    const std::size_t features = std::size_t(whole.m_vertexFaceCandidates + whole.m_edgeCandidates);
    ASSERT_GT(hits, 100u);
    ASSERT_GT(features, pairs) << "limits between the two are tried";
    EXPECT_EQ(whole.m_limits, std::uint32_t(kQueryWhole));
    EXPECT_EQ(whole.m_vertexFaceHits + whole.m_edgeHits, hits);
    EXPECT_TRUE(sameBytes(find(features, hits).m_touching, whole.m_touching));

    const MeshMotion unlisted = find(features, hits - 1);
    EXPECT_EQ(unlisted.m_limits, std::uint32_t(kQueryAnswerLimit));
    EXPECT_EQ(unlisted.m_vertexFaceHits, whole.m_vertexFaceHits);
    EXPECT_EQ(unlisted.m_edgeHits, whole.m_edgeHits);
    EXPECT_TRUE(unlisted.m_touching.empty());

    for (std::size_t limit : {features - 1, pairs, pairs - 1})
    {
        SCOPED_TRACE("limit " + std::to_string(limit));
        const MeshMotion untested = find(limit, hits);
        EXPECT_EQ(untested.m_limits, std::uint32_t(kQueryCandidateLimit));
        EXPECT_EQ(untested.m_trianglePairs, pairs);
        EXPECT_EQ(untested.m_vertexFaceCandidates, limit < pairs ? 0u : whole.m_vertexFaceCandidates);
        EXPECT_EQ(untested.m_edgeCandidates, limit < pairs ? 0u : whole.m_edgeCandidates);
        EXPECT_EQ(untested.m_vertexFaceHits + untested.m_edgeHits + untested.m_touching.size(), 0u);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, QueryLimitsTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
