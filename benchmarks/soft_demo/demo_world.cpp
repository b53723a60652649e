#include "benchmarks/soft_demo/demo_world.h"

#include <chrono>
#include <cmath>

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <drape/drape.h>

namespace drape::bench
{
namespace
{
constexpr int kGroundPoints = 30;  // along either side of the wavy ground
constexpr btScalar kGroundMargin = btScalar(0.5);

std::unique_ptr<btCollisionConfiguration> makeConfiguration(Plugin* plugin)
{
    if (plugin) return std::make_unique<CollisionConfiguration>(*plugin);
    return std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>();
}

TriangleMesh makeWaves()
{
    TriangleMesh mesh;
    for (int j = 0; j < kGroundPoints; ++j)
    {
        for (int i = 0; i < kGroundPoints; ++i)
        {
            mesh.m_positions.push_back(float(i - kGroundPoints / 2) * float(kGroundCell));
            mesh.m_positions.push_back(float(kWaveBase + kWaveHeight * std::sin(double(i)) * std::cos(double(j - 50))));
            mesh.m_positions.push_back(float(j - kGroundPoints / 2) * float(kGroundCell));
        }
    }
    for (int j = 0; j + 1 < kGroundPoints; ++j)
    {
        for (int i = 0; i + 1 < kGroundPoints; ++i)
        {
            const int corner = j * kGroundPoints + i, above = corner + kGroundPoints;
            mesh.m_triangles.insert(mesh.m_triangles.end(), {corner, above + 1, corner + 1, corner, above, above + 1});
        }
    }
    return mesh;
}
}  // namespace

DemoWorld::DemoWorld(Plugin* plugin)
    : m_configuration(makeConfiguration(plugin)),
      m_solver(plugin ? std::make_unique<SoftBodySolver>(*plugin) : nullptr),
      m_dispatcher(m_configuration.get()),
      m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, m_configuration.get(), m_solver.get())
{
    const btVector3 gravity(0, btScalar(-kDemoGravity), 0);
    m_world.setGravity(gravity);
    m_world.getWorldInfo().m_gravity = gravity;
}

DemoWorld::~DemoWorld()
{
    for (const auto& body : m_softBodies)
        m_world.removeSoftBody(body.get());
    for (const auto& constraint : m_constraints)
        m_world.removeConstraint(constraint.get());
    for (const auto& body : m_bodies)
        m_world.removeRigidBody(body.get());
    if (m_ground) m_world.removeCollisionObject(m_ground.get());
}

void DemoWorld::addGround(std::shared_ptr<btCollisionShape> shape)
{
    m_ground = std::make_unique<btCollisionObject>();
    m_ground->setCollisionShape(shape.get());
    keep(std::move(shape));
    m_world.addCollisionObject(m_ground.get());
}

void DemoWorld::addFlatGround()
{
    constexpr btScalar kHalfHeight = btScalar(1.5);
    addGround(std::make_shared<btBoxShape>(btVector3(100, kHalfHeight, 100)));
    m_ground->setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, kGroundTop - kHalfHeight, 0)));
}

void DemoWorld::addWavyGround()
{
    m_groundMesh = makeWaves();
    const auto triangles = std::make_shared<btTriangleMesh>();
    const auto vertex = [this](std::size_t corner)
    {
        const float* at = &m_groundMesh.m_positions[3 * std::size_t(m_groundMesh.m_triangles[corner])];
        return btVector3(at[0], at[1], at[2]);
    };
    for (std::size_t corner = 0; corner < m_groundMesh.m_triangles.size(); corner += 3)
        triangles->addTriangle(vertex(corner), vertex(corner + 1), vertex(corner + 2));
    keep(triangles);
    auto shape = std::make_shared<btBvhTriangleMeshShape>(triangles.get(), true);
    shape->setMargin(kGroundMargin);
    addGround(std::move(shape));
}

btRigidBody& DemoWorld::addBody(double mass, const btTransform& pose, std::shared_ptr<btCollisionShape> shape)
{
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
    m_bodies.push_back(std::make_unique<btRigidBody>(btScalar(mass), nullptr, shape.get(), inertia));
    btRigidBody& body = *m_bodies.back();
    body.setCenterOfMassTransform(pose);
    body.setInterpolationWorldTransform(pose);
    keep(std::move(shape));
    m_world.addRigidBody(&body);
    return body;
}

btSoftBody& DemoWorld::addSoft(btSoftBody* body)
{
    m_softBodies.emplace_back(body);
    m_world.addSoftBody(body);
    return *body;
}

void DemoWorld::addConstraint(btTypedConstraint* constraint)
{
    m_constraints.emplace_back(constraint);
    m_world.addConstraint(constraint);
}

double DemoWorld::step()
{
    for (const auto& action : m_actions)
        if (action.first == m_step) action.second();
    ++m_step;
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    m_world.stepSimulation(btScalar(kDemoStep), 1, btScalar(kDemoStep));
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}
}  // namespace drape::bench
