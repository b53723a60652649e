// Nodes that contacts may not move, pinned or anchored, near a surface. Contacts of faces and edges between
// them and their neighbours have little freedom to push.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/mesh_builder.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
constexpr btScalar kFast = 15;  // m/s; what falls and is dragged here does so at 3, an anchor shakes its node at 8

// Makes a square of 4 m, in waves about y = 0.
TriangleMesh makeWaves(double height)
{
    constexpr int kCells = 8;
    TriangleMesh mesh;
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i)
        {
            const double x = 4.0 * i / kCells - 2, z = 4.0 * j / kCells - 2;
            addVertex(mesh, x, height * std::sin(3 * x) * std::cos(2 * z), z);
        }
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i)
        {
            const int a = j * (kCells + 1) + i, b = a + kCells + 1;
            addTriangle(mesh, a, b, a + 1);
            addTriangle(mesh, a + 1, b, b + 1);
        }
    return mesh;
}

btScalar fastestOf(const btSoftBody& cloth)
{
    btScalar fastest = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        fastest = std::max(fastest, cloth.m_nodes[i].m_v.length());
    return fastest;
}

ClothSpec clothAt(btScalar height)
{
    ClothSpec spec;
    spec.m_size = 2;
    spec.m_centre = btVector3(0, height, 0);
    spec.m_damping = 0;
    return spec;
}

class HeldNodes : public BackendTest
{
};
}  // namespace

// A corner's node is dragged to the ground by a box that lies on it.
TEST_P(HeldNodes, AnAnchoredNodeStaysWithItsBox)
{
    MeshShape ground(makeWaves(0));
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    world.addObstacle(ground.shape());
    btSoftBody& cloth = world.addCloth(clothAt(btScalar(0.3)));
    btBoxShape shape(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)));
    btVector3 inertia;
    shape.calculateLocalInertia(1, inertia);
    btRigidBody box(1, nullptr, &shape, inertia);
    box.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(-1, btScalar(0.4), -1)));
    world.world().addRigidBody(&box);
    cloth.appendAnchor(0, &box, true);
    for (int step = 0; step < 240 && !HasFailure(); ++step)
    {
        world.step();
        EXPECT_LT(fastestOf(cloth), kFast) << "step " << step;
        EXPECT_LT(box.getWorldTransform().getOrigin().y(), btScalar(0.45)) << "step " << step;
    }
    world.remove(cloth);
    world.world().removeRigidBody(&box);
}

// The app moves a pinned node along, a little above the waves' tops.
TEST_P(HeldNodes, ANodeIsDraggedOverWaves)
{
    MeshShape waves(makeWaves(0.1));
    Plugin plugin(GetParam().m_settings);
    for (int row = 0; row < 15 && !HasFailure(); ++row)
    {
        SCOPED_TRACE(row);
        DropWorld world(&plugin);
        world.addObstacle(waves.shape());
        btSoftBody& cloth = world.addCloth(clothAt(btScalar(0.15)));
        const int pinned = cloth.m_nodes.size() / 2;
        cloth.setMass(pinned, 0);
        const btScalar z = btScalar(-0.347) + btScalar(0.05) * btScalar(row);
        for (int step = 0; step < 180 && !HasFailure(); ++step)
        {
            const btScalar along = btScalar(0.003) * btScalar(std::max(0, step - 30));
            const btScalar height = std::max(btScalar(0.09), btScalar(0.15) - btScalar(0.005) * btScalar(step));
            btSoftBody::Node& node = cloth.m_nodes[pinned];
            node.m_x = node.m_q = btVector3(along, height, z * std::min(btScalar(1), btScalar(step) / btScalar(30)));
            world.step();
            EXPECT_LT(fastestOf(cloth), kFast) << "step " << step;
        }
        world.remove(cloth);
    }
}

INSTANTIATE_TEST_SUITE_P(Backend, HeldNodes, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
