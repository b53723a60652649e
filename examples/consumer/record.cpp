// Records cloth of Bullet's alone, with Drape's recorder and nothing else of Drape.
#include <cstdio>
#include <string>

#include <btBulletDynamicsCommon.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <drape/recorder.h>

int main(int argc, char** argv)
{
    btSoftBodyRigidBodyCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    btSoftBody* cloth = btSoftBodyHelpers::CreatePatch(world.getWorldInfo(), btVector3(-1, 1, -1), btVector3(1, 1, -1),
                                                       btVector3(-1, 1, 1), btVector3(1, 1, 1), 9, 9, 1 + 2, true);
    world.addSoftBody(cloth);

    drape::Recorder recorder(world);
    for (int step = 0; step < 30; ++step)
    {
        world.stepSimulation(1.0f / 60.0f);
        recorder.record();
    }
    const std::string folder = argc > 1 ? argv[1] : "recorded";
    std::string error;
    const bool written = drape::writePointCaches(folder, recorder.recording(), error) &&
                         drape::writeGltf(folder + "/cloth.glb", recorder.recording(), 60, error);
    std::puts(written ? "recorded 30 frames" : error.c_str());
    world.removeSoftBody(cloth);
    delete cloth;
    return written ? 0 : 1;
}
