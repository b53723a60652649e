// Finds nodes that went through the obstacle: their path from one step's end to the next met its surface, tested
// exactly.
//
// A node that flew through something thin is not inside of it afterwards, so its depth does not show it. Metres.
#pragma once

#include <vector>

#include "scenes/mesh.h"
#include "oracle/triangle_tree.h"

namespace drape
{
class Crossings
{
public:
    // `positions` holds x y z per node at the start.
    Crossings(const TriangleMesh& obstacle, const std::vector<float>& positions);

    // Call this after every step with the nodes' new positions. Positions that are not finite are left out.
    void follow(const std::vector<float>& positions);
    std::size_t nodes() const;
    // Returns for each node whether it went through.
    const std::vector<bool>& crossed() const { return m_crossed; }

private:
    TriangleTree m_surface;
    std::vector<Vector3> m_last;
    std::vector<bool> m_crossed;
};
}  // namespace drape
