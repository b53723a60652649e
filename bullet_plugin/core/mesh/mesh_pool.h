// All meshes of one side (cloths or obstacles) as one: vertices, triangles, edges and leaf order joined end to end.
//
// Job: keep the meshes and join them into arrays; revision() tells when those changed, firstSince() from which mesh on.
// A mesh keeps its id; its slot is its place in the joined arrays, which update() makes current. A mesh that comes goes
// behind the others; one that goes leaves its slot vacant, as of a mesh that has no pair, until more is vacant than
// not: so either costs what the mesh holds, not what the pool does. Host memory only.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh_id.h"
#include "obstacle_placing.h"
#include "topology.h"

namespace drape
{
struct PooledMesh
{
    MeshId m_id = kNoMesh;
    Topology m_topology;
    std::vector<float> m_positions;         // m, as last given: in its own frame where it has a place, else the world's
    double m_area = 0;                      // m², of the triangles
    bool m_oneSided = false;                // obstacles only: see MeshDescription
    float m_selfThickness = 0;              // m, cloths only, likewise
    std::vector<float> m_rest;              // m, of cloths that collide with themselves
    float m_coordinateStep = 0;             // m, obstacles only: distance of floats where it reaches farthest out
    std::vector<NormalCone> m_vertexCones;  // obstacles only
    std::vector<NormalCone> m_edgeCones;
    MeshBox m_box = {};         // m, of the positions, obstacles only
    float m_longestEdge = 0;    // m, obstacles only
    ObstaclePlacing m_placing;  // obstacles only
    bool m_placedAnew = false;  // obstacles only: new, or given other positions or a place, since the last step
    std::uint32_t m_given = 0;  // obstacles only: when its positions were given anew, by Scene::m_obstacleMotion
    std::vector<std::uint32_t> m_order;  // leaf order, local triangles
    std::uint32_t m_firstVertex = 0;
    std::uint32_t m_firstTriangle = 0;
    std::uint32_t m_firstEdge = 0;
    std::uint32_t m_joined = 0;  // the pool's revision when it took its place
    bool m_vacant = false;       // gone, but for its place
};

// Slots from m_first up to m_last.
struct SlotRange
{
    std::size_t m_first, m_last;
};

class MeshPool
{
public:
    // Ids must rise. Slots of the others stay until update().
    void add(PooledMesh mesh);
    // Returns false when the id is not of this pool. So do they here.
    bool remove(MeshId id);

    // With vacant ones.
    std::size_t meshCount() const { return m_meshes.size(); }
    PooledMesh& mesh(std::size_t slot) { return m_meshes[slot]; }
    const PooledMesh& mesh(std::size_t slot) const { return m_meshes[slot]; }
    // meshCount() when the id is not, or no longer, of this pool.
    std::size_t slot(MeshId id) const;
    // Slots of the meshes that hold a joined vertex or edge.
    std::size_t slotOfVertex(std::uint32_t vertex) const;
    std::size_t slotOfEdge(std::uint32_t edge) const;

    // Joins what came since the last call; the joined arrays are valid after it. Free when nothing did.
    void update();
    // Gives back room that only earlier, larger pools needed. The joined arrays move.
    void giveBackRoom();
    // Counts up with every update that changed something.
    std::uint32_t revision() const { return m_revision; }
    // The first slot that took its place after that revision; those before are as they were, but for vacancies.
    std::size_t firstSince(std::uint32_t revision) const;
    // Where a slot's vertices, triangles and edges begin; of meshCount(), where all end.
    MeshFirsts begin(std::size_t slot) const;
    // Of meshes that are there.
    std::size_t presentTriangles() const { return m_triangleCount - m_vacantTriangles; }
    // The same without triangles that stand for edges and points.
    std::size_t presentFaces() const { return m_faceCount; }

    std::size_t vertexCount() const { return m_vertexCount; }
    const std::vector<Triangle>& triangles() const { return m_triangles; }
    const std::vector<Edge>& edges() const { return m_edges; }
    const std::vector<MeshFirsts>& firsts() const { return m_firsts; }

private:
    // Gives vacant slots back: all of them, or the last of those that have their places.
    bool hasWideGaps() const;
    void closeGaps();
    void dropLastVacant();
    void forget(const PooledMesh& vacant);
    void join(std::size_t slot);

    std::vector<PooledMesh> m_meshes;
    std::vector<MeshId> m_ids;  // of the meshes, next to each other to be searched
    std::vector<Triangle> m_triangles;
    std::vector<Edge> m_edges;
    std::vector<MeshFirsts> m_firsts;
    std::size_t m_vertexCount = 0;
    std::size_t m_triangleCount = 0;  // of all slots
    std::size_t m_faceCount = 0;      // of meshes that are there
    std::size_t m_vacantTriangles = 0;
    std::size_t m_vacantCount = 0;
    std::size_t m_placed = 0;  // leading slots whose places in the joined arrays stand
    std::uint32_t m_revision = 0;
    bool m_changed = false;
};
}  // namespace drape
