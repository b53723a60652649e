// A triangle mesh as the caller passes it: pointers to the caller's arrays.
//
// Drape reads the arrays during the call only and keeps no pointer. Lengths are metres. C++11.
#pragma once

#include <cstddef>
#include <cstdint>

namespace drape
{
// Triangles over vertices. Every call refuses a mesh with an index outside [0, m_vertexCount) or a missing array, and
// reports an Error. Triangles and edges that repeat an index are ignored. The fields behind m_vertexCount apply to
// steps; queries read m_edges only.
struct MeshDescription
{
    // Vertex indices, 3 per triangle.
    const std::int32_t* m_triangles = nullptr;
    // Number of triangles.
    std::size_t m_triangleCount = 0;
    // Vertex positions, x y z per vertex, m.
    const float* m_positions = nullptr;
    // Number of vertices.
    std::size_t m_vertexCount = 0;
    // Makes only the front of an obstacle solid: the side from which its triangles run counter-clockwise. Cloth behind
    // it may come out.
    bool m_oneSided = false;
    // Lets vertices of a cloth that are in no triangle collide like its other nodes.
    bool m_looseVertices = false;
    // Edges of a cloth that belong to no triangle, such as those of a rope; 2 vertex indices each. They and their
    // vertices collide like the edges and vertices of triangles. Repeated edges are ignored.
    const std::int32_t* m_edges = nullptr;
    // Number of edges in m_edges.
    std::size_t m_edgeCount = 0;
    // Thickness at which a cloth collides with itself, m; 0 turns this off. Two features keep this distance, or half of
    // their distance at rest if that is less.
    float m_selfThickness = 0.0f;
    // Positions of a cloth's nodes at rest, x y z per vertex, m; used with m_selfThickness. Null means m_positions.
    const float* m_restPositions = nullptr;
};
}  // namespace drape
