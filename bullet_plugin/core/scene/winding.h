// Signs that turn the normals of the triangles around a vertex or an edge to one side of the surface, whichever way
// each triangle is wound.
//
// Input: a topology. A sign is +1 or -1 relative to the first triangle there, so that all are +1 where neighbours are
// wound alike. Around a vertex or an edge of a surface a side is always defined, also on a surface that has none as a
// whole (a Möbius strip). O(n); no memory where all neighbours are wound alike.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "topology.h"

namespace drape
{
class WindingSigns
{
public:
    explicit WindingSigns(const Topology& topology);

    // Signs of triangle t for its corner i and for its edge i. A corner has 0 if its triangle is joined to the vertex's
    // first one only through the vertex, in a mesh whose winding is mixed there.
    int atVertex(std::size_t t, int i) const { return m_vertex.empty() ? 1 : m_vertex[t][std::size_t(i)]; }
    int atEdge(std::size_t t, int i) const { return m_edge.empty() ? 1 : m_edge[t][std::size_t(i)]; }

private:
    using CornerSigns = std::array<signed char, 3>;

    bool markTurnedEdges(const Topology& topology);
    void spread(const Topology& topology, std::uint32_t triangle, std::uint32_t vertex);

    std::vector<CornerSigns> m_vertex, m_edge;       // by triangle
    std::vector<std::array<std::uint32_t, 2>> m_at;  // by edge: its first two triangles
};
}  // namespace drape
