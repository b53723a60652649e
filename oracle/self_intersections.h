// The exact check of cloth with itself and with other cloth: pairs of triangles of one mesh that intersect.
//
// Shares no code with the product. Input: the triangles of all cloths as one mesh, and their nodes after each step (m).
// Triangles that share one vertex intersect if they have another point in common. Triangles that share an edge
// intersect if they are folded flat onto each other. A pair with three common vertices counts for nothing. Guarantee:
// exact. Cost: some microseconds a triangle for cloth that lies in layers.
#pragma once

#include <utility>

#include "oracle/triangle_tree.h"
#include "scenes/mesh.h"

namespace drape
{
class SelfIntersections
{
public:
    explicit SelfIntersections(const TriangleMesh& cloths);

    // Returns the intersecting pairs where the nodes now are (x y z per node), each as two triangle indices, the lower
    // one first. Triangles of nodes that are not finite are left out.
    std::vector<std::pair<std::int32_t, std::int32_t>> find(const std::vector<float>& positions);

private:
    bool intersect(std::int32_t first, std::int32_t second) const;

    TriangleTree m_tree;
};
}  // namespace drape
