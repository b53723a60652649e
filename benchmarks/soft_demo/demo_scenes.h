// The scenes of Bullet's SoftDemo, built anew from what they show, and some beside them.
//
// Scenes have the demo's bodies, sizes, masses and settings of soft bodies. Shapes of its data files are generated: a
// torus, a ball with ears instead of the bunny, a cube of tetrahedra. Clicks and keys of the demo are timed actions.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/soft_demo/demo_world.h"

namespace drape::bench
{
// Properties of a scene that decide how its outcome is measured.
enum SceneFlags : unsigned
{
    kWavyGround = 1,    // the ground is the mesh, else the box
    kClosed = 2,        // soft bodies are closed: their volume counts
    kSoftPairs = 4,     // soft bodies collide with each other: triangles that intersect count
    kFlight = 8,        // the way of the soft bodies in their first seconds counts
    kClusters = 16,     // all soft bodies collide by clusters, which Drape leaves to Bullet
    kLoads = 32,        // bodies that are still above m_level at the end count as carried
    kByFriction = 128,  // soft bodies of rising friction slide: their order counts
    kDriven = 64,       // wind or a motor drives the scene: neither energy nor the speed at the end counts
};

struct DemoScene
{
    const char* m_name;
    const char* m_title;
    unsigned m_flags;
    void (*m_build)(DemoWorld& world);
    double m_level = 0;  // m, see kLoads
};

const std::vector<DemoScene>& demoScenes();

// Parts of the list, by kind.
void addSheetScenes(std::vector<DemoScene>& scenes);
void addRopeScenes(std::vector<DemoScene>& scenes);
void addClosedScenes(std::vector<DemoScene>& scenes);
void addClusterScenes(std::vector<DemoScene>& scenes);

// Parts that several scenes share.

inline btTransform at(double x, double y, double z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), btScalar(y), btScalar(z)));
}
// Adds `count` bodies of 10 kg in a column above the origin: by turns a cross of a box and a cylinder, a box, a ball.
void addColumnOfBodies(DemoWorld& world, int count);
// Adds a plate of 10 x 2 x 10 m with its centre at the height.
btRigidBody& addPlate(DemoWorld& world, double mass, double height);
// Adds a static flight of stairs along +x. half: half extents of a step.
void addStairs(DemoWorld& world, const btVector3& first, const btVector3& half, int count);
// Makes a square patch around `centre`, horizontal, of side 2 * half. corners: as CreatePatch's `fixeds`.
btSoftBody& addPatch(DemoWorld& world, const btVector3& centre, double half, int nodes, int corners);
// Adds a second material of this stiffness and links of it between nodes that are `distance` links apart.
void addBendingLinks(btSoftBody& body, double stiffness, int distance = 2);
// Makes a soft body of a closed mesh; not yet in a world.
btSoftBody* makeSoftMesh(DemoWorld& world, const TriangleMesh& mesh);
// Makes the demo's torus: rings of 30 x 10 quads, 2 m and 0.5 m.
TriangleMesh makeDemoTorus();
// Makes a ball with two ears of 2 m across, which stands in for the demo's bunny.
TriangleMesh makeEaredBall();
}  // namespace drape::bench
