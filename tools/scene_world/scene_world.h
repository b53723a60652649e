// A scene of cloth (scenes/cloth_scene.h) as a world of Bullet's, with Drape's collision or with Bullet's own.
//
// Cloth is soft bodies, obstacles are kinematic or dynamic rigid bodies (scene_bodies.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <drape/drape.h>

#include "scenes/cloth_scene.h"
#include "tools/scene_world/scene_bodies.h"
#include "tools/scene_world/timed_solver.h"
#include "tools/scene_world/timed_world.h"

namespace drape
{
// Bullet's ways of keeping cloth from other cloth: nodes against faces (VF_SS), or convex clusters of nodes (CL_SS).
// Neither keeps a cloth from itself.
enum class BulletCollision
{
    NodesAndFaces,
    Clusters
};

// Returns the name of a SceneWorld's body in lines: its kind and its name, and its number if no other tells it apart.
std::string nameOf(const ClothScene& scene, const btCollisionObject& body);

// Bodies carry their index in the scene as Bullet's user index.
class SceneWorld
{
public:
    // The scene and the plugin must outlive the world.
    SceneWorld(const ClothScene& scene, Plugin& plugin);
    // Without Drape.
    SceneWorld(const ClothScene& scene, BulletCollision collision);
    ~SceneWorld();

    // Moves what the scene moves to where it is after `dt` more seconds, and runs one step. Returns its wall time, ms.
    double step(double dt);
    double time() const { return m_time; }
    // Gives held nodes their mass back: the scene moves them no more.
    void release();

    TimedWorld& world() { return m_world; }
    // Returns the time that the last step spent in Drape's solver, ms; 0 without Drape.
    double solverMs() const { return m_timedSolver != nullptr ? m_timedSolver->ms() : 0; }
    btSoftBody& cloth(std::size_t index) { return *m_cloths[index]; }
    const btSoftBody& cloth(std::size_t index) const { return *m_cloths[index]; }
    std::size_t clothCount() const { return m_cloths.size(); }
    // Returns where an obstacle is.
    btTransform obstaclePose(std::size_t index) const { return m_obstacles[index].m_body->getWorldTransform(); }
    // Returns all cloths as one mesh, and their nodes where they are, x y z each, m.
    TriangleMesh mesh() const;
    // Returns the links of ropes, two nodes of mesh() each.
    std::vector<std::int32_t> lines() const;
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
    SceneWorld(const ClothScene& scene, std::unique_ptr<btCollisionConfiguration> configuration,
               std::unique_ptr<btSoftBodySolver> solver);
    btSoftBody& addCloth(const SceneCloth& cloth);
    void addObstacle(const SceneObstacle& obstacle);
    void moveTo(double time);

    const ClothScene& m_scene;
    std::unique_ptr<btCollisionConfiguration> m_configuration;
    std::unique_ptr<btSoftBodySolver> m_solver;
    TimedSolver* m_timedSolver = nullptr;  // m_solver with Drape
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    TimedWorld m_world;
    std::vector<std::unique_ptr<btSoftBody>> m_cloths;
    std::vector<ObstacleBody> m_obstacles;
    std::vector<float> m_positions;
    double m_time = 0;
    bool m_isReleased = false;
};
}  // namespace drape
