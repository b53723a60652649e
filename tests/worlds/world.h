// One random world in Bullet: cloths, obstacles of triangle meshes that rest or move, dynamic bodies, and the time
// steps.
//
// Owns its objects. Nothing here is random except the time steps of two ways of stepping, which have a seed. SI units,
// y up.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <drape/drape.h>

#include "scenes/mesh.h"
#include "tests/worlds/world_random.h"

namespace drape::test
{
enum class WorldBackend
{
    Host,
    OpenCl,
    Stock,    // Bullet's own collision
    Substeps  // the host, with Drape's solver of links
};

struct WorldObstacle
{
    TriangleMesh m_mesh;
    std::unique_ptr<btTriangleIndexVertexArray> m_arrays;
    std::unique_ptr<btBvhTriangleMeshShape> m_meshShape;
    std::unique_ptr<btScaledBvhTriangleMeshShape> m_scaledShape;  // null: the mesh shape itself is used
    std::vector<std::unique_ptr<btCompoundShape>> m_compounds;
    std::unique_ptr<btBoxShape> m_box;                    // null: the mesh shape is used
    btTransform m_inObject = btTransform::getIdentity();  // pose of the mesh within its compounds
    std::unique_ptr<btCollisionObject> m_object;
    std::function<btTransform(double time)> m_motion;  // pose of the object over time; empty: the object rests
    std::function<void(double time)> m_beforeStep;     // other changes; may be empty
    bool m_frontsUp = false;  // the upper side of every triangle is its front, whatever its winding

    btCollisionShape& shape();
    btVector3 scaling() const;
};

struct WorldCloth
{
    std::unique_ptr<btSoftBody> m_body;
    std::function<void(double time, btSoftBody& body)> m_drive;  // before each step; may be empty
};

struct ObstacleSpec
{
    btTransform m_pose = btTransform::getIdentity();
    bool m_kinematic = false;
    double m_friction = .5;
    int m_compoundDepth = 0;               // 0: no compound
    const btVector3* m_scaling = nullptr;  // null: no scaled shape
};

// A dynamic body. Its shape is a btBoxShape if it is a box, else a triangle mesh.
struct LoadSpec
{
    bool m_isBox = false;
    double m_mass = 1;  // kg
    btTransform m_pose = btTransform::getIdentity();
    btVector3 m_velocity = btVector3(0, 0, 0), m_spin = btVector3(0, 0, 0);  // m/s, rad/s
    double m_friction = .5;
};

struct GridSpec
{
    int m_nodesX, m_nodesZ;
    double m_sizeX, m_sizeZ;  // m
    btTransform m_pose;
    bool m_bending = true;
};

enum class Stepping
{
    OneStep,     // one step of m_dt
    FixedSteps,  // Bullet divides m_dt into steps of m_fixedDt
    UnevenTime,  // Bullet divides 2 to 50 ms into steps of m_fixedDt
    UnevenSteps  // one step of 0.1 to 100 ms
};

class World
{
public:
    // Throws where Drape cannot start on the back end.
    explicit World(WorldBackend backend);
    ~World();
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    WorldObstacle& addObstacle(const TriangleMesh& mesh, const ObstacleSpec& spec);
    // mesh: of the box, if it is one.
    WorldObstacle& addLoad(const TriangleMesh& mesh, const LoadSpec& spec);
    WorldCloth& addGrid(const GridSpec& spec);
    WorldCloth& addCloth(std::unique_ptr<btSoftBody> body);  // the body has its margin
    void addBody(std::unique_ptr<btRigidBody> body, std::unique_ptr<btCollisionShape> shape);

    // Brings the cloths into the world; nothing is added after it.
    void start();
    // Moves what is driven, and steps. Returns the number of Bullet's steps that ran.
    int step();

    btSoftRigidDynamicsWorld& bullet() { return *m_world; }
    const std::vector<std::unique_ptr<WorldObstacle>>& obstacles() const { return m_obstacles; }
    const std::vector<std::unique_ptr<WorldCloth>>& cloths() const { return m_cloths; }
    // Returns the status bits of all of Bullet's steps so far in the last call of step(); 0 with Bullet's own
    // collision.
    std::uint32_t status() const { return m_status; }
    // Continues an FNV-1a hash over all positions as float32; starts with kHashStart.
    std::uint64_t hash(std::uint64_t hash) const;
    static constexpr std::uint64_t kHashStart = 0xcbf29ce484222325ull;

    double m_clothMargin = .01, m_obstacleMargin = .01;  // m, of objects that are added from now on
    Stepping m_stepping = Stepping::OneStep;
    double m_dt = 1. / 60, m_fixedDt = 1. / 60;  // s
    int m_mostSubsteps = 0;
    WorldRandom m_timeRandom{1};
    int m_frames = 90;                     // calls of step() that the world is made for
    std::function<void()> m_betweenSteps;  // called between two of Bullet's steps in one call of step(); may be empty

private:
    double nextDuration();
    int stepBullet(double duration);
    static void beforeBulletStep(btDynamicsWorld* world, btScalar duration);
    void makeShape(WorldObstacle& obstacle, const ObstacleSpec& spec);
    btCollisionShape* wrapInCompounds(WorldObstacle& obstacle, int depth);

    std::unique_ptr<Plugin> m_plugin;
    std::unique_ptr<btCollisionConfiguration> m_configuration;
    std::unique_ptr<btSoftBodySolver> m_solver;  // null: Bullet's default
    std::unique_ptr<btCollisionDispatcher> m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    std::unique_ptr<btSoftRigidDynamicsWorld> m_world;
    std::vector<std::unique_ptr<WorldObstacle>> m_obstacles;
    std::vector<std::unique_ptr<WorldCloth>> m_cloths;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_bodies;
    double m_time = 0;
    std::uint32_t m_status = 0;
    int m_bulletSteps = 0;  // Bullet steps that began in this call of step()
};

// Returns the pose of compound number `level` (from 1 on) within the one around it.
btTransform compoundPose(int level);

btTransform shifted(double x, double y, double z);
btTransform turned(const btVector3& axis, double angle, double x = 0, double y = 0, double z = 0);
}  // namespace drape::test
