#include "contact_view.h"

#include <algorithm>

#include "bullet_plugin/core/scene/scene.h"
#include "kernels/lib/geometry/segment.h"
#include "kernels/lib/geometry/vec3.h"
#include "kernels/lib/ordering/feature_index.h"
#include "step_pairs.h"

namespace drape
{
namespace
{
struct PooledFeature
{
    std::size_t m_meshSlot = 0;                              // the mesh's slot
    std::uint32_t m_keptTriangle = 0;                        // in the mesh's topology
    std::uint32_t m_nodes[3] = {kNoMesh, kNoMesh, kNoMesh};  // over all meshes
};

PooledFeature pooledFeature(const MeshPool& cloths, const Contact& contact)
{
    PooledFeature feature;
    const std::uint32_t index = contact.m_clothFeature;
    if (contact.m_kind == DRAPE_NODE_FACE)
    {
        feature.m_meshSlot = cloths.slotOfVertex(index);
        const PooledMesh& mesh = cloths.mesh(feature.m_meshSlot);
        feature.m_keptTriangle = mesh.m_topology.m_vertexTriangle[index - mesh.m_firstVertex];
        feature.m_nodes[0] = index;
    }
    else if (contact.m_kind == DRAPE_FACE_VERTEX)
    {
        const Triangle& triangle = cloths.triangles()[index];
        feature.m_meshSlot = triangle.m_mesh;
        feature.m_keptTriangle = index - cloths.mesh(feature.m_meshSlot).m_firstTriangle;
        std::copy(triangle.m_vertices, triangle.m_vertices + (isSegment(&triangle) ? 2 : 3), feature.m_nodes);
    }
    else
    {
        feature.m_meshSlot = cloths.slotOfEdge(index);
        const PooledMesh& mesh = cloths.mesh(feature.m_meshSlot);
        feature.m_keptTriangle = mesh.m_topology.m_edgeTriangle[index - mesh.m_firstEdge];
        const Edge& edge = cloths.edges()[index];
        std::copy(edge.m_vertices, edge.m_vertices + 2, feature.m_nodes);
    }
    return feature;
}

// Returns a triangle of the obstacle that has the contact's feature, an index as given; -1 for none.
std::int32_t obstacleTriangle(const PooledMesh& mesh, const Contact& contact)
{
    const Topology& topology = mesh.m_topology;
    const std::uint32_t feature = contact.m_obstacleFeature;
    const std::uint32_t kept = contact.m_kind == DRAPE_NODE_FACE ? feature - mesh.m_firstTriangle
                               : contact.m_kind == DRAPE_FACE_VERTEX
                                   ? topology.m_vertexTriangle[feature - mesh.m_firstVertex]
                                   : topology.m_edgeTriangle[feature - mesh.m_firstEdge];
    return kept < topology.m_sourceTriangle.size() ? std::int32_t(topology.m_sourceTriangle[kept]) : -1;
}

std::int32_t nodeOf(const PooledFeature& feature, const PooledMesh& cloth, int corner)
{
    const std::uint32_t node = feature.m_nodes[corner];
    return node == kNoMesh ? -1 : std::int32_t(node - cloth.m_firstVertex);
}
}  // namespace

std::size_t obstacleSlot(const MeshPool& obstacles, const Contact& contact)
{
    if (obstacles.meshCount() == 1) return 0;
    if (contact.m_kind == DRAPE_NODE_FACE) return obstacles.triangles()[contact.m_obstacleFeature].m_mesh;
    if (contact.m_kind == DRAPE_FACE_VERTEX) return obstacles.slotOfVertex(contact.m_obstacleFeature);
    return obstacles.slotOfEdge(contact.m_obstacleFeature);
}

ClothFeature clothFeatureOf(const MeshPool& cloths, const Contact& contact)
{
    const std::uint32_t kind = contact.m_kind, index = contact.m_clothFeature;
    const PooledMesh& cloth = cloths.mesh(kind == DRAPE_NODE_FACE     ? cloths.slotOfVertex(index)
                                          : kind == DRAPE_FACE_VERTEX ? cloths.triangles()[index].m_mesh
                                                                      : cloths.slotOfEdge(index));
    const std::uint32_t first = kind == DRAPE_NODE_FACE     ? cloth.m_firstVertex
                                : kind == DRAPE_FACE_VERTEX ? cloth.m_firstTriangle
                                                            : cloth.m_firstEdge;
    return {cloth.m_id, featureIndexOf(kind, index - first, std::uint32_t(cloth.m_topology.m_vertexCount),
                                       std::uint32_t(cloth.m_topology.m_triangles.size()))};
}

Vec3 clothPoint(const MeshPool& cloths, const float* positions, const Contact& contact)
{
    const PooledFeature feature = pooledFeature(cloths, contact);
    Vec3 point = vec3(0, 0, 0);
    for (int k = 0; k < 3 && feature.m_nodes[k] != kNoMesh; ++k)
        point = vec3AddScaled(point, vec3Load(positions, feature.m_nodes[k]), contact.m_weights[k]);
    return point;
}

ContactView viewContact(const Scene& scene, const StepPairs& pairs, const Contact& contact)
{
    const MeshPool &cloths = scene.m_cloths, &obstacles = scene.m_obstacles;
    const PooledFeature feature = pooledFeature(cloths, contact);
    const std::size_t obstacle = obstacleSlot(obstacles, contact);
    const PooledMesh& cloth = cloths.mesh(feature.m_meshSlot);
    ContactView view;
    view.m_cloth = cloth.m_id;
    view.m_obstacle = obstacles.mesh(obstacle).m_id;
    view.m_kind = contact.m_kind;
    view.m_obstacleTriangle = obstacleTriangle(obstacles.mesh(obstacle), contact);
    view.m_triangle = std::int32_t(cloth.m_topology.m_sourceTriangle[feature.m_keptTriangle]);
    for (int i = 0; i < 3; ++i)
    {
        view.m_nodes[i] = nodeOf(feature, cloth, i);
        view.m_weights[i] = contact.m_weights[i];
        view.m_normal[i] = contact.m_normal[i];
        view.m_point[i] = contact.m_point[i];
    }
    view.m_gap0 = contact.m_gap0;
    view.m_gap1 = contact.m_gap1;
    view.m_time = contact.m_time;
    view.m_thickness = pairs.thickness(feature.m_meshSlot, obstacle);
    return view;
}

SelfContactView viewSelfContact(const Scene& scene, const Contact& contact)
{
    const MeshPool& cloths = scene.m_cloths;
    const float* rest = scene.m_clothRest.data();
    const bool edges = contact.m_kind == DRAPE_SELF_EDGE_EDGE;
    const std::size_t slot =
        edges ? cloths.slotOfEdge(contact.m_clothFeature) : cloths.slotOfVertex(contact.m_clothFeature);
    const PooledMesh& cloth = cloths.mesh(slot);
    const float s = contact.m_weights[0], t = contact.m_weights[1];
    SelfContactView view;
    view.m_cloth = cloth.m_id;
    view.m_kind = contact.m_kind;
    float restDistance;
    if (edges)
    {
        const std::uint32_t* first = cloths.edges()[contact.m_clothFeature].m_vertices;
        const std::uint32_t* second = cloths.edges()[contact.m_obstacleFeature].m_vertices;
        for (int i = 0; i < 2; ++i)
        {
            view.m_nodes[i] = std::int32_t(first[i] - cloth.m_firstVertex);
            view.m_nodes[2 + i] = std::int32_t(second[i] - cloth.m_firstVertex);
            view.m_weights[i] = i == 0 ? 1.0f - s : s;
            view.m_weights[2 + i] = i == 0 ? 1.0f - t : t;
        }
        restDistance = restDistanceOfEdges(rest, first, second);
    }
    else
    {
        const std::uint32_t* corners = cloths.triangles()[contact.m_obstacleFeature].m_vertices;
        view.m_nodes[0] = std::int32_t(contact.m_clothFeature - cloth.m_firstVertex);
        view.m_weights[0] = 1.0f;
        for (int i = 0; i < 3; ++i)
        {
            view.m_nodes[1 + i] = std::int32_t(corners[i] - cloth.m_firstVertex);
            view.m_weights[1 + i] = contact.m_weights[i];
        }
        restDistance = restDistanceOfNode(rest, contact.m_clothFeature, corners);
    }
    std::copy(contact.m_normal, contact.m_normal + 3, view.m_normal);
    std::copy(contact.m_point, contact.m_point + 3, view.m_point);
    view.m_gap0 = contact.m_gap0;
    view.m_gap1 = contact.m_gap1;
    view.m_time = contact.m_time;
    view.m_thickness = selfThickness(cloth.m_selfThickness, restDistance);
    return view;
}
}  // namespace drape
