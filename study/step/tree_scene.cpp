#include "study/step/tree_scene.h"

#include "bullet_plugin/core/scene/normal_cones.h"
#include "study/trees/tree_builder.h"

namespace drape
{
namespace
{
// A thousandth more than contacts reach, for the rounding of volumes, as the peers' boxes have it.
constexpr float kReachPad = 1.001f;

void addMesh(MeshPool& pool, const TriangleMesh& mesh)
{
    PooledMesh pooled;
    pooled.m_id = MeshId(pool.meshCount());
    pooled.m_topology = buildTopology(mesh.m_triangles.data(), mesh.triangleCount(), mesh.vertexCount());
    pool.add(std::move(pooled));
}
}  // namespace

TreeScene::TreeScene(const std::vector<TriangleMesh>& cloths, const TriangleMesh& obstacle, const TreeMethods& methods,
                     float thickness, float reachScale)
    : m_obstaclePositions(obstacle.m_positions),
      m_thickness(cloths.size(), thickness),
      m_radius(cloths.size(), thickness * reachScale * kReachPad),
      m_reachScale(reachScale)
{
    std::vector<float> rest;
    for (const TriangleMesh& cloth : cloths)
    {
        addMesh(m_cloths, cloth);
        rest.insert(rest.end(), cloth.m_positions.begin(), cloth.m_positions.end());
    }
    addMesh(m_obstacles, obstacle);
    m_cloths.update();
    m_obstacles.update();
    computeNormalCones(m_obstacles.mesh(0).m_topology, m_obstaclePositions.data(), m_vertexCones, m_edgeCones);
    m_clothTree = buildTreeOnHost(methods, m_cloths.triangles(), rest.data(), cloths.size());
    m_obstacleTree = buildTreeOnHost(methods, m_obstacles.triangles(), m_obstaclePositions.data(), 1);
}

ClothView TreeScene::cloth(const float* start, const float* end, std::uint32_t mode) const
{
    return clothView(start, end, m_cloths.triangles().data(), m_cloths.edges().data(),
                     std::uint32_t(m_cloths.vertexCount()), std::uint32_t(m_cloths.triangles().size()), mode, nullptr);
}

ObstacleView TreeScene::obstacle() const
{
    return {m_obstaclePositions.data(), m_obstacles.triangles().data(), m_vertexCones.data(), m_edgeCones.data()};
}

std::size_t TreeScene::featureCount() const
{
    return m_cloths.vertexCount() + m_cloths.triangles().size() + m_cloths.edges().size();
}
}  // namespace drape
