// A triangle mesh as a caller hands it over: the caller's own arrays, which are read during the call only. Lengths in
// metres. C++11.
#pragma once

#include <cstddef>
#include <cstdint>

namespace drape
{
// Triangles over vertices. A mesh with an index outside [0, vertexCount), or without one of its arrays, is refused by
// every call, with an Error; triangles and edges that repeat an index are ignored.
struct MeshDescription
{
    const std::int32_t* m_triangles = nullptr;  // 3 per triangle
    std::size_t m_triangleCount = 0;
    const float* m_positions = nullptr;  // x y z per vertex, m
    std::size_t m_vertexCount = 0;
    // What follows counts in steps alone, not in queries; but Queries::meshPairs takes m_edges.
    // Of an obstacle: only its front counts, the side from which its triangles' corners run counter-clockwise. Cloth
    // behind it is free to come out.
    bool m_oneSided = false;
    // Of a cloth: vertices without a triangle collide as its nodes do.
    bool m_looseVertices = false;
    // Edges of a cloth that are not a triangle's, as of a rope: 2 vertices each. They collide as its triangles' edges
    // do, and so do their vertices. One that an edge of a triangle or an earlier one repeats is ignored.
    const std::int32_t* m_edges = nullptr;
    std::size_t m_edgeCount = 0;
    // Of a cloth: the thickness at which it collides with itself, m; 0: it does not. A pair of its features comes no
    // nearer than this, or than half of the distance that they have at rest where that is less.
    float m_selfThickness = 0.0f;
    // Of a cloth that does: where its nodes are at rest, x y z per vertex, m. Null: m_positions.
    const float* m_restPositions = nullptr;
};
}  // namespace drape
