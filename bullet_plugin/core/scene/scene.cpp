#include "scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/lib/geometry/vec3.h"
#include "morton_order.h"
#include "normal_cones.h"
#include "growing_arrays.h"

namespace drape
{
namespace
{
// Computes data that depends on an obstacle's positions.
void measureObstacle(PooledMesh& mesh)
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
}  // namespace

PooledMesh Scene::makeMesh(const MeshDescription& description)
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

MeshId Scene::addCloth(const MeshDescription& description)
{
    PooledMesh mesh = makeMesh(description);
    if (description.m_selfThickness > 0.0f)
    {
        mesh.m_selfThickness = description.m_selfThickness;
        if (description.m_restPositions)
            mesh.m_rest.assign(description.m_restPositions,
                               description.m_restPositions + 3 * description.m_vertexCount);
    }
    m_cloths.add(std::move(mesh));
    return m_nextId - 1;
}

MeshId Scene::addObstacle(const MeshDescription& description)
{
    PooledMesh mesh = makeMesh(description);
    mesh.m_oneSided = description.m_oneSided;
    measureObstacle(mesh);
    m_obstacles.add(std::move(mesh));
    return m_nextId - 1;
}

void Scene::remove(MeshId id)
{
    if (!m_cloths.remove(id)) m_obstacles.remove(id);
}

void Scene::moveObstacle(MeshId id, const float* positions)
{
    const std::size_t slot = m_obstacles.existingSlot(id);
    PooledMesh& mesh = m_obstacles.mesh(slot);
    const auto replace = [](auto& all, std::size_t first, const auto& own)
    { std::copy(own.begin(), own.end(), all.begin() + std::ptrdiff_t(first)); };
    mesh.m_positions.assign(positions, positions + mesh.m_positions.size());
    measureObstacle(mesh);
    mesh.m_area = surfaceArea(mesh.m_topology.m_triangles, positions);
    replace(m_obstaclePositions, 3 * std::size_t(mesh.m_firstVertex), mesh.m_positions);
    replace(m_vertexCones, mesh.m_firstVertex, mesh.m_vertexCones);
    replace(m_edgeCones, mesh.m_firstEdge, mesh.m_edgeCones);
    mesh.m_positionsRevision = ++m_positionsRevision;
    mesh.m_changed = true;
    updatePlace(slot);
}

void Scene::placeObstacle(MeshId id, const float startPose[DRAPE_MAP_FLOATS], const float endPose[DRAPE_MAP_FLOATS])
{
    const std::size_t slot = m_obstacles.existingSlot(id);
    PooledMesh& mesh = m_obstacles.mesh(slot);
    ObstaclePoses& poses = mesh.m_poses;
    const bool stays = poses.m_posed && std::equal(poses.m_end.begin(), poses.m_end.end(), endPose);
    poses.m_posed = true;
    std::copy(startPose, startPose + DRAPE_MAP_FLOATS, poses.m_start.begin());
    std::copy(endPose, endPose + DRAPE_MAP_FLOATS, poses.m_end.begin());
    if (stays) return;
    mesh.m_changed = true;
    updatePlace(slot);
    ++m_posesRevision;
}

void Scene::markObstaclesUsed()
{
    for (std::size_t slot = 0; slot < m_obstacles.meshCount(); ++slot)
        m_obstacles.mesh(slot).m_changed = false;
}

void Scene::updatePlace(std::size_t slot)
{
    PooledMesh& mesh = m_obstacles.mesh(slot);
    const ObstaclePoses& poses = mesh.m_poses;
    ObstaclePlace& place = m_places[slot];
    std::copy(poses.m_end.begin(), poses.m_end.end(), place.m_pose);
    place.m_posed = poses.m_posed;
    place.m_firstVertex = mesh.m_firstVertex;
    place.m_firstEdge = mesh.m_firstEdge;
    m_anyPosed = m_anyPosed || poses.m_posed;
    const MeshBox box = poses.m_posed ? placedBox(poses.m_end, mesh.m_box) : mesh.m_box;
    float farthest = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        for (float bound : {box.m_low[axis], box.m_high[axis]})
            if (std::isfinite(bound)) farthest = std::max(farthest, std::fabs(bound));
    }
    mesh.m_coordinateStep = std::nextafter(farthest, std::numeric_limits<float>::infinity()) - farthest;
}

void Scene::joinCloths(std::size_t first, Device* device)
{
    const std::size_t coordinates = 3 * m_cloths.vertexCount();
    if (m_clothNodes.room() < coordinates)
    {
        // The contents are lost. Adds a quarter of spare room unless this is the first time.
        const std::size_t room = coordinates + (first > 0 ? coordinates / 4 : 0);
        m_clothNodes.reserve(device, room);
        first = 0;
    }
    for (std::size_t slot = first; slot < m_cloths.meshCount(); ++slot)
    {
        const PooledMesh& mesh = m_cloths.mesh(slot);
        for (float* target : {m_clothNodes.start(), m_clothNodes.end()})
        {
            std::copy(mesh.m_positions.begin(), mesh.m_positions.end(), target + 3 * std::size_t(mesh.m_firstVertex));
        }
    }
    joinRest();
}

void Scene::joinRest()
{
    m_anySelf = false;
    for (std::size_t slot = 0; slot < m_cloths.meshCount(); ++slot)
        m_anySelf |= m_cloths.mesh(slot).m_selfThickness > 0.0f && !m_cloths.mesh(slot).m_vacant;
    m_clothRest.clear();
    for (std::size_t slot = 0; slot < m_cloths.meshCount() && m_anySelf; ++slot)
    {
        const PooledMesh& mesh = m_cloths.mesh(slot);
        const std::vector<float>& rest = mesh.m_rest.empty() ? mesh.m_positions : mesh.m_rest;
        m_clothRest.insert(m_clothRest.end(), rest.begin(), rest.end());
    }
}

void Scene::joinObstacles(std::size_t first)
{
    const MeshOffsets kept = m_obstacles.begin(first);
    m_obstaclePositions.resize(3 * std::size_t(kept.m_vertex));
    m_vertexCones.resize(kept.m_vertex);
    m_edgeCones.resize(kept.m_edge);
    m_places.resize(m_obstacles.meshCount());
    if (m_obstacles.meshCount() == 0) m_anyPosed = false;
    const MeshOffsets end = m_obstacles.begin(m_obstacles.meshCount());
    reserveGrowing(m_obstaclePositions, 3 * std::size_t(end.m_vertex));
    reserveGrowing(m_vertexCones, end.m_vertex);
    reserveGrowing(m_edgeCones, end.m_edge);
    const auto append = [](auto& all, const auto& own) { all.insert(all.end(), own.begin(), own.end()); };
    for (std::size_t slot = first; slot < m_obstacles.meshCount(); ++slot)
    {
        PooledMesh& mesh = m_obstacles.mesh(slot);
        append(m_obstaclePositions, mesh.m_positions);
        append(m_vertexCones, mesh.m_vertexCones);
        append(m_edgeCones, mesh.m_edgeCones);
        mesh.m_changed = true;
        updatePlace(slot);
    }
}

void Scene::join(Device* device)
{
    m_cloths.update();
    m_obstacles.update();
    if (m_joinedCloths != m_cloths.revision())
    {
        joinCloths(m_cloths.firstSince(m_joinedCloths), device);
        m_joinedCloths = m_cloths.revision();
    }
    if (m_joinedObstacles != m_obstacles.revision())
    {
        joinObstacles(m_obstacles.firstSince(m_joinedObstacles));
        m_joinedObstacles = m_obstacles.revision();
    }
}

void Scene::pinNodes(Device& device)
{
    if (m_clothNodes.room() == 0) return;
    m_clothNodes.release();
    joinCloths(0, &device);
}

void Scene::giveBackRoom()
{
    m_cloths.giveBackRoom();
    m_obstacles.giveBackRoom();
    shrinkSparse(m_clothRest);
    shrinkSparse(m_obstaclePositions);
    shrinkSparse(m_vertexCones);
    shrinkSparse(m_edgeCones);
    shrinkSparse(m_places);
}
}  // namespace drape
