#include "recorder/coding.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <unordered_map>

namespace drape
{
namespace
{
constexpr double kMostSteps = 536870912;  // 2^29: differences of differences still fit in 32 bits

std::uint64_t zigzag(std::int64_t value)
{
    return (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
}

// Returns the row as differences of the given order, chained or not.
std::vector<std::int64_t> residuals(const std::int32_t* row, std::size_t width, int order, bool chained)
{
    std::vector<std::int64_t> result(width);
    for (std::size_t i = 0; i < width; ++i)
    {
        std::int64_t value = row[i];
        if (order == 1) value -= *(row + i - width);
        if (order == 2) value -= 2 * std::int64_t{*(row + i - width)} - *(row + i - 2 * width);
        result[i] = value;
    }
    for (std::size_t i = width; chained && --i > 0;)
        result[i] -= result[i - 1];
    return result;
}

// Returns about how many bits the numbers need.
double costOf(const std::vector<std::int64_t>& values)
{
    double bits = 0;
    for (const std::int64_t value : values)
        bits += std::log2(1.0 + static_cast<double>(zigzag(value)));
    return bits;
}

class TriangleWalk
{
public:
    TriangleWalk(const std::vector<std::int32_t>& triangles, std::size_t vertexCount, std::vector<std::int32_t>& order)
        : m_triangles(triangles), m_order(order), m_numbers(vertexCount, -1), m_seen(triangles.size() / 3)
    {
        for (std::size_t i = 0; i < triangles.size(); ++i)
            m_edges[edge(triangles[i], corner(i, 1))] = i;
    }

    std::string code()
    {
        m_order.clear();
        for (std::size_t t = 0; t < m_seen.size(); ++t)
        {
            if (m_seen[t]) continue;
            m_seen[t] = true;
            for (std::size_t i = 3 * t; i < 3 * t + 3; ++i)
            {
                codeVertex(m_triangles[i]);
                m_gates.emplace_back(corner(i, 1), m_triangles[i]);
            }
            while (!m_gates.empty())
                codeGate();
        }
        for (std::size_t v = 0; v < m_numbers.size(); ++v)
            if (m_numbers[v] < 0) m_order.push_back(static_cast<std::int32_t>(v));
        return std::move(m_bytes);
    }

private:
    static std::uint64_t edge(std::int32_t from, std::int32_t to)
    {
        return static_cast<std::uint64_t>(static_cast<std::uint32_t>(from)) << 32 | static_cast<std::uint32_t>(to);
    }

    // Returns the vertex `further` corners after the corner i, in its triangle.
    std::int32_t corner(std::size_t i, std::size_t further) const { return m_triangles[i / 3 * 3 + (i + further) % 3]; }

    void codeVertex(std::int32_t vertex)
    {
        std::int32_t& number = m_numbers[static_cast<std::size_t>(vertex)];
        const auto next = static_cast<std::int32_t>(m_order.size());
        appendNumber(m_bytes, number < 0 ? 1 : 1 + next - number);
        if (number >= 0) return;
        number = next;
        m_order.push_back(vertex);
    }

    void codeGate()
    {
        const auto [from, to] = m_gates.back();
        m_gates.pop_back();
        const auto found = m_edges.find(edge(from, to));
        if (found == m_edges.end() || m_seen[found->second / 3]) return appendNumber(m_bytes, 0);
        m_seen[found->second / 3] = true;
        const std::int32_t third = corner(found->second, 2);
        codeVertex(third);
        m_gates.emplace_back(third, to);
        m_gates.emplace_back(from, third);
    }

    const std::vector<std::int32_t>& m_triangles;
    std::vector<std::int32_t>& m_order;
    std::vector<std::int32_t> m_numbers;
    std::vector<bool> m_seen;
    std::unordered_map<std::uint64_t, std::size_t> m_edges;  // directed edge: the corner at which it begins
    std::vector<std::pair<std::int32_t, std::int32_t>> m_gates;
    std::string m_bytes;
};
}  // namespace

void appendNumber(std::string& bytes, std::int64_t value)
{
    std::uint64_t rest = zigzag(value);
    for (; rest >= 128; rest >>= 7)
        bytes.push_back(static_cast<char>(rest | 128));
    bytes.push_back(static_cast<char>(rest));
}

std::vector<std::int32_t> quantise(const std::vector<float>& values, std::size_t width, double step)
{
    std::vector<std::int32_t> result(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::isfinite(values[i]))
            result[i] = static_cast<std::int32_t>(
                std::lround(std::clamp(static_cast<double>(values[i]) / step, -kMostSteps, kMostSteps)));
        else if (i >= width)
            result[i] = result[i - width];
    return result;
}

std::string codeRows(const std::vector<std::int32_t>& values, std::size_t width)
{
    std::string bytes;
    for (std::size_t row = 0; (row + 1) * width <= values.size(); ++row)
    {
        double least = 0;
        char mode = 0;
        std::vector<std::int64_t> best;
        for (char candidate = 0; candidate < 6; ++candidate)
        {
            if (static_cast<std::size_t>(candidate % 3) > row) continue;
            std::vector<std::int64_t> coded = residuals(&values[row * width], width, candidate % 3, candidate >= 3);
            const double cost = costOf(coded);
            if (!best.empty() && cost >= least) continue;
            least = cost;
            mode = candidate;
            best = std::move(coded);
        }
        bytes.push_back(mode);
        for (const std::int64_t value : best)
            appendNumber(bytes, value);
    }
    return bytes;
}

std::string codeTriangles(const std::vector<std::int32_t>& triangles, std::size_t vertexCount,
                          std::vector<std::int32_t>& order)
{
    return TriangleWalk(triangles, vertexCount, order).code();
}

std::string deflated(const std::string& bytes)
{
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::string result(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(&result[0]), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                  static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION) != Z_OK)
        throw std::bad_alloc();  // with room for the bound, memory is all that can be missing
    result.resize(size);
    return result;
}

std::string encodeBase64(const std::string& bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text.push_back(i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63u] : '=');
    }
    return text;
}
}  // namespace drape
