// Continuous collision of single pairs: no touch is missed, times are never late, and the answer depends on nothing but
// the shape.
#include "kernels/lib/ccd/ccd.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
struct Motion
{
    std::uint32_t m_kind;
    Vec3 m_start[4], m_end[4];
};

CcdResult run(const Motion& motion, const CcdSettings& settings = ccdDefaults())
{
    return ccdOfKind(motion.m_kind, motion.m_start, motion.m_end, settings);
}

Vec3 at(int x, int y, int z)
{
    return vec3(float(x), float(y), float(z));
}

int grid(Random& random, int size)
{
    return int(random.below(std::uint32_t(2 * size + 1))) - size;
}

Vec3 gridPoint(Random& random, int size)
{
    return vec3(float(grid(random, size)), float(grid(random, size)), float(grid(random, size)));
}

// Makes features that have exactly one point in common at half of the step. The corners there are multiples of 4, and
// the point is a mean of corners with weights that are quarters. Every vertex goes from `there - way` to `there + way`.
Motion touchingMotion(Random& random, std::uint32_t kind)
{
    Motion motion;
    motion.m_kind = kind;
    Vec3 there[4];
    for (Vec3& point : there)
        point = vec3Scale(gridPoint(random, 8), 4);
    const float u = float(random.below(5)) / 4;
    if (kind == DRAPE_VERTEX_FACE)
    {
        const float v = float(random.below(std::uint32_t(5 - 4 * u))) / 4;
        there[0] = vec3Add(vec3Scale(there[1], 1 - u - v), vec3Add(vec3Scale(there[2], u), vec3Scale(there[3], v)));
    }
    else
    {
        // The second edge passes through the position u on the first, at its middle.
        const Vec3 place = vec3Mix(there[0], there[1], u);
        const Vec3 half = gridPoint(random, 16);
        there[2] = vec3Sub(place, half);
        there[3] = vec3Add(place, half);
    }
    for (int i = 0; i < 4; ++i)
    {
        const Vec3 way = gridPoint(random, 40);
        motion.m_start[i] = vec3Sub(there[i], way);
        motion.m_end[i] = vec3Add(there[i], way);
    }
    return motion;
}

Motion randomMotion(Random& random, float speed)
{
    Motion motion;
    motion.m_kind = random.below(2);
    for (int i = 0; i < 4; ++i)
    {
        motion.m_start[i] = vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const Vec3 way = vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        motion.m_end[i] = vec3AddScaled(motion.m_start[i], way, speed);
    }
    return motion;
}

// Computes the offset between the positions (u,v) on the features at the time t, in double, and its derivatives.
void offsetOf(const Motion& motion, const double x[3], double offset[3], double jacobian[3][3])
{
    const double t = x[0], u = x[1], v = x[2];
    const bool face = motion.m_kind == DRAPE_VERTEX_FACE;
    for (int axis = 0; axis < 3; ++axis)
    {
        double p[4], way[4];
        for (int k = 0; k < 4; ++k)
        {
            const double from = (&motion.m_start[k].x)[axis];
            way[k] = (&motion.m_end[k].x)[axis] - from;
            p[k] = from + t * way[k];
        }
        const double weights[2][4] = {{1 - u, u, v - 1, -v}, {1, u + v - 1, -u, -v}};
        offset[axis] = jacobian[axis][0] = 0;
        for (int k = 0; k < 4; ++k)
        {
            offset[axis] += weights[face][k] * p[k];
            jacobian[axis][0] += weights[face][k] * way[k];
        }
        jacobian[axis][1] = face ? p[1] - p[2] : p[1] - p[0];
        jacobian[axis][2] = face ? p[1] - p[3] : p[2] - p[3];
    }
}

double determinant(const double m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

// Returns the earliest time of a touch well inside the features that Newton's method finds from 40 random starts; 2 for
// none.
double touchByNewton(const Motion& motion, Random& random)
{
    double earliest = 2;
    for (int start = 0; start < 40; ++start)
    {
        double x[3] = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
        double offset[3], jacobian[3][3];
        for (int i = 0; i < 30; ++i)
        {
            offsetOf(motion, x, offset, jacobian);
            const double whole = determinant(jacobian);
            if (whole == 0) break;
            for (int column = 0; column < 3; ++column)
            {
                double replaced[3][3];
                for (int axis = 0; axis < 3; ++axis)
                    for (int k = 0; k < 3; ++k)
                        replaced[axis][k] = k == column ? offset[axis] : jacobian[axis][k];
                x[column] -= determinant(replaced) / whole;
            }
        }
        offsetOf(motion, x, offset, jacobian);
        const bool converged = std::fabs(offset[0]) + std::fabs(offset[1]) + std::fabs(offset[2]) < 1e-12;
        const double low = 1e-9, high = 1 - 1e-9;
        const bool inside = x[0] > 0 && x[1] > low && x[2] > low &&
                            (motion.m_kind == DRAPE_EDGES ? x[1] < high && x[2] < high : x[1] + x[2] < high);
        if (converged && inside) earliest = std::min(earliest, x[0]);
    }
    return earliest;
}

Motion scaled(Motion motion, float scale)
{
    for (int i = 0; i < 4; ++i)
    {
        motion.m_start[i] = vec3Scale(motion.m_start[i], scale);
        motion.m_end[i] = vec3Scale(motion.m_end[i], scale);
    }
    return motion;
}

bool sameResult(const CcdResult& a, const CcdResult& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// Makes a vertex that falls through the middle of a face at rest.
Motion fallingVertex()
{
    return {DRAPE_VERTEX_FACE,
            {at(0, 0, 1), at(-3, -3, 0), at(3, -3, 0), at(0, 3, 0)},
            {at(0, 0, -3), at(-3, -3, 0), at(3, -3, 0), at(0, 3, 0)}};
}

// Makes two edges that cross, the first falling through the second.
Motion fallingEdge()
{
    return {DRAPE_EDGES,
            {at(-1, 0, 3), at(1, 0, 3), at(0, -1, 0), at(0, 1, 0)},
            {at(-1, 0, -1), at(1, 0, -1), at(0, -1, 0), at(0, 1, 0)}};
}
}  // namespace

TEST(Ccd, TheTimeIsThatOfTheFirstTouch)
{
    const CcdResult vertex = run(fallingVertex()), edge = run(fallingEdge());
    const float tolerance = ccdDefaults().m_timeTolerance;
    ASSERT_TRUE(vertex.m_hit && edge.m_hit);
    EXPECT_LE(vertex.m_time, 0.25f);
    EXPECT_GE(vertex.m_time, 0.25f - 2.5f * tolerance);
    EXPECT_LE(edge.m_time, 0.75f);
    EXPECT_GE(edge.m_time, 0.75f - 2.5f * tolerance);
    // The middle of the face has weights 1/4, 1/4, 1/2.
    EXPECT_NEAR(vertex.m_u, 0.25f, 0.26f);
    EXPECT_NEAR(edge.m_u, 0.5f, 0.51f);
}

TEST(Ccd, TouchesOnAGridAreNeverMissedNorLate)
{
    Random random(70);
    CcdSettings whether = ccdDefaults();
    whether.m_timeTolerance = 1;
    for (int i = 0; i < 20000; ++i)
    {
        const Motion motion = touchingMotion(random, std::uint32_t(i) % 2);
        const CcdResult result = run(motion);
        ASSERT_TRUE(result.m_hit) << "seed 70, case " << i;
        ASSERT_LE(result.m_time, 0.5f) << "seed 70, case " << i;
        ASSERT_TRUE(run(motion, whether).m_hit) << "seed 70, case " << i;
    }
}

TEST(Ccd, EveryTouchThatNewtonFindsIsAHitInTime)
{
    Random random(71);
    int hits = 0, confirmed = 0;
    const int cases = 4000;
    for (int i = 0; i < cases; ++i)
    {
        const Motion motion = randomMotion(random, 3);
        const CcdResult result = run(motion);
        hits += int(result.m_hit);
        const double time = touchByNewton(motion, random);
        if (time > 1) continue;
        ++confirmed;
        ASSERT_TRUE(result.m_hit) << "seed 71, case " << i;
        ASSERT_LE(result.m_time, time) << "seed 71, case " << i;
    }
    EXPECT_GT(hits, cases / 20);
    EXPECT_LT(hits, cases * 3 / 4);
    EXPECT_GT(confirmed, hits * 9 / 10) << "hits that Newton's method does not find should be few";
}

// Makes a vertex and a face that are in one plane at the given time, the vertex at the weights u and v there. The
// corners also move by up to `turn`.
Motion passingMotion(Random& random, float time, float u, float v, float turn)
{
    Motion motion = {DRAPE_VERTEX_FACE, {}, {}};
    const Vec3 corners[3] = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0.2f, 0.9f, 0)};
    Vec3 place = vec3(0, 0, 0);
    for (int i = 0; i < 3; ++i)
    {
        const Vec3 way = vec3(random.uniform(-turn, turn), random.uniform(-turn, turn), random.uniform(-turn, turn));
        motion.m_start[i + 1] = vec3AddScaled(corners[i], way, -0.5f);
        motion.m_end[i + 1] = vec3AddScaled(corners[i], way, 0.5f);
        const float weight = i == 0 ? 1 - u - v : i == 1 ? u : v;
        place = vec3AddScaled(place, vec3Mix(motion.m_start[i + 1], motion.m_end[i + 1], time), weight);
    }
    const Vec3 way = vec3(random.uniform(-0.3f, 0.3f), random.uniform(-0.3f, 0.3f), random.uniform(0.6f, 1.0f));
    motion.m_start[0] = vec3AddScaled(place, way, -time);
    motion.m_end[0] = vec3AddScaled(place, way, 1 - time);
    return motion;
}

// Returns the position of a path in time, relative to the beginning of the box that is `width` wide.
double pathOffset(const CcdPath& path, double width)
{
    double offset = 0;
    for (int i = 0; i < path.m_depth; ++i)
    {
        width *= 0.5;
        if (path.m_upper >> i & 1) offset += width;
    }
    return offset;
}

TEST(Ccd, MostMeetingsAreProvedWithoutASearch)
{
    Random random(75);
    CcdSettings settings = ccdDefaults();
    settings.m_timeTolerance = 0.01f;
    const int cases = 4000;
    int searched = 0;
    for (int i = 0; i < cases; ++i)
    {
        const float u = random.uniform(0.01f, 0.98f), v = random.uniform(0.005f, 0.99f - u);
        const float time = random.uniform(0.05f, 0.95f);
        const CcdResult result = run(passingMotion(random, time, u, v, 0.1f), settings);
        searched += result.m_boxes > 2;
        ASSERT_TRUE(result.m_hit) << "seed 75, case " << i;
        // The search reaches the tolerance, and the time is earlier by as much.
        ASSERT_LE(result.m_time, time) << "seed 75, case " << i;
        ASSERT_GE(result.m_time, time - 2.1f * settings.m_timeTolerance) << "seed 75, case " << i;
        if (result.m_boxes > 2) continue;
        ASSERT_NEAR(result.m_u, u, 0.01f) << "seed 75, case " << i;
        ASSERT_NEAR(result.m_v, v, 0.01f) << "seed 75, case " << i;
    }
    EXPECT_LT(searched, cases / 50);
}

TEST(Ccd, MostMissesBesideAnySideTakeFewSteps)
{
    Random random(76);
    const int cases = 3000;
    int hits = 0, searched = 0;
    for (int i = 0; i < cases; ++i)
    {
        const float beside = random.uniform(0.01f, 0.05f), along = random.uniform(0.1f, 0.9f);
        const float places[3][2] = {{-beside, along}, {along, -beside}, {along, 1 + beside - along}};
        const float u = places[i % 3][0], v = places[i % 3][1];
        const CcdResult result = run(passingMotion(random, random.uniform(0.1f, 0.9f), u, v, 0.03f));
        hits += int(result.m_hit);
        searched += result.m_boxes > 7;
    }
    EXPECT_LT(hits, cases / 20) << "paths that lean may still meet the face";
    EXPECT_LT(searched, cases / 20);
}

// Halving in time from any piece of the step and coming back gives the piece again, bit for bit.
TEST(Ccd, HalvesOfAnIntervalCoverTheInterval)
{
    Random random(77);
    for (int i = 0; i < 2000; ++i)
    {
        const float grain = 1.0f / float(1 << (4 + random.below(17)));
        const float low = grain * float(random.below(std::uint32_t(1 / grain)));
        const CcdBox piece = {{low, 0, 0}, {1 - low, 1, 1}};
        CcdBox box = piece;
        CcdPath path = {0, {0, 0}, 0};
        int halvings = 0;
        for (; ccdHalvesInTime(&box) && path.m_depth < 40; ++halvings)
        {
            ccdDescend(&box, &path, 0);
            if (random.below(2) == 1)
            {
                ASSERT_TRUE(ccdNext(&box, &path));
            }
            ASSERT_EQ(double(box.m_low[0]), double(piece.m_low[0]) + pathOffset(path, piece.m_width[0]))
                << "case " << i;
            ASSERT_EQ(1 - double(box.m_low[0]), double(1 - box.m_low[0]));
        }
        EXPECT_GE(halvings, 3) << low;
        while (ccdNext(&box, &path))
            while (ccdHalvesInTime(&box) && path.m_depth < 12)
                ccdDescend(&box, &path, 0);
        ASSERT_EQ(box.m_low[0], piece.m_low[0]) << "seed 77, case " << i;
        ASSERT_EQ(box.m_width[0], piece.m_width[0]) << "seed 77, case " << i;
    }
}

TEST(Ccd, ASearchWithZeroToleranceEnds)
{
    for (float tolerance : {0.0f, -1.0f, 1e-45f, 1e-12f, 5e-10f})
    {
        CcdSettings settings = ccdDefaults();
        settings.m_timeTolerance = tolerance;
        const CcdResult result = run(fallingVertex(), settings);
        EXPECT_TRUE(result.m_hit) << tolerance;
        EXPECT_LE(result.m_time, 0.25f) << tolerance;
        EXPECT_GE(result.m_time, 0.2499f) << tolerance;
        settings.m_boxLimit = 20;
        EXPECT_TRUE(run(fallingEdge(), settings).m_hit) << tolerance;
    }
}

TEST(Ccd, UnitsOfLengthThatArePowersOfTwoChangeNoBit)
{
    Random random(72);
    int hits = 0;
    for (int i = 0; i < 500; ++i)
    {
        const Motion motion = randomMotion(random, 2);
        const CcdResult result = run(motion);
        hits += int(result.m_hit);
        for (int exponent : {-60, -20, -1, 1, 20, 60, 100})
            ASSERT_TRUE(sameResult(result, run(scaled(motion, std::ldexp(1.0f, exponent)))))
                << "seed 72, case " << i << ", 2^" << exponent;
    }
    EXPECT_GT(hits, 25);
}

TEST(Ccd, TheOrderOfAPairDoesNotMatter)
{
    Random random(73);
    for (int i = 0; i < 2000; ++i)
    {
        const Motion motion = touchingMotion(random, std::uint32_t(i) % 2);
        Motion other = motion;
        for (Vec3* points : {other.m_start, other.m_end})
        {
            if (motion.m_kind == DRAPE_EDGES)
            {
                std::swap(points[0], points[2]);
                std::swap(points[1], points[3]);
            }
            else
            {
                std::swap(points[1], points[3]);
            }
        }
        ASSERT_TRUE(run(other).m_hit) << "seed 73, case " << i;
    }
}

TEST(Ccd, SeparationIsADistance)
{
    // One vertex passes a face at its corner's side, and one stops above it.
    for (float gap : {0.5f, 0.01f, 1e-4f})
    {
        Motion above = fallingVertex();
        above.m_end[0] = vec3(0, 0, gap);
        Motion beside = fallingVertex();
        beside.m_start[0] = vec3(3 + gap, -3 - gap, 1);
        beside.m_end[0] = vec3(3 + gap, -3 - gap, -1);
        const std::pair<Motion, float> cases[2] = {{above, gap}, {beside, gap * 1.4142135f}};
        for (const auto& [motion, distance] : cases)
        {
            CcdSettings settings = ccdDefaults();
            settings.m_separation = distance * 1.00001f;
            EXPECT_TRUE(run(motion, settings).m_hit) << gap;
            settings.m_separation = distance * 0.999f - 2e-5f;
            EXPECT_FALSE(run(motion, settings).m_hit) << gap;
            settings.m_separation = 0;
            EXPECT_FALSE(run(motion, settings).m_hit) << gap;
        }
    }
}

TEST(Ccd, SeparationMovesTheTimeForward)
{
    CcdSettings settings = ccdDefaults();
    settings.m_separation = 0.5f;
    const CcdResult result = run(fallingVertex(), settings);
    ASSERT_TRUE(result.m_hit);
    EXPECT_LE(result.m_time, 0.125f);
    EXPECT_GE(result.m_time, 0.12f);
}

TEST(Ccd, AnExhaustedSearchGivesTheSafeAnswer)
{
    Random random(74);
    int exhausted = 0;
    for (int i = 0; i < 2000; ++i)
    {
        const Motion motion = touchingMotion(random, std::uint32_t(i) % 2);
        for (std::uint32_t limit : {1u, 5u, 30u})
        {
            CcdSettings settings = ccdDefaults();
            settings.m_boxLimit = limit;
            const CcdResult result = run(motion, settings);
            exhausted += result.m_boxes > limit;
            ASSERT_TRUE(result.m_hit) << "seed 74, case " << i << ", limit " << limit;
            ASSERT_LE(result.m_time, 0.5f) << "seed 74, case " << i << ", limit " << limit;
        }
    }
    EXPECT_GT(exhausted, 1000);
}

TEST(Ccd, BadNumbersAreNoHitAndLargeOnesAreFinite)
{
    const float infinity = std::numeric_limits<float>::infinity();
    for (float bad : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN()})
    {
        Motion motion = fallingVertex();
        motion.m_end[2].y = bad;
        EXPECT_FALSE(run(motion).m_hit);
    }
    for (float size : {1e38f, 1e-38f, 1e-44f})
    {
        // The features are 3e38 apart: their difference does not fit a float unless it is scaled first.
        const CcdResult result = run(scaled(fallingVertex(), size));
        EXPECT_TRUE(result.m_hit) << size;
        EXPECT_LE(result.m_time, 0.25f) << size;
    }
    Motion apart = scaled(fallingVertex(), 1e38f);
    for (Vec3* points : {apart.m_start, apart.m_end})
        points[0].x = 3.3e38f;
    EXPECT_FALSE(run(apart).m_hit);
}

TEST(Ccd, PointsThatCoincideTouch)
{
    Motion motion = fallingVertex();
    for (int i = 0; i < 4; ++i)
        motion.m_start[i] = motion.m_end[i] = vec3(5, 6, 7);
    EXPECT_TRUE(run(motion).m_hit);
    motion.m_start[0] = motion.m_end[0] = vec3(5, 6, 7.001f);
    EXPECT_FALSE(run(motion).m_hit);
}
}  // namespace drape::test
