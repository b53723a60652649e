#include "check_indices.h"

namespace drape
{
bool checkIndices(const MeshDescription& mesh, const char* call, Error& error)
{
    if ((mesh.m_triangleCount > 0 && !mesh.m_triangles) || (mesh.m_vertexCount > 0 && !mesh.m_positions))
    {
        error = Error();
        error.m_call = std::string(call) + ": a mesh without one of its arrays";
        return false;
    }
    for (std::size_t i = 0; i < 3 * mesh.m_triangleCount; ++i)
    {
        const std::int32_t index = mesh.m_triangles[i];
        if (index >= 0 && std::size_t(index) < mesh.m_vertexCount) continue;
        error = Error();
        error.m_call = std::string(call) + ": a mesh with an index out of range";
        error.m_detail = "triangle " + std::to_string(i / 3) + " has the index " + std::to_string(index) + " among " +
                         std::to_string(mesh.m_vertexCount) + " vertices";
        return false;
    }
    return true;
}
}  // namespace drape
