// The numbers and triangles of a replay page come back from their code, positions within half of the resolution.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "mesh_io/base64.h"
#include "recorder/coding.h"
#include "scenes/shapes.h"

namespace drape::test
{
namespace
{
class Reader
{
public:
    explicit Reader(const std::string& bytes) : m_bytes(bytes) {}

    std::int64_t number()
    {
        std::uint64_t value = 0;
        for (int shift = 0;; shift += 7)
        {
            const std::uint64_t byte = this->byte();
            value |= (byte & 127) << shift;
            if (byte < 128) break;
        }
        return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
    }

    std::uint8_t byte() { return static_cast<std::uint8_t>(m_bytes.at(m_at++)); }
    bool atEnd() const { return m_at == m_bytes.size(); }

private:
    const std::string& m_bytes;
    std::size_t m_at = 0;
};

std::vector<std::int32_t> decodeRows(const std::string& bytes, std::size_t width, std::size_t size)
{
    Reader reader(bytes);
    std::vector<std::int64_t> values;
    while (values.size() < size)
    {
        const int mode = reader.byte(), order = mode % 3;
        std::int64_t difference = 0;
        for (std::size_t i = 0; i < width; ++i)
        {
            difference = reader.number() + (mode >= 3 ? difference : 0);
            const std::size_t at = values.size();
            const std::int64_t one = order > 0 ? values[at - width] : 0, two = order > 1 ? values[at - 2 * width] : 0;
            values.push_back(difference + (order == 2 ? 2 * one - two : one));
        }
    }
    EXPECT_TRUE(reader.atEnd());
    return {values.begin(), values.end()};
}

using Triangle = std::array<std::int32_t, 3>;

// Returns the triangle from its smallest vertex on: the same turn of it always.
Triangle turned(Triangle t)
{
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

std::multiset<Triangle> trianglesOf(const std::vector<std::int32_t>& corners)
{
    std::multiset<Triangle> triangles;
    for (std::size_t i = 0; i < corners.size(); i += 3)
        triangles.insert(turned({corners[i], corners[i + 1], corners[i + 2]}));
    return triangles;
}

std::vector<std::int32_t> decodeTriangles(const std::string& bytes, std::size_t count)
{
    Reader reader(bytes);
    std::vector<std::int32_t> corners;
    std::vector<std::pair<std::int32_t, std::int32_t>> gates;
    std::int32_t vertices = 0;
    const auto vertex = [&](std::int64_t code)
    { return code == 1 ? vertices++ : static_cast<std::int32_t>(vertices + 1 - code); };
    while (corners.size() < 3 * count || !gates.empty())
    {
        if (gates.empty())
        {
            Triangle t;
            for (std::int32_t& corner : t)
                corner = vertex(reader.number());
            corners.insert(corners.end(), t.begin(), t.end());
            for (std::size_t i = 0; i < 3; ++i)
                gates.emplace_back(t[(i + 1) % 3], t[i]);
            continue;
        }
        const auto [from, to] = gates.back();
        gates.pop_back();
        const std::int64_t code = reader.number();
        if (code == 0) continue;
        const std::int32_t third = vertex(code);
        corners.insert(corners.end(), {from, to, third});
        gates.emplace_back(third, to);
        gates.emplace_back(from, third);
    }
    EXPECT_TRUE(reader.atEnd());
    return corners;
}

void expectTrianglesComeBack(const std::vector<std::int32_t>& triangles, std::size_t vertexCount)
{
    std::vector<std::int32_t> order;
    const std::string bytes = codeTriangles(triangles, vertexCount, order);
    ASSERT_EQ(std::set<std::int32_t>(order.begin(), order.end()).size(), vertexCount);
    std::vector<std::int32_t> corners = decodeTriangles(bytes, triangles.size() / 3);
    for (std::int32_t& corner : corners)
        corner = order.at(static_cast<std::size_t>(corner));
    EXPECT_EQ(trianglesOf(corners), trianglesOf(triangles));
}
}  // namespace

TEST(ReplayCoding, NumbersOfEverySizeComeBack)
{
    std::vector<std::int64_t> numbers = {0, 1, -1, 63, 64, -64, -65, 2147483647, -2147483648LL, 4294967295LL};
    std::string bytes;
    for (const std::int64_t number : numbers)
        appendNumber(bytes, number);
    Reader reader(bytes);
    for (const std::int64_t number : numbers)
        EXPECT_EQ(reader.number(), number);
    EXPECT_TRUE(reader.atEnd());
    bytes.clear();
    appendNumber(bytes, -64);
    EXPECT_EQ(bytes.size(), 1u);
}

TEST(ReplayCoding, PositionsComeBackWithinHalfOfTheStep)
{
    constexpr double kStep = 1.5e-4;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-3.0f, 3.0f);
    std::vector<float> positions(3 * 40 * 7);
    for (float& value : positions)
        value = place(random);
    const std::vector<std::int32_t> steps = quantise(positions, 3 * 40, kStep);
    const std::vector<std::int32_t> decoded = decodeRows(codeRows(steps, 3 * 40), 3 * 40, steps.size());
    ASSERT_EQ(decoded, steps);
    for (std::size_t i = 0; i < positions.size(); ++i)
        EXPECT_LE(std::abs(double(positions[i]) - kStep * decoded[i]), 0.5 * kStep * (1 + 1e-9));
}

TEST(ReplayCoding, WhatIsNotFiniteRepeatsTheRowBefore)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    EXPECT_EQ(quantise({nan, 2, 5, inf, -inf, 7}, 2, 1.0), (std::vector<std::int32_t>{0, 2, 5, 2, 5, 7}));
    const std::vector<std::int32_t> far = quantise({3e38f, -3e38f, 3e38f, -3e38f}, 1, 1e-6);
    EXPECT_EQ(decodeRows(codeRows(far, 1), 1, 4), far);
}

TEST(ReplayCoding, SteadyMotionAndRestCostAByteANumberAtMost)
{
    constexpr std::size_t kWidth = 300, kRows = 50;
    std::vector<std::int32_t> falling, resting;
    for (std::size_t row = 0; row < kRows; ++row)
        for (std::size_t i = 0; i < kWidth; ++i)
        {
            falling.push_back(static_cast<std::int32_t>(1000 * i - 14 * row * row));
            resting.push_back(static_cast<std::int32_t>(i * i));
        }
    for (const std::vector<std::int32_t>& rows : {falling, resting})
    {
        const std::string bytes = codeRows(rows, kWidth);
        EXPECT_EQ(decodeRows(bytes, kWidth, rows.size()), rows);
        EXPECT_LT(bytes.size(), (kWidth + 1) * kRows + 3 * 2 * kWidth);
        EXPECT_LT(deflated(bytes).size(), 3000u);
    }
}

TEST(ReplayCoding, TrianglesComeBackWithTheirWinding)
{
    TriangleMesh mesh;
    for (const char* shape : {"torus", "terrain", "soup", "stairs"})
    {
        SCOPED_TRACE(shape);
        ASSERT_TRUE(makeShape(shape, mesh));
        expectTrianglesComeBack(mesh.m_triangles, mesh.vertexCount());
    }
}

TEST(ReplayCoding, OddTrianglesComeBack)
{
    expectTrianglesComeBack({}, 3);
    // Three at one edge, one twice, one with a repeated vertex, one alone; vertices 9 and 10 are unused.
    expectTrianglesComeBack({0, 1, 2, 1, 0, 3, 0, 1, 4, 0, 1, 2, 5, 5, 6, 8, 7, 2}, 11);
}

TEST(ReplayCoding, AClosedMeshTakesLittleMoreThanABitAnEdge)
{
    TriangleMesh mesh;
    ASSERT_TRUE(makeShape("torus", mesh));
    std::vector<std::int32_t> order;
    const std::string bytes = codeTriangles(mesh.m_triangles, mesh.vertexCount(), order);
    EXPECT_LT(8 * deflated(bytes).size(), 4 * mesh.triangleCount());
}

TEST(ReplayCoding, Base64IsWhatReadersDecode)
{
    std::string bytes;
    for (int length = 0; length < 40; ++length)
    {
        std::string decoded;
        const std::string text = encodeBase64(bytes);
        EXPECT_EQ(text.size() % 4, 0u);
        ASSERT_TRUE(decodeBase64(text, decoded));
        EXPECT_EQ(decoded, bytes);
        bytes.push_back(static_cast<char>(37 * length + 200));
    }
    EXPECT_EQ(encodeBase64("light w"), "bGlnaHQgdw==");
}
}  // namespace drape::test
