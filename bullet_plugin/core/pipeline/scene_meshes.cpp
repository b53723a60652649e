// Meshes of the scene: measures a mesh when it is added or moved, and joins all meshes of a side.
#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_plugin/core/scene/morton_order.h"
#include "bullet_plugin/core/scene/normal_cones.h"
#include "bullet_plugin/core/scene/reserve_room.h"
#include "implementation.h"
#include "bullet_plugin/core/backend_choice/scene_work.h"

namespace drape
{
PooledMesh Pipeline::Implementation::makeMesh(const MeshDescription& description)
{
    PooledMesh mesh;
    mesh.m_id = m_nextId++;
    mesh.m_topology = buildTopology(description.m_triangles, description.m_triangleCount, description.m_vertexCount);
    addEdges(mesh.m_topology, description.m_edges, description.m_edgeCount);
    if (description.m_looseVertices) addPoints(mesh.m_topology);
    mesh.m_positions.assign(description.m_positions, description.m_positions + 3 * description.m_vertexCount);
    mesh.m_area = surfaceArea(mesh.m_topology.m_triangles, mesh.m_positions.data());
    mesh.m_order = mortonOrderOnHost(mesh.m_topology.m_triangles, mesh.m_positions.data());
    return mesh;
}

void Pipeline::Implementation::measureObstacle(PooledMesh& mesh)
{
    computeNormalCones(mesh.m_topology, mesh.m_positions.data(), mesh.m_vertexCones, mesh.m_edgeCones);
    const float infinity = std::numeric_limits<float>::infinity();
    mesh.m_box = MeshBox{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (std::size_t i = 0; i < mesh.m_positions.size(); ++i)
    {
        const float coordinate = mesh.m_positions[i];
        if (!std::isfinite(coordinate)) continue;
        mesh.m_box.m_low[i % 3] = std::min(mesh.m_box.m_low[i % 3], coordinate);
        mesh.m_box.m_high[i % 3] = std::max(mesh.m_box.m_high[i % 3], coordinate);
    }
    mesh.m_longestEdge = 0;
    for (const Edge& edge : mesh.m_topology.m_edges)
    {
        const Vec3 a = vec3Load(mesh.m_positions.data(), edge.m_vertices[0]);
        const float length = vec3Length(vec3Sub(vec3Load(mesh.m_positions.data(), edge.m_vertices[1]), a));
        if (std::isfinite(length)) mesh.m_longestEdge = std::max(mesh.m_longestEdge, length);
    }
}

void Pipeline::Implementation::placeMesh(std::size_t slot)
{
    PooledMesh& mesh = m_scene.m_obstacles.mesh(slot);
    const ObstaclePlacing& placing = mesh.m_placing;
    ObstaclePlace& place = m_scene.m_places[slot];
    std::copy(placing.m_end.begin(), placing.m_end.end(), place.m_pose);
    place.m_posed = placing.m_posed;
    place.m_firstVertex = mesh.m_firstVertex;
    place.m_firstEdge = mesh.m_firstEdge;
    m_scene.m_anyPosed = m_scene.m_anyPosed || placing.m_posed;
    const MeshBox box = placing.m_posed ? placedBox(placing.m_end, mesh.m_box) : mesh.m_box;
    float farthest = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        for (float bound : {box.m_low[axis], box.m_high[axis]})
            if (std::isfinite(bound)) farthest = std::max(farthest, std::fabs(bound));
    }
    mesh.m_coordinateStep = std::nextafter(farthest, std::numeric_limits<float>::infinity()) - farthest;
}

void Pipeline::Implementation::joinCloths(std::size_t first)
{
    const MeshPool& cloths = m_scene.m_cloths;
    forgetNodes();
    const std::size_t coordinates = 3 * cloths.vertexCount();
    if (m_scene.m_clothNodes.room() < coordinates)
    {
        // The contents are lost. Adds a quarter of spare room unless this is the first time.
        const std::size_t room = coordinates + (first > 0 ? coordinates / 4 : 0);
        m_scene.m_clothNodes.reserve(device(), room);
        first = 0;
    }
    for (std::size_t slot = first; slot < cloths.meshCount(); ++slot)
    {
        const PooledMesh& mesh = cloths.mesh(slot);
        for (float* target : {m_scene.m_clothNodes.start(), m_scene.m_clothNodes.end()})
        {
            std::copy(mesh.m_positions.begin(), mesh.m_positions.end(), target + 3 * std::size_t(mesh.m_firstVertex));
        }
    }
    joinRest();
}

void Pipeline::Implementation::joinRest()
{
    const MeshPool& cloths = m_scene.m_cloths;
    m_scene.m_anySelf = false;
    for (std::size_t slot = 0; slot < cloths.meshCount(); ++slot)
        m_scene.m_anySelf |= cloths.mesh(slot).m_selfThickness > 0.0f && !cloths.mesh(slot).m_vacant;
    m_scene.m_clothRest.clear();
    for (std::size_t slot = 0; slot < cloths.meshCount() && m_scene.m_anySelf; ++slot)
    {
        const PooledMesh& mesh = cloths.mesh(slot);
        const std::vector<float>& rest = mesh.m_rest.empty() ? mesh.m_positions : mesh.m_rest;
        m_scene.m_clothRest.insert(m_scene.m_clothRest.end(), rest.begin(), rest.end());
    }
}

void Pipeline::Implementation::joinObstacles(std::size_t first)
{
    MeshPool& pool = m_scene.m_obstacles;
    const MeshFirsts kept = pool.begin(first);
    m_scene.m_obstaclePositions.resize(3 * std::size_t(kept.m_vertex));
    m_scene.m_vertexCones.resize(kept.m_vertex);
    m_scene.m_edgeCones.resize(kept.m_edge);
    m_scene.m_places.resize(pool.meshCount());
    if (pool.meshCount() == 0) m_scene.m_anyPosed = false;
    const MeshFirsts end = pool.begin(pool.meshCount());
    reserveRoom(m_scene.m_obstaclePositions, 3 * std::size_t(end.m_vertex));
    reserveRoom(m_scene.m_vertexCones, end.m_vertex);
    reserveRoom(m_scene.m_edgeCones, end.m_edge);
    const auto append = [](auto& all, const auto& own) { all.insert(all.end(), own.begin(), own.end()); };
    for (std::size_t slot = first; slot < pool.meshCount(); ++slot)
    {
        PooledMesh& mesh = pool.mesh(slot);
        append(m_scene.m_obstaclePositions, mesh.m_positions);
        append(m_scene.m_vertexCones, mesh.m_vertexCones);
        append(m_scene.m_edgeCones, mesh.m_edgeCones);
        mesh.m_placedAnew = true;
        placeMesh(slot);
    }
}

void Pipeline::Implementation::joinScene()
{
    MeshPool& cloths = m_scene.m_cloths;
    MeshPool& obstacles = m_scene.m_obstacles;
    cloths.update();
    obstacles.update();
    if (m_clothRevision != cloths.revision())
    {
        joinCloths(cloths.firstSince(m_clothRevision));
        m_clothRevision = cloths.revision();
    }
    if (m_obstacleRevision != obstacles.revision())
    {
        joinObstacles(obstacles.firstSince(m_obstacleRevision));
        m_obstacleRevision = obstacles.revision();
    }
}
}  // namespace drape
