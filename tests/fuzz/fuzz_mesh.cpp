// Any bytes as a mesh file: the loader refuses them in one line, or gives a mesh whose every index and number is good.
//
// The first byte chooses the format.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include <unistd.h>

#include "scenes/mesh_loader.h"

namespace
{
// A failure of the test, not of the file: libFuzzer keeps the input.
void require(bool good)
{
    if (!good) std::abort();
}

std::string temporaryFile(const char* ending)
{
    const char* folder = ::access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
    return std::string(folder) + "/drape_fuzz_" + std::to_string(::getpid()) + ending;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size < 2) return 0;
    static const std::string kPaths[5] = {temporaryFile(".obj"), temporaryFile(".ply"), temporaryFile(".stl"),
                                          temporaryFile(".gltf"), temporaryFile(".glb")};
    const std::string& path = kPaths[data[0] % 5];
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data + 1), std::streamsize(size - 1));
    drape::TriangleMesh mesh;
    std::string error;
    const bool loaded = drape::loadMesh(path, mesh, error);
    std::remove(path.c_str());
    require(loaded == error.empty());
    require(error.find('\n') == std::string::npos);
    if (!loaded) return 0;
    require(mesh.triangleCount() > 0 && mesh.m_positions.size() % 3 == 0 && mesh.m_triangles.size() % 3 == 0);
    for (std::int32_t index : mesh.m_triangles)
        require(index >= 0 && std::size_t(index) < mesh.vertexCount());
    for (float coordinate : mesh.m_positions)
        require(std::isfinite(coordinate));
    return 0;
}
