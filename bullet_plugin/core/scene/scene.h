// The meshes of both sides, and the arrays in which back ends read all of them at once.
//
// Job: add, remove, deform and place meshes; join them. Output: the joined arrays, valid after join(), and revisions
// that report their changes. Guarantee: a mesh keeps its id, and ids are not reused. Cost: in proportion to the meshes
// that changed. Only this class and its tests write the members.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth_nodes.h"
#include "drape/mesh_description.h"
#include "kernels/shared/motion.h"
#include "mesh_pool.h"

namespace drape
{
struct Scene
{
    MeshPool m_cloths;
    MeshPool m_obstacles;
    ClothNodes m_clothNodes;
    bool m_anySelf = false;                  // true if a cloth collides with itself
    std::vector<float> m_clothRest;          // m, joined, at rest; empty without m_anySelf
    std::vector<float> m_obstaclePositions;  // m, joined, as given
    std::vector<NormalCone> m_vertexCones;   // joined, as the positions
    std::vector<NormalCone> m_edgeCones;
    std::vector<ObstaclePlace> m_places;    // per obstacle slot
    std::uint32_t m_positionsRevision = 0;  // counts up when an obstacle gets new positions
    std::uint32_t m_posesRevision = 0;      // counts up when an obstacle gets a new pose
    bool m_anyPosed = false;                // false: all positions are the world's; stays while there are obstacles

    explicit Scene(MeshId firstId = 0) : m_nextId(firstId) {}

    // Add a mesh whose indices are in range, see Pipeline.
    MeshId addCloth(const MeshDescription& description);
    MeshId addObstacle(const MeshDescription& description);
    void remove(MeshId id);
    // Returns the id of the next mesh.
    MeshId nextId() const { return m_nextId; }

    // Change an obstacle of the joined arrays, see Pipeline.
    void moveObstacle(MeshId id, const float* positions);
    void placeObstacle(MeshId id, const float startPose[DRAPE_MAP_FLOATS], const float endPose[DRAPE_MAP_FLOATS]);
    // Records that a step, or the preparation of one, used the obstacles as they are now.
    void markObstaclesUsed();

    // Returns whether the joined arrays are current.
    bool isJoined() const { return m_cloths.isJoined() && m_obstacles.isJoined(); }
    // Joins the meshes. Nodes may move, and their contents are then lost. device: for pinned memory, null for none.
    void join(Device* device);
    // Moves the joined nodes into memory that the device can copy fast. Their contents are lost.
    void pinNodes(Device& device);
    // Releases memory that only earlier, larger scenes needed. The joined arrays move.
    void giveBackRoom();

    // Counts the nodes, faces and edges of all cloths.
    std::size_t featureCount() const
    {
        return m_cloths.vertexCount() + m_cloths.triangles().size() + m_cloths.edges().size();
    }
    // Counts the feature indices of contacts: twice as many if cloths may have contacts with themselves.
    std::size_t allFeatureCount() const { return m_anySelf ? 2 * featureCount() : featureCount(); }

private:
    PooledMesh makeMesh(const MeshDescription& description);
    // Joins the meshes from slot `first` on.
    void joinCloths(std::size_t first, Device* device);
    void joinObstacles(std::size_t first);
    void joinRest();
    // Computes data that depends on an obstacle's pose.
    void updatePlace(std::size_t slot);

    MeshId m_nextId;
    std::uint32_t m_joinedCloths = 0, m_joinedObstacles = 0;  // revisions of the pools
};
}  // namespace drape
