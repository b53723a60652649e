// A scene of cloth (scenes/cloth_scene.h) as a world of Bullet's, with Drape's collision or with Bullet's own.
//
// Cloth is soft bodies that collide with themselves and with each other; obstacles are kinematic triangle meshes.
// Springs have their lengths from the cloth at rest. Held nodes have no mass.
#pragma once

#include <memory>
#include <vector>

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletCollisionCommon.h>
#include <btBulletDynamicsCommon.h>
#include <drape/drape.h>

#include "scenes/cloth_scene.h"

namespace drape
{
// Bullet's ways of keeping cloth from cloth: nodes against faces of other bodies (VF_SS), or convex clusters of nodes,
// of the same body, too (CL_SS and CL_SELF).
enum class BulletCollision
{
    NodesAndFaces,
    Clusters
};

struct SceneWorldOptions
{
    int m_iterations = 2;     // piterations; cloth in folds needs short steps more than iterations
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
    // Without Drape.
    SceneWorld(const ClothScene& scene, BulletCollision collision, const SceneWorldOptions& options = {});
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

    SceneWorld(const ClothScene& scene, std::unique_ptr<btCollisionConfiguration> configuration,
               std::unique_ptr<btSoftBodySolver> solver);
    btSoftBody& addCloth(const SceneCloth& cloth, const SceneWorldOptions& options);
    void addObstacle(const SceneObstacle& obstacle);
    void moveTo(double time);

    const ClothScene& m_scene;
    std::unique_ptr<btCollisionConfiguration> m_configuration;
    std::unique_ptr<btSoftBodySolver> m_solver;
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
