// The smallest use of Drape: a Bullet soft body app whose cloth collides with a triangle mesh. Only the four lines
// marked "Drape" differ from an app without it. Prints the device, the resting height and one line on the last step.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "btBulletDynamicsCommon.h"
#include <drape/drape.h>  // Drape

namespace
{
// Adds a wavy floor of 2 × 40 × 40 triangles, 4 m wide.
void addFloor(btTriangleMesh& mesh)
{
    const int cells = 40;
    const auto corner = [](int i, int j)
    {
        const btScalar x = btScalar(0.1) * btScalar(i - 20), z = btScalar(0.1) * btScalar(j - 20);
        return btVector3(x, btScalar(0.1) * std::sin(3 * x) * std::cos(3 * z), z);
    };
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
        {
            mesh.addTriangle(corner(i, j), corner(i, j + 1), corner(i + 1, j), true);
            mesh.addTriangle(corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1), true);
        }
}

// Returns the exit code for arguments: the program has none but --help and --version.
int answerArgument(const char* argument)
{
    if (std::strcmp(argument, "--version") == 0)
        std::puts("drop_in (Drape) " DROP_IN_VERSION);
    else if (std::strcmp(argument, "--help") == 0 || std::strcmp(argument, "-h") == 0)
        std::puts(
            "Usage: drop_in [--help] [--version]\nDrops a cloth on a wavy floor with Drape, and prints its height.");
    else
    {
        std::fprintf(stderr, "drop_in: there is no option %s; see --help\n", argument);
        return 2;
    }
    return 0;
}
}  // namespace

int main(int argc, char** argv)
{
    if (argc > 1) return answerArgument(argv[1]);
    drape::Plugin plugin;                                 // Drape
    drape::CollisionConfiguration configuration(plugin);  // Drape
    drape::SoftBodySolver solver(plugin);                 // Drape
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver rigidSolver;
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &rigidSolver, &configuration, &solver);
    world.setGravity(btVector3(0, btScalar(-9.81), 0));
    world.getWorldInfo().m_gravity = world.getGravity();

    btTriangleMesh mesh;
    addFloor(mesh);
    btBvhTriangleMeshShape shape(&mesh, true);
    shape.setMargin(btScalar(0.01));
    btCollisionObject floor;
    floor.setCollisionShape(&shape);
    world.addCollisionObject(&floor);

    btSoftBody* cloth = btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), btVector3(-1, 1, -1), btVector3(1, 1, -1),
                                                       btVector3(-1, 1, 1), btVector3(1, 1, 1), 33, 33, 0, true);
    cloth->getCollisionShape()->setMargin(btScalar(0.01));
    cloth->m_cfg.piterations = 5;
    cloth->setTotalMass(1);
    world.addSoftBody(cloth);

    std::printf("%s (%s)\n", plugin.device().m_device.m_name.c_str(), plugin.device().m_reason.c_str());
    for (int step = 0; step < 120; ++step)
        world.stepSimulation(btScalar(1) / 60, 0);
    std::printf("%s\ncentre of mass at %.3f m\n", plugin.report().c_str(), double(cloth->getCenterOfMass().y()));

    world.removeSoftBody(cloth);
    delete cloth;
    world.removeCollisionObject(&floor);
    return plugin.ready() ? 0 : 1;
}
