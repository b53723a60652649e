// A fuzz target's input as values: what the bytes say, in any order of questions. Zeros when they have ended.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "scenes/mesh.h"

namespace drape::fuzz
{
// Requires a condition of the target, not of the input: libFuzzer keeps the input.
inline void require(bool good)
{
    if (!good) std::abort();
}

class Bytes
{
public:
    Bytes(const std::uint8_t* data, std::size_t size) : m_data(data), m_size(size) {}

    bool left() const { return m_at < m_size; }
    std::uint8_t byte() { return left() ? m_data[m_at++] : 0; }
    std::uint32_t below(std::uint32_t count) { return byte() % count; }
    // Returns the input's last byte, which is not read again. It serves choices that were added to a target after its
    // corpus.
    std::uint8_t last() { return left() ? m_data[--m_size] : 0; }

    // Returns mostly numbers that meet each other, and sometimes any bits.
    float number()
    {
        const std::uint8_t kind = byte();
        if (kind < 200) return float(kind % 32) / 16.0f - 1.0f;
        if (kind < 240) return std::ldexp(float(std::int8_t(byte())), int(byte()) - 128);
        return floatOf(word());
    }
    // Returns a length that is not negative and not much longer than a planet.
    float length()
    {
        const float value = std::fabs(number());
        return value < 1e9f ? value : 0.0f;
    }
    std::uint32_t word()
    {
        std::uint32_t bits = 0;
        for (int i = 0; i < 4; ++i)
            bits = bits << 8 | byte();
        return bits;
    }

private:
    static float floatOf(std::uint32_t bits)
    {
        float value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }

    const std::uint8_t* m_data;
    std::size_t m_size, m_at = 0;
};

constexpr std::uint32_t kMostVertices = 24, kMostTriangles = 32;

// A small mesh of any positions. badIndices: any indices too, some of them out of range.
struct AnyMesh : TriangleMesh
{
    bool m_inRange = true;  // every index

    AnyMesh(Bytes& bytes, bool badIndices)
    {
        const std::uint32_t vertices = bytes.below(kMostVertices),
                            triangles = vertices ? bytes.below(kMostTriangles) : 0;
        for (std::uint32_t i = 0; i < 3 * vertices; ++i)
            m_positions.push_back(bytes.number());
        for (std::uint32_t i = 0; i < 3 * triangles; ++i)
        {
            const bool any = badIndices && bytes.below(32) == 0;
            m_triangles.push_back(std::int32_t(any ? bytes.word() : bytes.below(vertices)));
            m_inRange = m_inRange && std::uint32_t(m_triangles.back()) < vertices;
        }
    }
};
}  // namespace drape::fuzz
