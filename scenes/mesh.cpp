#include "scenes/mesh.h"

#include <algorithm>
#include <cstring>
#include <unordered_map>

namespace drape
{
namespace
{
// The position of a vertex at the start and at the end of a motion.
struct PositionKey
{
    std::array<std::uint32_t, 6> m_bits;
    bool operator==(const PositionKey& other) const { return m_bits == other.m_bits; }
};

struct PositionHash
{
    std::size_t operator()(const PositionKey& key) const
    {
        std::uint64_t hash = 0;
        for (std::uint32_t bits : key.m_bits)
            hash = (hash ^ bits) * 0x9e3779b97f4a7c15ull;
        return static_cast<std::size_t>(hash ^ (hash >> 32));
    }
};

PositionKey keyOf(const float* start, const float* end)
{
    PositionKey key{};
    for (int i = 0; i < 6; ++i)
    {
        const float value = (i < 3 ? start[i] : end[i - 3]) + 0.0f;  // −0 + 0 is +0
        std::memcpy(&key.m_bits[i], &value, sizeof value);
    }
    return key;
}
}  // namespace

float Bounds::largestExtent() const
{
    return std::max({extent(0), extent(1), extent(2)});
}

Bounds boundsOf(const TriangleMesh& mesh)
{
    Bounds bounds{};
    for (std::size_t i = 0; i < mesh.m_positions.size(); ++i)
    {
        const float value = mesh.m_positions[i];
        bounds.m_low[i % 3] = i < 3 ? value : std::min(bounds.m_low[i % 3], value);
        bounds.m_high[i % 3] = i < 3 ? value : std::max(bounds.m_high[i % 3], value);
    }
    return bounds;
}

void placeOnFloor(TriangleMesh& mesh, float size)
{
    const Bounds bounds = boundsOf(mesh);
    double extent = 0;
    for (int axis = 0; axis < 3; ++axis)
        extent = std::max(extent, static_cast<double>(bounds.m_high[axis]) - bounds.m_low[axis]);
    const double scale = extent > 0 ? size / extent : 1.0;
    const double origin[3] = {0.5 * (static_cast<double>(bounds.m_low[0]) + bounds.m_high[0]), bounds.m_low[1],
                              0.5 * (static_cast<double>(bounds.m_low[2]) + bounds.m_high[2])};
    for (std::size_t i = 0; i < mesh.m_positions.size(); ++i)
        mesh.m_positions[i] = static_cast<float>((mesh.m_positions[i] - origin[i % 3]) * scale);
}

std::size_t joinVertices(TriangleMesh& mesh)
{
    std::vector<float> end = mesh.m_positions;
    return joinVertices(mesh, end);
}

std::size_t joinVertices(TriangleMesh& mesh, std::vector<float>& end)
{
    std::unordered_map<PositionKey, std::int32_t, PositionHash> known;
    known.reserve(mesh.vertexCount());
    // The first vertex at a position represents all.
    std::vector<std::int32_t> vertices(mesh.vertexCount());
    for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex)
    {
        const PositionKey key = keyOf(&mesh.m_positions[3 * vertex], &end[3 * vertex]);
        vertices[vertex] = known.emplace(key, static_cast<std::int32_t>(vertex)).first->second;
    }
    for (std::int32_t& index : mesh.m_triangles)
        index = vertices[static_cast<std::size_t>(index)];
    return keepUsedVertices(mesh, end);
}

std::size_t keepUsedVertices(TriangleMesh& mesh, std::vector<float>& end)
{
    TriangleMesh kept;
    std::vector<float> keptEnd;
    kept.m_triangles.reserve(mesh.m_triangles.size());
    std::vector<std::int32_t> numbers(mesh.vertexCount(), -1);
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    {
        const std::int32_t* corners = &mesh.m_triangles[3 * t];
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
        for (int corner = 0; corner < 3; ++corner)
        {
            const std::size_t vertex = static_cast<std::size_t>(corners[corner]);
            std::int32_t& number = numbers[vertex];
            if (number < 0)
            {
                number = static_cast<std::int32_t>(kept.vertexCount());
                kept.m_positions.insert(kept.m_positions.end(), &mesh.m_positions[3 * vertex],
                                        &mesh.m_positions[3 * vertex] + 3);
                keptEnd.insert(keptEnd.end(), &end[3 * vertex], &end[3 * vertex] + 3);
            }
            kept.m_triangles.push_back(number);
        }
    }
    const std::size_t dropped = mesh.triangleCount() - kept.triangleCount();
    mesh = std::move(kept);
    end = std::move(keptEnd);
    return dropped;
}

TriangleMesh subdivide(const TriangleMesh& mesh)
{
    TriangleMesh fine;
    fine.m_positions = mesh.m_positions;
    std::unordered_map<std::uint64_t, std::int32_t> middles;
    const auto middleOf = [&](std::int32_t a, std::int32_t b)
    {
        const std::uint64_t key =
            (static_cast<std::uint64_t>(std::min(a, b)) << 32) | static_cast<std::uint32_t>(std::max(a, b));
        const auto found = middles.emplace(key, static_cast<std::int32_t>(fine.vertexCount()));
        if (found.second)
            for (int axis = 0; axis < 3; ++axis)
                fine.m_positions.push_back(0.5f * (mesh.m_positions[3 * a + axis] + mesh.m_positions[3 * b + axis]));
        return found.first->second;
    };
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    {
        const std::int32_t* c = &mesh.m_triangles[3 * t];
        const std::int32_t m[3] = {middleOf(c[0], c[1]), middleOf(c[1], c[2]), middleOf(c[2], c[0])};
        const std::int32_t four[12] = {c[0], m[0], m[2], m[0], c[1], m[1], m[2], m[1], c[2], m[0], m[1], m[2]};
        fine.m_triangles.insert(fine.m_triangles.end(), four, four + 12);
    }
    return fine;
}
}  // namespace drape
