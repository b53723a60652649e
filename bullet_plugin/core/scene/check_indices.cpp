#include "check_indices.h"

namespace drape
{
bool checkIndices(const MeshDescription& mesh, const char* call, Error& error)
{
    if ((mesh.m_triangleCount > 0 && !mesh.m_triangles) || (mesh.m_vertexCount > 0 && !mesh.m_positions) ||
        (mesh.m_edgeCount > 0 && !mesh.m_edges))
    {
        error = Error();
        error.m_kind = ErrorKind::Input;
        error.m_call = std::string(call) + ": a mesh without one of its arrays";
        return false;
    }
    const auto inRange = [&](const std::int32_t* indices, std::size_t count, std::size_t each, const char* what)
    {
        for (std::size_t i = 0; i < count * each; ++i)
        {
            const std::int32_t index = indices[i];
            if (index >= 0 && std::size_t(index) < mesh.m_vertexCount) continue;
            error = Error();
            error.m_kind = ErrorKind::Input;
            error.m_call = std::string(call) + ": a mesh with an index out of range";
            error.m_detail = what + (" " + std::to_string(i / each)) + " has the index " + std::to_string(index) +
                             " among " + std::to_string(mesh.m_vertexCount) + " vertices";
            return false;
        }
        return true;
    };
    return inRange(mesh.m_triangles, mesh.m_triangleCount, 3, "triangle") &&
           inRange(mesh.m_edges, mesh.m_edgeCount, 2, "edge");
}
}  // namespace drape
