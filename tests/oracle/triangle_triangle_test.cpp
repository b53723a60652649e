// The triangle test against exact arithmetic: an intersecting pair is never missed, false hits stay rare.
#include "kernels/lib/queries/triangle_triangle.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iostream>

#include "oracle/exact_predicates.h"
#include "tests/support/cases.h"
#include "tests/support/published_data.h"

namespace drape::test
{
namespace
{
// Tests in the local frame of the second triangle's first vertex, like the pipeline.
bool found(const float* p)
{
    FeatureTriangle triangles[2];
    for (int i = 0; i < 6; ++i)
    {
        triangles[i / 3].m_p[i % 3] = vec3(p[3 * i] - p[9], p[3 * i + 1] - p[10], p[3 * i + 2] - p[11]);
    }
    return trianglesIntersect(triangles[0], triangles[1]) != 0;
}

bool exact(const float* p)
{
    Vector3 corners[6];
    for (int i = 0; i < 6; ++i)
        corners[i] = {p[3 * i], p[3 * i + 1], p[3 * i + 2]};
    return drape::trianglesIntersect(corners, corners + 3);
}

struct Score
{
    std::size_t m_pairs = 0, m_true = 0, m_missed = 0, m_false = 0;

    void add(const float* p, bool truth)
    {
        const bool hit = found(p);
        ++m_pairs;
        m_true += truth;
        m_missed += truth && !hit;
        m_false += hit && !truth;
    }
};

// Makes two random triangles of the size around a point. A size of 0 places them on an integer grid, so that they touch
// in every way.
void randomPair(Random& random, float size, float offset, float* p)
{
    for (int i = 0; i < 18; ++i)
    {
        p[i] = offset + (size > 0 ? size * random.uniform(-1, 1) : float(random.below(4)));
    }
}
}  // namespace

TEST(TriangleTriangleOracle, RandomPairs)
{
    Random random(500);
    for (float size : {0.0f, 1.0f, 1e-3f, 1e3f})
    {
        for (float offset : {0.0f, 100.0f})
        {
            SCOPED_TRACE("seed 500, size " + std::to_string(size) + ", offset " + std::to_string(offset));
            Score score;
            for (int i = 0; i < 20000; ++i)
            {
                float p[18];
                randomPair(random, size, offset, p);
                score.add(p, exact(p));
            }
            EXPECT_EQ(score.m_missed, 0u);
            EXPECT_LE(score.m_false, score.m_pairs / 1000);
            EXPECT_GT(score.m_true, score.m_pairs / 10);
            EXPECT_LT(score.m_true, score.m_pairs * 9 / 10);
        }
    }
}

TEST(TriangleTriangleOracle, VertexOnAFaceInAllOrders)
{
    const float face[9] = {0, 0, 0, 4, 0, 0, 0, 0, 4}, touching[9] = {1, 0, 1, 1, 2, 2, 2, 3, 1};
    const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& first : orders)
    {
        for (const auto& second : orders)
        {
            float p[18];
            for (int i = 0; i < 3; ++i)
            {
                std::copy(face + 3 * first[i], face + 3 * first[i] + 3, p + 3 * i);
                std::copy(touching + 3 * second[i], touching + 3 * second[i] + 3, p + 9 + 3 * i);
            }
            EXPECT_TRUE(found(p));
        }
    }
}

TEST(TriangleTriangleOracle, NamedCases)
{
    const float coplanarOverlapping[18] = {0, 0, 0, 2, 0, 0, 0, 0, 2, 0.5f, 0, 0.5f, 2, 0, 2, 0.5f, 0, 2};
    const float coplanarApart[18] = {0, 0, 0, 1, 0, 0, 0, 0, 1, 2, 0, 2, 3, 0, 2, 2, 0, 3};
    const float layers[18] = {0, 0, 0, 0.01f, 0, 0, 0, 0, 0.01f, 0, 0.001f, 0, 0.01f, 0.001f, 0, 0, 0.001f, 0.01f};
    const float inPlaneOutside[18] = {0, 0, 0, 1, 0, 0, 0, 0, 1, 3, 0, 3, 3, 1, 3, 4, 1, 3};
    const float sharedVertex[18] = {0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1, 0, -1, 0, -1};
    const float pointInFace[18] = {0, 0, 0, 4, 0, 0, 0, 0, 4, 1, 0, 1, 1, 0, 1, 1, 0, 1};
    const float needleThrough[18] = {0, 0, 0, 4, 0, 0, 0, 0, 4, 1, -1, 1, 1, 1, 1, 1, 1, 1.00000001f};
    EXPECT_TRUE(found(coplanarOverlapping));
    EXPECT_FALSE(found(coplanarApart));
    EXPECT_FALSE(found(layers));
    EXPECT_FALSE(found(inPlaneOutside));
    EXPECT_TRUE(found(sharedVertex));
    EXPECT_TRUE(found(pointInFace));
    EXPECT_TRUE(found(needleThrough));
}

TEST(TriangleTriangleOracle, PublishedPairs)
{
    std::string path;
    if (!findTruth("triangle_pairs.bin", path)) return;
    std::ifstream file(path, std::ios::binary);
    struct Record
    {
        float m_corners[18];
        std::int32_t m_truth;
    } record;
    static_assert(sizeof(Record) == 76, "as in the file");
    Score score;
    while (file.read(reinterpret_cast<char*>(&record), sizeof record))
        score.add(record.m_corners, record.m_truth != 0);
    ASSERT_GT(score.m_pairs, 1000u);
    EXPECT_EQ(score.m_missed, 0u);
    // The test is conservative within 12 units in the last place of the extent. A handful of false hits was measured on
    // these sets.
    EXPECT_LE(score.m_false, 50u);
    RecordProperty("pairs", int(score.m_pairs));
    RecordProperty("false_hits", int(score.m_false));
    std::cout << score.m_pairs << " pairs, " << score.m_true << " true, " << score.m_missed << " missed, "
              << score.m_false << " false hits\n";
}
}  // namespace drape::test
