// A scene of cloth (scenes/cloth_scene.h) as a world of Bullet's.
//
// Cloth is soft bodies that collide with themselves and with each other; obstacles are kinematic triangle meshes.
// Springs have their lengths from the cloth at rest. Held nodes have no mass.
#pragma once

#include <memory>
#include <vector>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletCollisionCommon.h>
#include <btBulletDynamicsCommon.h>
#include <drape/drape.h>

#include "scenes/cloth_scene.h"

namespace drape
{
struct SceneWorldOptions
{
    int m_iterations = 5;     // piterations
    double m_damping = 0.02;  // kDP
    double m_friction = 0.6;  // kDF; the obstacles' coefficient is 1
    double m_stiffness = 1;   // kLST of edges
    double m_bending = 0.02;  // kLST of bending springs
};

class SceneWorld
{
public:
    // The scene and the plugin must outlive the world.
    SceneWorld(const ClothScene& scene, Plugin& plugin, const SceneWorldOptions& options = {});
    ~SceneWorld();

    // Moves what the scene moves to where it is after `dt` more seconds, and runs one step. Returns its wall time, ms.
    double step(double dt);
    double time() const { return m_time; }
    // Gives held nodes their mass back: the scene moves them no more.
    void release();

    btSoftRigidDynamicsWorld& world() { return m_world; }
    btSoftBody& cloth(std::size_t index) { return *m_cloths[index]; }
    // Returns all cloths as one mesh, and their nodes where they are, x y z each, m.
    TriangleMesh mesh() const;
    const std::vector<float>& positions();
    // Appends the obstacles' vertices where they are, x y z each, m.
    void addObstaclePositions(std::vector<float>& positions) const;
    // Returns the stretch of the cloths' edges: their lengths over those at rest, less 1.
    struct Stretch
    {
        double m_mean, m_most;
    };
    Stretch stretch() const;

private:
    struct Obstacle
    {
        std::unique_ptr<btTriangleIndexVertexArray> m_arrays;
        std::unique_ptr<btBvhTriangleMeshShape> m_shape;
        std::unique_ptr<btRigidBody> m_body;
    };

    void addCloth(const SceneCloth& cloth, Plugin& plugin, const SceneWorldOptions& options);
    void addObstacle(const SceneObstacle& obstacle);
    void moveTo(double time);

    const ClothScene& m_scene;
    CollisionConfiguration m_configuration;
    SoftBodySolver m_solver;
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
    std::vector<std::unique_ptr<btSoftBody>> m_cloths;
    std::vector<Obstacle> m_obstacles;
    std::vector<float> m_positions;
    double m_time = 0;
    bool m_isReleased = false;
};
}  // namespace drape
