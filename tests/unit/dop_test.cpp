// 18-DOP volumes: they hold what they must in exact arithmetic, overlap is symmetric, invalid input empties them.
#include "kernels/lib/geometry/dop.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
// The directions of kernels/lib/geometry/dop.h, for every number of sides.
const int kAxes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const int kEdges[6][3] = {{1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, -1, 0}, {1, 0, -1}, {0, 1, -1}};
const int kCorners[4][3] = {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}};

const int* directionOf(int i)
{
    if (i < 3) return kAxes[i];
    if (DRAPE_DOP_DIRECTIONS < 9) return kCorners[i - 3];
    return i < 9 ? kEdges[i - 3] : kCorners[i - 9];
}

long double lengthOf(int i)
{
    const int* d = directionOf(i);
    return std::sqrt(static_cast<long double>(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
}

// A long double has 64 bits of mantissa: sums of two floats whose exponents differ by less than 40 are exact in it.
long double project(int direction, const float* p)
{
    long double sum = 0;
    for (int k = 0; k < 3; ++k)
        sum += static_cast<long double>(p[k]) * directionOf(direction)[k];
    return sum;
}

Dop volumeOf(const TriangleMesh& mesh, const std::vector<float>& end, std::uint32_t triangle, float radius)
{
    Triangle record = {};
    for (int i = 0; i < 3; ++i)
        record.m_vertices[i] = std::uint32_t(mesh.m_triangles[3 * triangle + std::uint32_t(i)]);
    Dop dop;
    triangleVolume(&dop, &record, mesh.m_positions.data(), end.data(), radius);
    return dop;
}

// Corners at both ends of the step, each with its ball of the radius, lie inside; not by far.
void expectHolds(const TriangleMesh& mesh, const std::vector<float>& end, std::uint32_t triangle, float radius)
{
    const Dop dop = volumeOf(mesh, end, triangle, radius);
    for (int direction = 0; direction < DRAPE_DOP_DIRECTIONS; ++direction)
    {
        const long double reach = radius * lengthOf(direction);
        long double low = 1e300L, high = -1e300L, largest = 0;
        for (int i = 0; i < 3; ++i)
        {
            const std::size_t at = 3 * std::size_t(mesh.m_triangles[3 * triangle + std::uint32_t(i)]);
            for (const float* p : {&mesh.m_positions[at], &end[at]})
            {
                const long double v = project(direction, p);
                low = std::min(low, v - reach);
                high = std::max(high, v + reach);
                // Sums of three terms are padded for the first two, which may cancel.
                const bool three = lengthOf(direction) > 1.5L;
                const long double inner = three ? std::fabs(p[0]) + std::fabs(p[1]) : 0.0L;
                largest = std::max(largest, std::fabs(v) + inner + reach);
            }
        }
        ASSERT_LE(dop.m_low[direction], low);
        ASSERT_GE(dop.m_high[direction], high);
        ASSERT_GT(dop.m_low[direction], low - 1e-6L * largest - 1e-37L) << "the pad is more than rounding needs";
        ASSERT_LT(dop.m_high[direction], high + 1e-6L * largest + 1e-37L);
    }
}

BvhNode nodeOf(const Dop& dop)
{
    BvhNode node = {};
    dopStore(&node, &dop);
    return node;
}
}  // namespace

TEST(Dop, HoldsItsTriangleAtEveryScaleAndPlace)
{
    std::uint32_t seed = 100;
    for (float scale : {1e-30f, 1e-6f, 1.0f, 1e3f})
    {
        for (float offset : {0.0f, 1.0f, 1000.0f, 1e6f})
        {
            StepCase step = soupCase(200, 1, true, ++seed);
            SCOPED_TRACE(step.trace() + ", scale " + std::to_string(scale) + ", offset " + std::to_string(offset));
            for (std::vector<float>* positions : {&step.m_cloth.m_positions, &step.m_end})
            {
                for (float& coordinate : *positions)
                    coordinate = (coordinate + offset) * scale;
            }
            for (std::uint32_t t = 0; t < step.m_cloth.triangleCount(); ++t)
            {
                for (float radius : {0.0f, 0.01f, 10.0f})
                    expectHolds(step.m_cloth, step.m_end, t, radius * scale);
            }
        }
    }
}

TEST(Dop, HoldsDenormalPoints)
{
    const TriangleMesh mesh = looseTriangles({1e-45f, 2e-42f, -3e-40f, 0.0f, -1e-45f, 1e-39f, 5e-41f, 0.0f, -1e-44f});
    expectHolds(mesh, mesh.m_positions, 0, 0.0f);
    expectHolds(mesh, mesh.m_positions, 0, 1e-44f);
}

TEST(Dop, OverlapIsSymmetric)
{
    const StepCase step = soupCase(300, 1, true, 7);
    SCOPED_TRACE(step.trace());
    int overlaps = 0, pairs = 0;
    for (std::uint32_t i = 0; i < 300; ++i)
    {
        const BvhNode a = nodeOf(volumeOf(step.m_cloth, step.m_end, i, 0.02f));
        EXPECT_TRUE(nodesOverlap(&a, &a));
        for (std::uint32_t j = 0; j < i; ++j)
        {
            const BvhNode b = nodeOf(volumeOf(step.m_cloth, step.m_end, j, 0.02f));
            ASSERT_EQ(nodesOverlap(&a, &b), nodesOverlap(&b, &a));
            overlaps += nodesOverlap(&a, &b);
            ++pairs;
        }
    }
    EXPECT_GT(overlaps, pairs / 100);
    EXPECT_LT(overlaps, pairs / 2);
}

TEST(Dop, DiagonalsSeparateWhatBoxesDoNot)
{
    const TriangleMesh mesh = looseTriangles({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0.9f, 1, 0, 1, 0.9f, 0});
    const BvhNode a = nodeOf(volumeOf(mesh, mesh.m_positions, 0, 0.0f)),
                  b = nodeOf(volumeOf(mesh, mesh.m_positions, 1, 0.0f));
    EXPECT_FALSE(nodesOverlap(&a, &b));
}

TEST(Dop, InvalidPositionsStayOutOfTheVolume)
{
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const TriangleMesh good = looseTriangles({0, 0, 0, 1, 0, 0, 0, 1, 0});
    for (float bad : {nan, infinity, -infinity})
    {
        for (std::size_t at = 0; at < 9; ++at)
        {
            for (bool atEnd : {false, true})
            {
                TriangleMesh mesh = good, left = good;
                std::vector<float> end = good.m_positions;
                (atEnd ? end : mesh.m_positions)[at] = bad;
                // The volume equals that of a triangle whose bad corner lies on another one.
                const std::size_t corner = at / 3, other = (corner + 1) % 3;
                std::copy_n(&good.m_positions[3 * other], 3, &left.m_positions[3 * corner]);
                const Dop dop = volumeOf(mesh, end, 0, 0.1f), expected = volumeOf(left, left.m_positions, 0, 0.1f);
                ASSERT_EQ(std::memcmp(&dop, &expected, sizeof dop), 0) << "coordinate " << at;
            }
        }
    }
}

TEST(Dop, NoValidPositionMakesAnEmptyVolume)
{
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const TriangleMesh good = looseTriangles({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const BvhNode sound = nodeOf(volumeOf(good, good.m_positions, 0, 0.1f));
    TriangleMesh mesh = good;
    std::vector<float> end = good.m_positions;
    mesh.m_positions[1] = nan;
    mesh.m_positions[5] = infinity;
    end[6] = -infinity;
    const Dop dop = volumeOf(mesh, end, 0, 0.1f);
    const BvhNode node = nodeOf(dop);
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        ASSERT_EQ(dop.m_low[i], infinity);
        ASSERT_EQ(dop.m_high[i], -infinity);
    }
    EXPECT_FALSE(nodesOverlap(&sound, &node));
    EXPECT_FALSE(nodesOverlap(&node, &node)) << "not even itself";
}

TEST(Dop, MergeIsTheExactUnion)
{
    const StepCase step = soupCase(2, 1, true, 21);
    const Dop a = volumeOf(step.m_cloth, step.m_end, 0, 0.02f), b = volumeOf(step.m_cloth, step.m_end, 1, 0.02f);
    std::vector<BvhNode> nodes = {nodeOf(a), nodeOf(b), {}};
    nodes[2].m_first = 0;
    nodes[2].m_count = 2;
    dopMergeChildren(nodes.data(), 2);
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        EXPECT_EQ(nodes[2].m_low[i], std::min(a.m_low[i], b.m_low[i]));
        EXPECT_EQ(nodes[2].m_high[i], std::max(a.m_high[i], b.m_high[i]));
    }
}
}  // namespace drape::test
