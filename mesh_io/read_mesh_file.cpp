#include "mesh_io/read_mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "mesh_io/read_file.h"
#include "mesh_io/readers.h"

namespace drape
{
namespace
{
std::string endingOf(const std::string& path)
{
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending;
}

std::string parse(const std::string& path, const std::string& ending, const std::string& bytes, MeshFile& mesh)
{
    const FindBuffer findBuffer = [&path](const std::string& uri, std::string& found) -> std::string
    {
        const std::string file = (std::filesystem::path(path).parent_path() / uri).string();
        const std::string problem = readWholeFile(file, "buffer", found);
        return problem.empty() ? "" : file + ": " + problem;
    };
    if (ending == ".obj") return readObj(bytes, mesh);
    if (ending == ".ply") return readPly(bytes, mesh);
    if (ending == ".stl") return readStl(bytes, mesh);
    if (bytes.compare(0, 4, "glTF") == 0) return readGlb(bytes, findBuffer, mesh);
    return readGltf(bytes, findBuffer, mesh);
}

// Vertices that no face uses may be anything: scanners write NaN for points that they did not see.
std::string cornersProblem(const MeshFile& mesh)
{
    if (mesh.faceCount() == 0) return "no triangles";
    for (const std::int32_t corner : mesh.m_corners)
        for (int axis = 0; axis < 3; ++axis)
        {
            const std::size_t vertex = static_cast<std::size_t>(corner);
            const double value = mesh.m_positions[3 * vertex + static_cast<std::size_t>(axis)];
            if (std::isfinite(value)) continue;
            const std::string place = mesh.m_hasIndices ? "vertex " + std::to_string(vertex + 1)
                                                        : "triangle " + std::to_string(vertex / 3 + 1);
            return place + ": a coordinate is " + (std::isnan(value) ? "NaN" : "infinite");
        }
    return "";
}

// Removes line breaks: a message may quote the file's text.
std::string oneLine(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, '?');
    return text;
}
}  // namespace

bool readMeshFile(const std::string& path, MeshFile& mesh, std::string& error)
{
    mesh = MeshFile();
    std::string bytes;
    const std::string ending = endingOf(path);
    const auto known = {".obj", ".ply", ".stl", ".gltf", ".glb"};
    std::string problem = readWholeFile(path, "mesh", bytes);
    if (problem.empty() && std::find(known.begin(), known.end(), ending) == known.end())
        problem = std::string("not a mesh: its name ends with none of .obj, .ply, .stl, .gltf and .glb");
    if (problem.empty()) problem = parse(path, ending, bytes, mesh);
    if (problem.empty()) problem = cornersProblem(mesh);
    if (!problem.empty()) error = oneLine(path + ": " + problem);
    return problem.empty();
}
}  // namespace drape
