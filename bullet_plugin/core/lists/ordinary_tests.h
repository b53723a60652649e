// Estimates how many feature tests a step makes before the pipeline checks its cloths, and the numbers that bound
// their work.
//
// Reason: faces of cloth that came apart, or whose pins were moved elsewhere, reach across an obstacle. Each is
// tested against nearly all of it. This takes seconds and gigabytes, for cloth that no solver can bring to rest in
// that step. Fast cloth that keeps its size may need many tests, too. It gets them, up to a multiple of these numbers
// set by the pipeline's caller (Pipeline::finish()).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace drape
{
// Maximum feature tests of a step, and maximum tests among them that may need the continuous test.
struct TestLimits
{
    std::size_t m_tests = SIZE_MAX;
    std::size_t m_swept = SIZE_MAX;

    TestLimits times(float share) const
    {
        return {std::size_t(float(m_tests) * share), std::size_t(float(m_swept) * share)};
    }
    // Adds, and stops at the largest number.
    void operator+=(const TestLimits& other)
    {
        m_tests += std::min(other.m_tests, SIZE_MAX - m_tests);
        m_swept += std::min(other.m_swept, SIZE_MAX - m_swept);
    }
};

// Measured on cloth of 2,048 to 32,768 triangles. At rest and at some metres a second there are 8 to 13 tests per
// cloth triangle, of which one in ten needs the continuous test. At 200 m/s a step is far longer than a triangle. Then
// there are up to 500 tests, and 3 to 6 continuous ones per triangle of cloth and obstacle. A cloth of 2,048 triangles
// on the bunny stays within these limits.
inline TestLimits ordinaryTests(std::size_t clothTriangles)
{
    return {(std::size_t(1) << 17) + 64 * clothTriangles, (std::size_t(1) << 13) + 2 * clothTriangles};
}

// Returns the tests that each obstacle of a cloth adds.
inline TestLimits ordinaryTestsBeside(std::size_t obstacleTriangles)
{
    return {24 * obstacleTriangles, obstacleTriangles / 2};
}
}  // namespace drape
