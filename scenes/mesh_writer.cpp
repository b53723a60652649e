#include "scenes/mesh_writer.h"

#include <cstdio>
#include <cstring>

#include "scenes/atomic_file.h"

namespace drape
{
namespace
{
void appendLittle(std::string& bytes, const void* value)
{
    std::uint32_t word = 0;
    std::memcpy(&word, value, sizeof word);
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<char>((word >> shift) & 0xffu));
}

std::string asPly(const TriangleMesh& mesh, const std::vector<std::int32_t>& lines)
{
    std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex " +
                        std::to_string(mesh.vertexCount()) +
                        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                        std::to_string(mesh.triangleCount()) + "\nproperty list uchar int vertex_indices\n";
    if (!lines.empty())
        bytes += "element edge " + std::to_string(lines.size() / 2) + "\nproperty int vertex1\nproperty int vertex2\n";
    bytes += "end_header\n";
    bytes.reserve(bytes.size() + 12 * mesh.vertexCount() + 13 * mesh.triangleCount() + 4 * lines.size());
    for (const float& value : mesh.m_positions)
        appendLittle(bytes, &value);
    for (std::size_t i = 0; i < mesh.m_triangles.size(); ++i)
    {
        if (i % 3 == 0) bytes.push_back(3);
        appendLittle(bytes, &mesh.m_triangles[i]);
    }
    for (const std::int32_t& vertex : lines)
        appendLittle(bytes, &vertex);
    return bytes;
}

std::string asObj(const TriangleMesh& mesh, const std::vector<std::int32_t>& lines)
{
    std::string text = "# metres\n";
    char line[128];
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
    {
        const float* p = &mesh.m_positions[3 * v];  // nine digits give every float back exactly
        std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", p[0], p[1], p[2]);
        text += line;
    }
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    {
        const std::int32_t* c = &mesh.m_triangles[3 * t];
        std::snprintf(line, sizeof line, "f %d %d %d\n", c[0] + 1, c[1] + 1, c[2] + 1);
        text += line;
    }
    for (std::size_t i = 0; i + 1 < lines.size(); i += 2)
        text += "l " + std::to_string(lines[i] + 1) + " " + std::to_string(lines[i + 1] + 1) + "\n";
    return text;
}
}  // namespace

bool writeMesh(const std::string& path, const TriangleMesh& mesh, std::string& error,
               const std::vector<std::int32_t>& lines)
{
    const bool obj = path.size() >= 4 && path.compare(path.size() - 4, 4, ".obj") == 0;
    return writeFileAtomically(path, obj ? asObj(mesh, lines) : asPly(mesh, lines), error);
}

std::string frameName(const std::string& folder, const std::string& stem, int number)
{
    char digits[16];
    std::snprintf(digits, sizeof digits, "%04d", number);
    return folder + "/" + stem + "_" + digits + ".ply";
}
}  // namespace drape
