// Any bytes as a mesh file: the loader refuses them in one line, or gives a mesh whose every index and number is good.
//
// The first byte chooses the format and which vertices are joined.
#include <cmath>
#include <cstdint>
#include <string>

#include "scenes/mesh_loader.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/input_file.h"

using drape::fuzz::require;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size < 2) return 0;
    const char* const endings[5] = {".obj", ".ply", ".stl", ".gltf", ".glb"};
    const drape::fuzz::InputFile file(endings[data[0] % 5], data + 1, size - 1);
    drape::TriangleMesh mesh;
    std::string error;
    const drape::Joining joining = data[0] / 5 % 2 == 0 ? drape::Joining::ByPosition : drape::Joining::ByIndex;
    drape::LoadReport report;
    const bool loaded = drape::loadMesh(file.path(), joining, mesh, report, error);
    require(loaded == error.empty());
    require(error.find('\n') == std::string::npos);
    if (!loaded) return 0;
    require(mesh.triangleCount() > 0 && mesh.m_positions.size() % 3 == 0 && mesh.m_triangles.size() % 3 == 0);
    for (std::int32_t index : mesh.m_triangles)
        require(index >= 0 && std::size_t(index) < mesh.vertexCount());
    for (float coordinate : mesh.m_positions)
        require(std::isfinite(coordinate));
    require(std::isfinite(report.m_rounding));
    return 0;
}
