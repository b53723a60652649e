// The Bullet side of the drop scene: world, cloth and obstacle, owned and torn down in the order Bullet demands.
#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftBodySolvers.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletCollisionCommon.h>

#include "tools/cloth_drop/drop_scene.h"
#include "tools/scene_world/timed_world.h"

namespace drape
{
// A cloth's user index is its place in the stack, from 0 at the bottom.
class DropWorld
{
public:
    // `solver` may be null for Bullet's default. Bodies are not in the world yet.
    DropWorld(std::unique_ptr<btCollisionConfiguration> configuration, std::unique_ptr<btSoftBodySolver> solver);
    ~DropWorld();

    void addMeshObstacle(const DropScene& scene);  // a static btBvhTriangleMeshShape
    // Adds the obstacle as a kinematic body at the origin. Call setWorldTransform() before a step to set its pose at
    // the end of the step.
    btRigidBody& addMovingObstacle(const DropScene& scene);
    void addSoftObstacle(const DropScene& scene);  // a soft body of pinned nodes, for VF_SS
    // Adds the scene's lowest sheet. May be called several times.
    void addCloth(const DropScene& scene, bool softPairs) { addSheet(scene, scene.m_cloth.m_mesh, softPairs); }
    // Adds all sheets of the scene, which may meet each other if it says so.
    void addCloths(const DropScene& scene, bool softPairs);
    // Lets all cloths collide with each other in Bullet's way, nodes against faces. Bullet 3.24 has none for a cloth
    // with itself: beside its flag CL_SELF neither VF_SS nor CL_SS has an effect.
    void useBulletsClothWithCloth();

    TimedWorld& world() { return m_world; }
    // The cloth that was added first, or another one.
    btSoftBody& cloth(std::size_t index = 0) { return *m_cloths[index]; }
    const btSoftBody& cloth(std::size_t index = 0) const { return *m_cloths[index]; }

    // Returns the nodes of all cloths, x y z each, m, in the order in which the cloths were added.
    const std::vector<float>& positions();

    // Runs one step and returns its wall time in ms.
    double step(double dt);

private:
    void addSheet(const DropScene& scene, const TriangleMesh& sheet, bool softPairs);
    void makeShape(const DropScene& scene);

    std::unique_ptr<btCollisionConfiguration> m_configuration;
    std::unique_ptr<btSoftBodySolver> m_solver;
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    TimedWorld m_world;
    std::vector<float> m_obstaclePositions;
    std::vector<int> m_obstacleIndices;
    std::unique_ptr<btTriangleIndexVertexArray> m_meshInterface;
    std::unique_ptr<btBvhTriangleMeshShape> m_shape;
    std::unique_ptr<btCollisionObject> m_object;
    std::unique_ptr<btSoftBody> m_softObstacle;
    std::vector<std::unique_ptr<btSoftBody>> m_cloths;
    std::vector<float> m_positions, m_ofOne;  // working memory of positions()
};
}  // namespace drape
