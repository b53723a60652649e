// Computes edges, owners and opposite vertices of a triangle mesh.
//
// Input: indices and a vertex count. Output: Triangle and Edge records with indices local to the mesh. Triangles that
// repeat an index, or all three vertices of an earlier triangle, are left out. Exactly one triangle, the first, owns
// every vertex and every edge that triangles use. Edges are numbered by their first use, so the result depends on the
// input alone. O(n) for surfaces, O(n^1.5) at worst.
//
// A vertex without a triangle has none unless it is given a point, or an edge that is not a triangle's. Both are
// triangles without area, behind the others.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared/mesh.h"

namespace drape
{
struct Topology
{
    std::vector<Triangle> m_triangles;
    std::vector<Edge> m_edges;
    // Index as given, per kept triangle; 0xffffffff for those without area that stand for edges and points.
    std::vector<std::uint32_t> m_sourceTriangle;
    std::vector<std::uint32_t> m_edgeTriangle;    // a kept triangle per edge: its owner
    std::vector<std::uint32_t> m_vertexTriangle;  // a kept triangle per vertex; 0xffffffff when unused
    std::vector<std::uint8_t> m_edgeUses;         // triangles per edge, 255 for more
    std::size_t m_vertexCount = 0;
    std::size_t m_faceCount = 0;  // triangles without those that stand for edges and points
};

// triangles: 3 indices each, in [0, vertexCount); check_indices.h checks a caller's.
Topology buildTopology(const std::int32_t* triangles, std::size_t triangleCount, std::size_t vertexCount);

// Adds edges that are not a triangle's, 2 indices each, in [0, vertexCount). Each becomes a triangle that repeats its
// second vertex (kernels/lib/geometry/segment.h). It owns the edge between the two as its first edge, and those of the
// two vertices without an owner. Edges that repeat an index or an existing edge are left out. Call before addPoints().
// O(n log n).
void addEdges(Topology& topology, const std::int32_t* edges, std::size_t edgeCount);

// Adds a point for each vertex without a triangle: a triangle that has the vertex three times and owns it, with an edge
// from the vertex to itself that no triangle owns.
void addPoints(Topology& topology);

// Returns the area, m², of the triangles with finite vertices. A triangle that stands for an edge counts as half of the
// square over it, like a grid's triangle with that side. positions: m, x y z per vertex. O(n).
double surfaceArea(const std::vector<Triangle>& triangles, const float* positions);
}  // namespace drape
