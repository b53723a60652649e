#include "bullet_plugin/adapter/cloth_world/cloth_body.h"

#include <algorithm>

#include "bullet_plugin/adapter/cloth_cloth/self_collision.h"
#include "bullet_plugin/adapter/cloth_world/input_checks.h"
#include "bullet_plugin/core/scene/check_indices.h"
#include "bullet_plugin/core/scene/topology.h"

namespace drape
{
namespace
{
constexpr double kLargest = 1e30;            // bounds lengths and masses
constexpr std::size_t kMostItems = 1 << 29;  // Bullet counts in int

btVector3 positionAt(const float* positions, std::size_t node)
{
    return btVector3(positions[3 * node], positions[3 * node + 1], positions[3 * node + 2]);
}

// Every edge becomes a link; bending links join the opposite nodes of edges that two triangles share.
void addLinks(btSoftBody& body, const ClothDescription& cloth)
{
    Topology topology = buildTopology(cloth.m_triangles, cloth.m_triangleCount, cloth.m_vertexCount);
    std::vector<Edge> shared;
    for (std::size_t i = 0; i < topology.m_edges.size(); ++i)
        if (topology.m_edgeUses[i] == 2) shared.push_back(topology.m_edges[i]);
    addEdges(topology, cloth.m_edges, cloth.m_edgeCount);
    for (const Edge& edge : topology.m_edges)
        if (edge.m_vertices[0] != edge.m_vertices[1])
            body.appendLink(int(edge.m_vertices[0]), int(edge.m_vertices[1]), body.m_materials[0]);
    if (!(cloth.m_bendingStiffness > 0)) return;
    btSoftBody::Material* const bending = body.appendMaterial();
    bending->m_kLST = btScalar(cloth.m_bendingStiffness);
    for (const Edge& edge : shared)
    {
        if (edge.m_opposite[0] == edge.m_opposite[1]) continue;
        body.appendLink(int(edge.m_opposite[0]), int(edge.m_opposite[1]), bending);
        body.m_links[body.m_links.size() - 1].m_bbending = -1;  // a field of one bit
    }
}
}  // namespace

void requireMesh(const MeshDescription& mesh)
{
    Error error;
    if (!checkIndices(mesh, "the mesh", error)) throw InvalidInput(error.text());
    requireValues(mesh.m_positions, 3 * mesh.m_vertexCount, "positions");
    require(mesh.m_vertexCount <= kMostItems && mesh.m_triangleCount <= kMostItems && mesh.m_edgeCount <= kMostItems,
            "a mesh has 2^29 vertices, triangles and edges at most");
}

void requireCloth(const ClothDescription& cloth)
{
    MeshDescription mesh;
    mesh.m_positions = cloth.m_positions;
    mesh.m_vertexCount = cloth.m_vertexCount;
    mesh.m_triangles = cloth.m_triangles;
    mesh.m_triangleCount = cloth.m_triangleCount;
    mesh.m_edges = cloth.m_edges;
    mesh.m_edgeCount = cloth.m_edgeCount;
    require(cloth.m_vertexCount > 0, "a cloth has one vertex at least");
    requireMesh(mesh);
    if (cloth.m_restPositions) requireValues(cloth.m_restPositions, 3 * cloth.m_vertexCount, "restPositions");
    requireNodes(cloth.m_pins, cloth.m_pinCount, cloth.m_vertexCount, "pins");
    for (std::size_t i = 0; cloth.m_masses && i < cloth.m_vertexCount; ++i)
        require(cloth.m_masses[i] > 0 && cloth.m_masses[i] <= kLargest, "each mass should be above 0");
    require(cloth.m_masses || (cloth.m_mass > 0 && cloth.m_mass <= kLargest), "mass should be above 0");
    require(cloth.m_thickness > 0 && cloth.m_thickness <= kLargest, "thickness should be above 0");
    require(cloth.m_stiffness > 0 && cloth.m_stiffness <= 1, "stiffness should be above 0 up to 1");
    requireNumber(cloth.m_bendingStiffness, 0, 1, "bendingStiffness should be 0 to 1");
    requireNumber(cloth.m_friction, 0, 1, "friction should be 0 to 1");
    requireNumber(cloth.m_damping, 0, 1, "damping should be 0 to 1");
    requireNumber(cloth.m_iterations, 1, 1000, "iterations should be 1 to 1000");
    requireNumber(cloth.m_selfCollision, 0, 1, "selfCollision should be 0 or 1");
}

WorldCloth makeCloth(const ClothDescription& cloth, btSoftBodyWorldInfo& info, SelfCollision& selfCollision)
{
    const std::size_t count = cloth.m_vertexCount;
    const float* const rest = cloth.m_restPositions ? cloth.m_restPositions : cloth.m_positions;
    WorldCloth made;
    made.m_masses.resize(count, btScalar(cloth.m_mass / double(count)));
    if (cloth.m_masses) std::copy(cloth.m_masses, cloth.m_masses + count, made.m_masses.begin());
    std::vector<btVector3> places(count);
    for (std::size_t i = 0; i < count; ++i)
        places[i] = positionAt(rest, i);
    made.m_body = std::make_shared<btSoftBody>(&info, int(count), places.data(), made.m_masses.data());
    btSoftBody& body = *made.m_body;
    body.m_materials[0]->m_kLST = btScalar(cloth.m_stiffness);
    for (std::size_t t = 0; t < cloth.m_triangleCount; ++t)
        body.appendFace(cloth.m_triangles[3 * t], cloth.m_triangles[3 * t + 1], cloth.m_triangles[3 * t + 2]);
    addLinks(body, cloth);
    for (std::size_t i = 0; i < cloth.m_pinCount; ++i)
        body.setMass(cloth.m_pins[i], 0);
    body.getCollisionShape()->setMargin(btScalar(cloth.m_thickness / 2));
    body.m_cfg.piterations = cloth.m_iterations;
    body.m_cfg.kDP = btScalar(cloth.m_damping);
    body.m_cfg.kDF = btScalar(cloth.m_friction);
    // Lengths and areas are those at rest. Bullet would derive them anew, from the start, in the first step.
    body.updateConstants();
    body.m_bUpdateRtCst = false;
    // It remembers the positions at rest. A thickness of 0 stands for twice the margin.
    if (cloth.m_selfCollision) selfCollision.set(body, 0);
    for (std::size_t i = 0; i < count && cloth.m_restPositions; ++i)
        body.m_nodes[int(i)].m_x = body.m_nodes[int(i)].m_q = positionAt(cloth.m_positions, i);
    body.updateNormals();
    body.updateBounds();
    return made;
}
}  // namespace drape
