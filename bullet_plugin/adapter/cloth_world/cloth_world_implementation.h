// Owns the parts of a ClothWorld: Bullet's world with Drape in it, the bodies, and the last failure.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_plugin/adapter/cloth_world/cloth_body.h"
#include "bullet_plugin/adapter/cloth_world/input_checks.h"
#include "bullet_plugin/adapter/cloth_world/obstacle_body.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/core/public_call.h"
#include "drape/cloth_world.h"
#include "drape/collision_configuration.h"
#include "drape/soft_body_solver.h"

namespace drape
{
// Bodies carry their index in Bullet's user index.
struct ClothWorld::Implementation
{
    explicit Implementation(const Settings& settings);
    ~Implementation();

    // Returns the result of a public function's work; `failed` with the error filled if it throws.
    template <class Result, class Work>
    Result answer(const char* call, Result failed, const Work& work)
    {
        return guarded(
            [&]
            {
                try
                {
                    return Result(work());
                }
                catch (const InvalidInput& invalid)
                {
                    Error error;
                    error.m_kind = ErrorKind::Input;
                    error.m_call = std::string(call) + ": " + invalid.what();
                    m_error = std::move(error);
                    return failed;
                }
            },
            [&](const CaughtException& caught)
            {
                setError(m_error, call, caught);
                return failed;
            });
    }

    // Its functions throw if memory runs out; those of the plugin would give an empty answer.
    PluginState& state() { return *m_plugin.state(); }
    // Returns the settings with names for this world's bodies: their indices.
    Settings withNames(Settings settings) const;
    WorldCloth& cloth(int index);
    ObstacleBody& obstacle(int index);
    int addCloth(const ClothDescription& description);
    int addObstacle(const ObstacleDescription& description);
    void removeCloth(WorldCloth& cloth);
    void removeObstacle(std::unique_ptr<ObstacleBody>& obstacle);
    // Returns the index of a body of the last step that is still there, else -1. The body may have been deleted.
    int indexOf(const btCollisionObject* body) const;
    // Notes the bodies of the coming step.
    void noteBodies();

    Plugin m_plugin;
    CollisionConfiguration m_configuration;
    SoftBodySolver m_solver;
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
    std::vector<WorldCloth> m_cloths;                             // without a body once removed
    std::vector<std::unique_ptr<ObstacleBody>> m_obstacles;       // null once removed
    std::unordered_map<const btCollisionObject*, int> m_stepped;  // see indexOf()
    Error m_error;
};
}  // namespace drape
