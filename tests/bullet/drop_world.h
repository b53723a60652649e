// A small Bullet world for the tests: cloths, obstacles and what there is to know of them after a step.
//
// Input: a plugin, or none for Bullet's own collision. Owns everything that it makes and takes it down in the
// order that Bullet demands. Metres, seconds, kilograms; y is up; steps are 1/60 s.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "btBulletDynamicsCommon.h"
#include <drape/drape.h>

#include "oracle/measure.h"
#include "scenes/mesh.h"

namespace drape::test
{
constexpr float kMargin = 0.01f;            // m, of each cloth and each obstacle
constexpr float kThickness = 2 * kMargin;   // m, the gap at which they rest
constexpr btScalar kDt = btScalar(1) / 60;  // s

struct ClothSpec
{
    int m_nodes = 17;                         // along either side
    float m_size = 1.0f;                      // m
    btVector3 m_centre = btVector3(0, 0, 0);  // m
    bool m_springs = true;                    // false: nodes and faces only
    btScalar m_damping = 0.1f;                // share of the velocity lost in a step, 0 to 1
};

// Makes a cloth that no world has yet.
std::unique_ptr<btSoftBody> makeCloth(btSoftBodyWorldInfo& info, const ClothSpec& spec);

// A mesh as Bullet's static shape; owns the arrays that the shape reads. The shape's margin is kMargin.
class MeshShape
{
public:
    explicit MeshShape(const TriangleMesh& mesh);
    btBvhTriangleMeshShape& shape() { return *m_shape; }
    std::vector<float>& positions() { return m_mesh.m_positions; }

private:
    TriangleMesh m_mesh;
    btTriangleIndexVertexArray m_arrays;
    std::unique_ptr<btBvhTriangleMeshShape> m_shape;
};

enum class Wiring
{
    Configuration,  // drape::CollisionConfiguration
    SolverOnly      // Bullet's configuration: install() has to follow
};

class DropWorld
{
public:
    explicit DropWorld(Plugin* plugin, Wiring wiring = Wiring::Configuration);
    ~DropWorld();

    btSoftBody& addCloth(const ClothSpec& spec, int group = 1, int mask = -1);
    // The caller keeps the shape, which must outlive the object.
    btCollisionObject& addObstacle(btCollisionShape& shape, const btTransform& pose = btTransform::getIdentity());
    // Adds a kinematic body at rest at the pose. Call setWorldTransform() before a step to set its motion.
    btRigidBody& addKinematic(btCollisionShape& shape, const btTransform& pose = btTransform::getIdentity());
    // Adds a body of `mass` kg that never sleeps.
    btRigidBody& addDynamic(btCollisionShape& shape, btScalar mass, const btTransform& pose);
    void remove(btSoftBody& cloth);            // and frees it
    void remove(btCollisionObject& obstacle);  // and frees it
    void step(int count = 1);

    btSoftRigidDynamicsWorld& world() { return m_world; }
    btCollisionDispatcher& dispatcher() { return m_dispatcher; }
    btSoftBodySolver* solver() { return m_solver.get(); }  // null: Bullet's default

private:
    std::unique_ptr<btCollisionConfiguration> m_configuration;
    std::unique_ptr<btSoftBodySolver> m_solver;  // null: Bullet's default
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
    std::vector<std::unique_ptr<btCollisionObject>> m_obstacles;
    std::vector<std::unique_ptr<btSoftBody>> m_cloths;
};

Settings hostSettings();

std::vector<float> positionsOf(const btSoftBody& cloth);  // x y z per node
TriangleMesh meshOf(const btSoftBody& cloth);
btScalar lowestOf(const btSoftBody& cloth);           // m, least y of a node
double rmsSpeed(const btSoftBody& cloth);             // m/s
btVector3 linearMomentumOf(const btSoftBody& cloth);  // kg m/s, of nodes that are not pinned
// Angular momentum about the origin, kg m²/s; no node is pinned.
btVector3 angularMomentumOf(const btSoftBody& cloth);
btVector3 angularMomentumOf(const btRigidBody& body);
int contactsHeld(const btSoftBody& cloth);  // constraints that the body has for Bullet's solver
// Compares every bit.
bool sameContacts(const std::vector<ContactInfo>& a, const std::vector<ContactInfo>& b);

// Returns the mesh with its vertices scaled, then moved by the pose.
TriangleMesh placed(const TriangleMesh& mesh, const btTransform& pose, const btVector3& scaling = btVector3(1, 1, 1));

// FNV-1a over the bits of all positions so far; start with kHashStart.
constexpr std::uint64_t kHashStart = 0xcbf29ce484222325ull;
std::uint64_t hashOf(const btSoftBody& cloth, std::uint64_t hash = kHashStart);

// The results of the independent check over a number of steps.
struct Course
{
    double m_penetrationMax = 0;  // m, of all steps
    StepMeasure m_end;            // after the last step
    std::uint64_t m_hash = kHashStart;
};
Course runMeasured(DropWorld& world, btSoftBody& cloth, const TriangleMesh& obstacle, int steps);

// Fails the test unless nothing ever got below the surface and nothing intersects at the end.
void expectClean(const Course& course);
}  // namespace drape::test
