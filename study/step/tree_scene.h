// The meshes of a step over trees: both sides joined, their trees, and what does not change from step to step.
#pragma once

#include <vector>

#include "bullet_plugin/core/scene/mesh_pool.h"
#include "kernels/lib/narrow_phase/pair_contact.h"
#include "scenes/mesh.h"
#include "study/trees/tree.h"
#include "study/methods.h"

namespace drape
{
struct TreeScene
{
    // Builds the trees from the positions as given. thickness: m, of every pair. reachScale: contacts reach to
    // thickness × reachScale.
    TreeScene(const std::vector<TriangleMesh>& cloths, const TriangleMesh& obstacle, const TreeMethods& methods,
              float thickness, float reachScale);

    ClothView cloth(const float* start, const float* end, std::uint32_t mode) const;
    ObstacleView obstacle() const;
    // Slots of contacts of the cloths' nodes, faces and edges.
    std::size_t featureCount() const;

    MeshPool m_cloths, m_obstacles;
    Tree m_clothTree, m_obstacleTree;
    std::vector<float> m_obstaclePositions;  // m, x y z per vertex
    std::vector<NormalCone> m_vertexCones, m_edgeCones;
    std::vector<float> m_thickness;  // m, per cloth
    std::vector<float> m_radius;     // m, per cloth: by how much its volumes grow
    float m_reachScale;
};
}  // namespace drape
