#include "tests/cloth_world/hand_built_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace drape::test
{
namespace
{
constexpr double kTurn = 0.01;  // rad per step

struct SharedEdge
{
    std::vector<int> m_opposite;
    std::array<int, 2> m_nodes;
};

// Lists edges by their first use.
std::vector<SharedEdge> edgesOf(const TriangleMesh& mesh)
{
    std::vector<SharedEdge> edges;
    std::map<std::array<int, 2>, std::size_t> known;
    for (std::size_t t = 0; t < mesh.m_triangles.size(); t += 3)
        for (std::size_t side = 0; side < 3; ++side)
        {
            const int a = mesh.m_triangles[t + side], b = mesh.m_triangles[t + (side + 1) % 3];
            const auto found = known.emplace(std::array<int, 2>{std::min(a, b), std::max(a, b)}, edges.size());
            if (found.second) edges.push_back({{}, {a, b}});
            edges[found.first->second].m_opposite.push_back(mesh.m_triangles[t + (side + 2) % 3]);
        }
    return edges;
}
}  // namespace

HandBuiltWorld::HandBuiltWorld(const Settings& settings, const TriangleMesh& cloth, const TriangleMesh& ball, int pin)
    : m_ballMesh(ball),
      m_plugin(settings),
      m_configuration(m_plugin),
      m_solver(m_plugin),
      m_dispatcher(&m_configuration),
      m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_configuration, &m_solver)
{
    m_world.setGravity(btVector3(0, btScalar(-9.81), 0));
    m_world.getWorldInfo().m_gravity = m_world.getGravity();
    addCloth(cloth, pin);
    addBall(ball);
}

HandBuiltWorld::~HandBuiltWorld()
{
    m_world.removeSoftBody(m_cloth.get());
    m_world.removeRigidBody(m_ball.get());
}

void HandBuiltWorld::addCloth(const TriangleMesh& mesh, int pin)
{
    std::vector<btVector3> places;
    for (std::size_t i = 0; i < mesh.m_positions.size(); i += 3)
        places.emplace_back(mesh.m_positions[i], mesh.m_positions[i + 1], mesh.m_positions[i + 2]);
    m_cloth = std::make_unique<btSoftBody>(&m_world.getWorldInfo(), int(places.size()), places.data(), nullptr);
    m_cloth->m_materials[0]->m_kLST = btScalar(0.9);
    for (int i = 0; i < m_cloth->m_nodes.size(); ++i)
        m_cloth->setMass(i, btScalar(1.5 / double(places.size())));
    for (std::size_t t = 0; t < mesh.m_triangles.size(); t += 3)
        m_cloth->appendFace(mesh.m_triangles[t], mesh.m_triangles[t + 1], mesh.m_triangles[t + 2]);
    const std::vector<SharedEdge> edges = edgesOf(mesh);
    for (const SharedEdge& edge : edges)
        m_cloth->appendLink(edge.m_nodes[0], edge.m_nodes[1]);
    btSoftBody::Material* const bending = m_cloth->appendMaterial();
    bending->m_kLST = btScalar(0.1);
    for (const SharedEdge& edge : edges)
    {
        if (edge.m_opposite.size() != 2) continue;
        m_cloth->appendLink(edge.m_opposite[0], edge.m_opposite[1], bending);
        m_cloth->m_links[m_cloth->m_links.size() - 1].m_bbending = -1;
    }
    m_cloth->setMass(pin, 0);
    m_cloth->getCollisionShape()->setMargin(btScalar(0.012));
    m_cloth->m_cfg.piterations = 4;
    m_cloth->m_cfg.kDP = btScalar(0.03);
    m_cloth->m_cfg.kDF = btScalar(0.4);
    m_world.addSoftBody(m_cloth.get());
}

void HandBuiltWorld::addBall(const TriangleMesh& mesh)
{
    btIndexedMesh part;
    part.m_numTriangles = int(mesh.triangleCount());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(m_ballMesh.m_triangles.data());
    part.m_triangleIndexStride = 3 * sizeof(std::int32_t);
    part.m_numVertices = int(mesh.vertexCount());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(m_ballMesh.m_positions.data());
    part.m_vertexStride = 3 * sizeof(float);
    part.m_vertexType = PHY_FLOAT;
    m_arrays.addIndexedMesh(part, PHY_INTEGER);
    m_shape = std::make_unique<btBvhTriangleMeshShape>(&m_arrays, true);
    m_shape->setMargin(btScalar(0.01));
    m_ball = std::make_unique<btRigidBody>(btScalar(0), nullptr, m_shape.get());
    m_ball->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    m_ball->setActivationState(DISABLE_DEACTIVATION);
    m_ball->setFriction(1);
    m_world.addRigidBody(m_ball.get());
}

std::vector<double> HandBuiltWorld::rotationAfter(int steps)
{
    return {0, std::sin(0.5 * kTurn * steps), 0, std::cos(0.5 * kTurn * steps)};
}

void HandBuiltWorld::step()
{
    const std::vector<double> turn = rotationAfter(++m_steps);
    const btQuaternion rotation(0, btScalar(turn[1]), 0, btScalar(turn[3]));
    m_ball->setWorldTransform(btTransform(rotation.normalized(), btVector3(0, 0, 0)));
    m_world.stepSimulation(btScalar(1.0 / 60), 0);
}
}  // namespace drape::test
