// A world of Bullet's that is written out as an app would, beside which ClothWorld, the C interface and the Python
// module must give the same bits.
#pragma once

#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "btBulletDynamicsCommon.h"
#include <drape/drape.h>

#include "scenes/mesh.h"

namespace drape::test
{
// A cloth of 1.5 kg, 24 mm thick, friction 0.4, damping 0.03, four substeps, stiffness 0.9, bending stiffness 0.1,
// above a ball that turns.
class HandBuiltWorld
{
public:
    // pin: the node that is pinned.
    HandBuiltWorld(const Settings& settings, const TriangleMesh& cloth, const TriangleMesh& ball, int pin);
    ~HandBuiltWorld();

    // Takes a step of 1/60 s in which the ball turns on.
    void step();
    // Returns the rotation about y that the ball has after so many steps, as a quaternion x y z w.
    static std::vector<double> rotationAfter(int steps);

    Plugin& plugin() { return m_plugin; }
    const btSoftBody& cloth() const { return *m_cloth; }

private:
    void addCloth(const TriangleMesh& mesh, int pin);
    void addBall(const TriangleMesh& mesh);

    TriangleMesh m_ballMesh;
    btTriangleIndexVertexArray m_arrays;
    std::unique_ptr<btBvhTriangleMeshShape> m_shape;
    std::unique_ptr<btRigidBody> m_ball;
    std::unique_ptr<btSoftBody> m_cloth;
    Plugin m_plugin;
    CollisionConfiguration m_configuration;
    SoftBodySolver m_solver;
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
    int m_steps = 0;
};
}  // namespace drape::test
