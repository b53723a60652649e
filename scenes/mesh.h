// A triangle mesh as plain arrays: what the loader and the generators make and everything else reads.
//
// Positions are metres in the world frame, y up; indices are zero-based, three a triangle, counter-clockwise seen from
// outside. Functions here keep index validity: valid in, valid out. Cost: linear.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace drape
{
struct TriangleMesh
{
    std::vector<float> m_positions;         // x y z per vertex, m
    std::vector<std::int32_t> m_triangles;  // 3 per triangle

    std::size_t vertexCount() const { return m_positions.size() / 3; }
    std::size_t triangleCount() const { return m_triangles.size() / 3; }
};

struct Bounds
{
    std::array<float, 3> m_low;
    std::array<float, 3> m_high;

    float extent(int axis) const { return m_high[axis] - m_low[axis]; }
    float largestExtent() const;
};

// Bounds of all vertices; zeros for a mesh without any.
Bounds boundsOf(const TriangleMesh& mesh);

// Scales the mesh so that its largest extent is `size` (m, > 0), centres it in x and z and stands it on y = 0.
void placeOnFloor(TriangleMesh& mesh, float size);

// Merges vertices whose three coordinates are equal (−0 equals 0), drops triangles that repeat an index and vertices
// that no triangle uses. Order is kept otherwise. Returns how many triangles were dropped.
std::size_t joinVertices(TriangleMesh& mesh);
// Joins vertices of a mesh that moves to `end` (x y z per vertex) if their positions are equal before and after.
std::size_t joinVertices(TriangleMesh& mesh, std::vector<float>& end);

// Drops triangles that repeat an index and vertices that no triangle uses, from the mesh and from `end` (x y z per
// vertex). Vertices at equal positions stay apart. They are numbered in the order of their first use, as by
// joinVertices(). Returns how many triangles were dropped.
std::size_t keepUsedVertices(TriangleMesh& mesh, std::vector<float>& end);

// Splits every triangle into four at its edges' middles; shared edges stay shared.
TriangleMesh subdivide(const TriangleMesh& mesh);
}  // namespace drape
