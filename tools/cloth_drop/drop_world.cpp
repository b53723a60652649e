#include "tools/cloth_drop/drop_world.h"

#include <algorithm>
#include <chrono>

#include "tools/cloth_drop/node_positions.h"

namespace drape
{
namespace
{
using Clock = std::chrono::steady_clock;

double since(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::unique_ptr<btSoftBody> makeBody(btSoftBodyWorldInfo& info, const TriangleMesh& mesh, double mass, double margin)
{
    const std::size_t count = mesh.vertexCount();
    std::vector<btVector3> places(count);
    for (std::size_t i = 0; i < count; ++i)
        places[i].setValue(mesh.m_positions[3 * i], mesh.m_positions[3 * i + 1], mesh.m_positions[3 * i + 2]);
    const std::vector<btScalar> masses(count, static_cast<btScalar>(mass / static_cast<double>(count)));
    auto body = std::make_unique<btSoftBody>(&info, static_cast<int>(count), places.data(), masses.data());
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        body->appendFace(mesh.m_triangles[3 * t], mesh.m_triangles[3 * t + 1], mesh.m_triangles[3 * t + 2]);
    body->getCollisionShape()->setMargin(static_cast<btScalar>(margin));
    body->m_cfg.kDF = btScalar(dropMaterial().m_friction);
    return body;
}

void addSprings(btSoftBody& body, const std::vector<std::int32_t>& springs, btSoftBody::Material* material)
{
    for (std::size_t i = 0; i < springs.size(); i += 2)
        body.appendLink(springs[i], springs[i + 1], material);
}
}  // namespace

DropWorld::DropWorld(std::unique_ptr<btCollisionConfiguration> configuration, std::unique_ptr<btSoftBodySolver> solver)
    : m_configuration(std::move(configuration)),
      m_solver(std::move(solver)),
      m_dispatcher(m_configuration.get()),
      m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, m_configuration.get(), m_solver.get())
{
    const btVector3 gravity(0, static_cast<btScalar>(-kGravity), 0);
    m_world.setGravity(gravity);
    m_world.getWorldInfo().m_gravity = gravity;
}

DropWorld::~DropWorld()
{
    for (const std::unique_ptr<btSoftBody>& cloth : m_cloths)
        m_world.removeSoftBody(cloth.get());
    if (m_softObstacle) m_world.removeSoftBody(m_softObstacle.get());
    if (m_object) m_world.removeCollisionObject(m_object.get());
}

void DropWorld::makeShape(const DropScene& scene)
{
    const TriangleMesh& mesh = scene.m_obstacle;
    m_obstaclePositions = mesh.m_positions;
    m_obstacleIndices.assign(mesh.m_triangles.begin(), mesh.m_triangles.end());
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(mesh.triangleCount());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(m_obstacleIndices.data());
    part.m_triangleIndexStride = 3 * sizeof(int);
    part.m_numVertices = static_cast<int>(mesh.vertexCount());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(m_obstaclePositions.data());
    part.m_vertexStride = 3 * sizeof(float);
    part.m_vertexType = PHY_FLOAT;
    m_meshInterface = std::make_unique<btTriangleIndexVertexArray>();
    m_meshInterface->addIndexedMesh(part, PHY_INTEGER);
    m_shape = std::make_unique<btBvhTriangleMeshShape>(m_meshInterface.get(), true);
    m_shape->setMargin(static_cast<btScalar>(0.5 * scene.m_thickness));
}

void DropWorld::addMeshObstacle(const DropScene& scene)
{
    makeShape(scene);
    m_object = std::make_unique<btCollisionObject>();
    m_object->setCollisionShape(m_shape.get());
    m_object->setFriction(1);
    m_world.addCollisionObject(m_object.get(), btBroadphaseProxy::StaticFilter,
                               btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
}

btRigidBody& DropWorld::addMovingObstacle(const DropScene& scene)
{
    makeShape(scene);
    auto owned = std::make_unique<btRigidBody>(btScalar(0), nullptr, m_shape.get());
    btRigidBody& body = *owned;
    body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    body.setActivationState(DISABLE_DEACTIVATION);
    body.setFriction(1);
    m_object = std::move(owned);
    m_world.addRigidBody(&body);
    return body;
}

void DropWorld::addSoftObstacle(const DropScene& scene)
{
    m_softObstacle = makeBody(m_world.getWorldInfo(), scene.m_obstacle, 0, 0.5 * scene.m_thickness);
    m_softObstacle->m_cfg.collisions = btSoftBody::fCollision::VF_SS;
    m_world.addSoftBody(m_softObstacle.get());
}

void DropWorld::addCloths(const DropScene& scene, bool softPairs)
{
    TriangleMesh sheet = scene.m_cloth.m_mesh;
    const std::size_t count = sheet.m_positions.size();
    const std::vector<float> positions = sheetsOf(scene).m_positions;
    for (std::size_t layer = 0; layer < scene.m_layers; ++layer)
    {
        std::copy_n(positions.begin() + std::ptrdiff_t(layer * count), count, sheet.m_positions.begin());
        addSheet(scene, sheet, softPairs);
    }
}

const std::vector<float>& DropWorld::positions()
{
    m_positions.clear();
    for (const std::unique_ptr<btSoftBody>& cloth : m_cloths)
    {
        copyPositions(*cloth, m_ofOne);
        m_positions.insert(m_positions.end(), m_ofOne.begin(), m_ofOne.end());
    }
    return m_positions;
}

void DropWorld::addSheet(const DropScene& scene, const TriangleMesh& sheet, bool softPairs)
{
    m_cloths.push_back(makeBody(m_world.getWorldInfo(), sheet, scene.m_mass, 0.5 * scene.m_thickness));
    btSoftBody& cloth = *m_cloths.back();
    cloth.setUserIndex(int(m_cloths.size()) - 1);
    btSoftBody::Material* edges = cloth.m_materials[0];
    edges->m_kLST = btScalar(dropMaterial().m_stretch);
    btSoftBody::Material* bending = cloth.appendMaterial();
    bending->m_kLST = btScalar(dropMaterial().m_bending);
    addSprings(cloth, scene.m_cloth.m_edgeSprings, edges);
    addSprings(cloth, scene.m_cloth.m_bendingSprings, bending);
    cloth.m_cfg.piterations = kDropIterations;
    cloth.m_cfg.kDP = btScalar(dropMaterial().m_damping);
    cloth.m_cfg.collisions =
        softPairs ? btSoftBody::fCollision::VF_SS : static_cast<int>(btSoftBody::fCollision::SDF_RS);
    cloth.setVelocity(btVector3(0, static_cast<btScalar>(-scene.m_dropSpeed), 0));
    // Cloths meet obstacles alone, unless the obstacle is a soft body or the scene lets them meet.
    const int group = btBroadphaseProxy::DefaultFilter, all = btBroadphaseProxy::AllFilter;
    m_world.addSoftBody(&cloth, group, softPairs || scene.m_self ? all : all ^ group);
}

void DropWorld::useBulletsClothWithCloth()
{
    for (const std::unique_ptr<btSoftBody>& cloth : m_cloths)
        cloth->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
}

double DropWorld::step(double dt)
{
    const Clock::time_point start = Clock::now();
    m_world.stepSimulation(static_cast<btScalar>(dt), 1, static_cast<btScalar>(dt));
    return since(start);
}
}  // namespace drape
