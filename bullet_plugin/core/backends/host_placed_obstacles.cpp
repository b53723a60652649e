#include "host_placed_obstacles.h"

#include <algorithm>

#include "bullet_plugin/core/scene/growing_arrays.h"

namespace drape
{
void HostPlacedObstacles::update(const Scene& scene, std::size_t fresh)
{
    if (!scene.m_anyPosed)
    {
        m_positions = std::vector<float>();
        m_vertexCones = m_edgeCones = std::vector<NormalCone>();
    }
    const bool placesBegin = scene.m_anyPosed && m_positions.empty();
    m_changes.update(scene, placesBegin ? 0 : fresh);
    if (scene.m_anyPosed) place(scene);
}

// Places obstacles exactly as kernels/scene/place_obstacles.cl does.
void HostPlacedObstacles::place(const Scene& scene)
{
    resizeGrowing(m_positions, scene.m_obstaclePositions.size());
    resizeGrowing(m_vertexCones, scene.m_vertexCones.size());
    resizeGrowing(m_edgeCones, scene.m_edgeCones.size());
    for (std::size_t slot = 0; slot < scene.m_places.size(); ++slot)
    {
        if (!moved(slot)) continue;
        const ObstaclePlace* at = &scene.m_places[slot];
        const MeshOffsets first = scene.m_obstacles.begin(slot), last = scene.m_obstacles.begin(slot + 1);
        for (std::uint32_t vertex = first.m_vertex; vertex < last.m_vertex; ++vertex)
        {
            const Vec3 p = placedPosition(at, vec3Load(scene.m_obstaclePositions.data(), vertex));
            const float coordinates[3] = {p.x, p.y, p.z};
            std::copy(coordinates, coordinates + 3, &m_positions[3 * std::size_t(vertex)]);
            m_vertexCones[vertex] = placedCone(at, scene.m_vertexCones[vertex]);
        }
        for (std::uint32_t edge = first.m_edge; edge < last.m_edge; ++edge)
            m_edgeCones[edge] = placedCone(at, scene.m_edgeCones[edge]);
    }
}

ObstacleView HostPlacedObstacles::view(const Scene& scene) const
{
    const Triangle* triangles = scene.m_obstacles.triangles().data();
    if (scene.m_anyPosed) return {m_positions.data(), triangles, m_vertexCones.data(), m_edgeCones.data()};
    return {scene.m_obstaclePositions.data(), triangles, scene.m_vertexCones.data(), scene.m_edgeCones.data()};
}
}  // namespace drape
