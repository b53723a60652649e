// A triangle mesh as a caller hands it over: his own arrays, which are read during the call only. Lengths in metres.
// C++11.
#pragma once

#include <cstddef>
#include <cstdint>

namespace drape
{
// Triangles over vertices. Indices must lie in [0, vertexCount); triangles that repeat an index are ignored.
struct MeshDescription
{
    const std::int32_t* m_triangles = nullptr;  // 3 per triangle
    std::size_t m_triangleCount = 0;
    const float* m_positions = nullptr;  // x y z per vertex, m; copied
    std::size_t m_vertexCount = 0;
    // Of an obstacle: only its front counts, the side from which its triangles' corners run counter-clockwise. Cloth
    // behind it is free to come out.
    bool m_oneSided = false;
};
}  // namespace drape
