// Measures how far a cloth's edges are stretched against their lengths at rest.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/mesh.h"

namespace drape
{
// Shares of the edges' first lengths: 0.01 for 1 % longer, negative for shorter.
struct MeshStretch
{
    double m_mean = 0;  // over all edges
    double m_max = 0;
};

class StretchMeter
{
public:
    // Takes the edges of the mesh's triangles and the lines, two vertices each, once, with their lengths. Those without
    // length are left out.
    explicit StretchMeter(const TriangleMesh& cloth, const std::vector<std::int32_t>& lines = {});
    // positions: m, x y z per vertex. Returns zeros for a cloth without edges.
    MeshStretch measure(const std::vector<float>& positions) const;

private:
    struct Edge
    {
        std::int32_t m_vertices[2];
        double m_length;  // m
    };
    std::vector<Edge> m_edges;
};
}  // namespace drape
