// A world of rigid and soft bodies, with Bullet's own soft-body collision and links or with Drape's.
//
// Owns all that a scene adds and removes it in the order that Bullet demands. Gravity is 10 m/s², y is up. Metres,
// kilograms, seconds.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodySolvers.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "scenes/mesh.h"

namespace drape
{
class Plugin;
}

namespace drape::bench
{
constexpr double kDemoStep = 1.0 / 60;  // s
constexpr double kDemoGravity = 10;     // m/s²
constexpr btScalar kGroundTop = -10.5;  // m, top of the ground's box
constexpr btScalar kWaveHeight = 5;     // m, half of the height between the ground mesh's valleys and hills
constexpr btScalar kWaveBase = -12;     // m, mean height of the ground mesh
constexpr btScalar kGroundCell = 8;     // m, side of a cell of the ground mesh

class DemoWorld
{
public:
    // plugin: null for Bullet's own collision and links; must outlive the world.
    explicit DemoWorld(Plugin* plugin);
    ~DemoWorld();
    DemoWorld(const DemoWorld&) = delete;
    DemoWorld& operator=(const DemoWorld&) = delete;

    // Adds the ground: a box with its top at kGroundTop, or a mesh of waves.
    void addFlatGround();
    void addWavyGround();

    // Adds a rigid body; mass 0 makes it static. The world owns the shape, which may be added several times.
    btRigidBody& addBody(double mass, const btTransform& pose, std::shared_ptr<btCollisionShape> shape);
    // Takes and adds a soft body, and returns it.
    btSoftBody& addSoft(btSoftBody* body);
    // Keeps an object until the world ends: shapes of compounds, controls of joints.
    void keep(std::shared_ptr<void> object) { m_kept.push_back(std::move(object)); }
    // Takes and adds a constraint.
    void addConstraint(btTypedConstraint* constraint);
    // Calls the function before the step of this number, 0 for the first.
    void doBefore(int step, std::function<void()> action) { m_actions.emplace_back(step, std::move(action)); }

    btSoftBodyWorldInfo& info() { return m_world.getWorldInfo(); }
    btSoftRigidDynamicsWorld& world() { return m_world; }
    const std::vector<std::unique_ptr<btSoftBody>>& softBodies() const { return m_softBodies; }
    // Rigid bodies in the order in which they were added, without the ground.
    const std::vector<std::unique_ptr<btRigidBody>>& bodies() const { return m_bodies; }
    const btCollisionObject& ground() const { return *m_ground; }
    // Triangles of the wavy ground in the world frame; empty with the flat one.
    const TriangleMesh& groundMesh() const { return m_groundMesh; }

    // Runs one step and returns its wall time in ms.
    double step();

private:
    void addGround(std::shared_ptr<btCollisionShape> shape);

    std::unique_ptr<btCollisionConfiguration> m_configuration;
    std::unique_ptr<btSoftBodySolver> m_solver;
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    std::vector<std::shared_ptr<void>> m_kept;
    TriangleMesh m_groundMesh;
    std::unique_ptr<btCollisionObject> m_ground;
    std::vector<std::unique_ptr<btRigidBody>> m_bodies;
    std::vector<std::unique_ptr<btTypedConstraint>> m_constraints;
    std::vector<std::unique_ptr<btSoftBody>> m_softBodies;
    std::vector<std::pair<int, std::function<void()>>> m_actions;
    int m_step = 0;
    btSoftRigidDynamicsWorld m_world;
};
}  // namespace drape::bench
