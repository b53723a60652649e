// All meshes of one side (cloths or obstacles) as one: vertices, triangles, edges and leaf order joined end to end.
//
// Job: keep the meshes and join them into arrays. revision() reports changes of the arrays, firstSince() the first
// changed mesh. A mesh keeps its id. Its slot is its index in the joined arrays, which update() makes current. A new
// mesh is appended. A removed mesh leaves its slot vacant, like a mesh without a pair, until more is vacant than in
// use. Adding or removing therefore costs in proportion to the mesh, not the pool. Host memory only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mesh_id.h"
#include "obstacle_poses.h"
#include "topology.h"

namespace drape
{
struct PooledMesh
{
    MeshId m_id = kNoMesh;
    Topology m_topology;
    std::vector<float> m_positions;         // m, as last given: in its own frame if it has a pose, else the world's
    double m_area = 0;                      // m², of the triangles
    bool m_oneSided = false;                // obstacles only: see MeshDescription
    float m_selfThickness = 0;              // m, cloths only: see MeshDescription
    std::vector<float> m_rest;              // m, of cloths that collide with themselves
    float m_coordinateStep = 0;             // m, obstacles only: distance of floats where it reaches farthest out
    std::vector<NormalCone> m_vertexCones;  // obstacles only
    std::vector<NormalCone> m_edgeCones;
    MeshBox m_box = {};                     // m, of the positions, obstacles only
    float m_longestEdge = 0;                // m, obstacles only
    ObstaclePoses m_poses;                  // obstacles only
    bool m_changed = false;                 // obstacles only: new, or with new positions or pose, since the last step
    std::uint32_t m_positionsRevision = 0;  // obstacles only: the scene's when its positions were last set
    std::vector<std::uint32_t> m_order;     // leaf order, local triangles
    std::uint32_t m_firstVertex = 0;
    std::uint32_t m_firstTriangle = 0;
    std::uint32_t m_firstEdge = 0;
    std::uint32_t m_joined = 0;  // the pool's revision when its position changed last
    bool m_vacant = false;       // removed; its slot remains
};

// Returns whether the box of any of an obstacle's triangles meets the box (m, in the frame of its positions as given).
// O(n).
bool anyTriangleIn(const PooledMesh& mesh, const float low[3], const float high[3]);

// Slots from m_first up to m_last.
struct SlotRange
{
    std::size_t m_first, m_last;
};

class MeshPool
{
public:
    // Adds a mesh; ids must rise. Slots of the other meshes stay until update().
    void add(PooledMesh mesh);
    // Returns false if `id` is not in this pool.
    bool remove(MeshId id);

    // Returns the number of slots, vacant ones included.
    std::size_t meshCount() const { return m_meshes.size(); }
    PooledMesh& mesh(std::size_t slot) { return m_meshes[slot]; }
    const PooledMesh& mesh(std::size_t slot) const { return m_meshes[slot]; }
    // Returns the mesh's slot; meshCount() if the id is not, or no longer, in this pool.
    std::size_t slot(MeshId id) const;
    // Returns the slot of a mesh that must exist.
    std::size_t existingSlot(MeshId id) const;
    const PooledMesh& existing(MeshId id) const { return m_meshes[existingSlot(id)]; }
    // Return the slot of the mesh that contains a joined vertex or edge.
    std::size_t slotOfVertex(std::uint32_t vertex) const;
    std::size_t slotOfEdge(std::uint32_t edge) const;

    // Joins the meshes added since the last call; the joined arrays are valid afterwards. Free without changes.
    void update();
    // Returns whether update() would change nothing.
    bool isJoined() const { return !m_changed && !hasWideGaps(); }
    // Releases memory that only earlier, larger pools needed. The joined arrays move.
    void giveBackRoom();
    // Returns a number that rises with every update that changed something.
    std::uint32_t revision() const { return m_revision; }
    // Returns the first slot that changed after that revision; earlier ones are unchanged, except for vacancies.
    std::size_t firstSince(std::uint32_t revision) const;
    // Returns the offsets of a slot's vertices, triangles and edges; for meshCount() their ends.
    MeshOffsets begin(std::size_t slot) const;
    // Counts triangles of meshes that are not removed.
    std::size_t presentTriangles() const { return m_triangleCount - m_vacantTriangles; }
    // Counts the same triangles, without those that stand for edges and points.
    std::size_t presentFaces() const { return m_faceCount; }
    std::size_t presentMeshes() const
    {
        return std::size_t(
            std::count_if(m_meshes.begin(), m_meshes.end(), [](const PooledMesh& mesh) { return !mesh.m_vacant; }));
    }

    std::size_t vertexCount() const { return m_vertexCount; }
    const std::vector<Triangle>& triangles() const { return m_triangles; }
    const std::vector<Edge>& edges() const { return m_edges; }

private:
    bool hasWideGaps() const;
    // Releases vacant slots: all of them, or the last ones.
    void closeGaps();
    void dropLastVacant();
    void forget(const PooledMesh& vacant);
    void join(std::size_t slot);

    std::vector<PooledMesh> m_meshes;
    std::vector<MeshId> m_ids;  // the meshes' ids, contiguous for the search
    std::vector<Triangle> m_triangles;
    std::vector<Edge> m_edges;
    std::vector<MeshOffsets> m_firsts;
    std::size_t m_vertexCount = 0;
    std::size_t m_triangleCount = 0;  // in all slots
    std::size_t m_faceCount = 0;      // triangles of the meshes in use
    std::size_t m_vacantTriangles = 0;
    std::size_t m_vacantCount = 0;
    std::size_t m_placed = 0;  // leading slots whose positions in the joined arrays are valid
    std::uint32_t m_revision = 0;
    bool m_changed = false;
};
}  // namespace drape
