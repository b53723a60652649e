// Resolves contacts from indices over all meshes to meshes, nodes and triangles in the caller's numbering. O(log n) in
// the number of meshes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "bullet_plugin/core/scene/mesh_id.h"
#include "kernels/shared/contact.h"
#include "kernels/shared/types.h"

namespace drape
{
class MeshPool;
struct Scene;
struct StepPairs;

// A contact for a solver, with its pool-wide indices resolved to meshes.
struct ContactView
{
    MeshId m_cloth;
    MeshId m_obstacle;
    std::uint32_t m_kind;             // DRAPE_NODE_FACE …; DRAPE_FACE_VERTEX for a free edge at a vertex
    std::int32_t m_nodes[3];          // nodes of the cloth feature, indices in that cloth; -1 where unused
    std::int32_t m_obstacleTriangle;  // a triangle with the obstacle's feature, index as given to addObstacle; -1: none
    std::int32_t m_triangle;          // a cloth triangle with the feature, index as given to addCloth; -1: none
    float m_weights[3];               // by m_nodes, sum 1
    float m_normal[3];                // unit, from the obstacle to the side from which the cloth came
    float m_point[3];                 // m, on the obstacle
    float m_gap0, m_gap1;  // m, along the normal at the step's start and end as the obstacle sees them, thickness not
                           // subtracted
    float m_thickness;     // m, of the pair
    float m_time;          // time of impact in [0, 1]
};

// A contact of a cloth with itself: a node against a face, or two edges. The first feature's nodes come first, then the
// second's.
struct SelfContactView
{
    MeshId m_cloth;
    std::uint32_t m_kind;     // DRAPE_SELF_NODE_FACE or DRAPE_SELF_EDGE_EDGE
    std::int32_t m_nodes[4];  // node, face's three; or two of each edge; indices in the cloth
    float m_weights[4];       // by m_nodes; each feature's add up to 1
    float m_normal[3];        // unit, from the second feature to the side from which the first came
    float m_point[3];         // m, on the second feature at the step's end
    float m_gap0, m_gap1;     // m, along the normal at the step's start and end, thickness not subtracted
    float m_thickness;        // m, of the pair
    float m_time;             // time of impact in [0, 1]
};

// The cloth feature of a contact, which all contacts of one feature index share.
struct ClothFeature
{
    MeshId m_cloth;
    std::size_t m_index;  // see featureIndexOf(); in the cloth
};

// Resolve a contact of the step with these pairs; the joined scene must be unchanged since.
ContactView viewContact(const Scene& scene, const StepPairs& pairs, const Contact& contact);
SelfContactView viewSelfContact(const Scene& scene, const Contact& contact);
ClothFeature clothFeatureOf(const MeshPool& cloths, const Contact& contact);
// Returns where the contact's point of the cloth is with the nodes at these positions, m, joined over all cloths.
Vec3 clothPoint(const MeshPool& cloths, const float* positions, const Contact& contact);
// Returns the slot of a contact's obstacle.
std::size_t obstacleSlot(const MeshPool& obstacles, const Contact& contact);
}  // namespace drape
