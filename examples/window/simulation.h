// The world that drape_window shows: one scene, with Drape or with Bullet's own collision.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "drape/drape.h"
#include "scenes/cloth_scene.h"
#include "tools/scene_world/scene_world.h"

namespace drape::window
{
// A node that the mouse holds, and where it pulls it, m.
struct Held
{
    int m_cloth = -1, m_node = -1;  // -1: none
    btVector3 m_target = btVector3(0, 0, 0);

    bool any() const { return m_node >= 0; }
};

class Simulation
{
public:
    explicit Simulation(const Settings& settings) : m_plugin(withNames(settings)) {}

    // Begins the scene anew. Bullet's world of another scene is left alive until the program ends: to free its distance
    // field takes up to minutes.
    void start(const ClothScene& scene, bool byBullet);
    // Runs a frame of the scene. Records impulses if `records`.
    void step(bool records);

    const ClothScene& scene() const { return m_scene; }
    bool isByBullet() const { return m_byBullet; }
    SceneWorld& world() { return *m_world; }
    const Plugin& plugin() const { return m_plugin; }
    int steps() const { return m_steps; }
    double stepMs() const { return m_stepMs; }
    // Returns the mean of the last steps, ms.
    double meanStepMs() const;
    // Returns the wall times of the last steps, ms, oldest first.
    const std::array<float, 120>& history() const { return m_history; }

    Held m_held;

private:
    Settings withNames(Settings settings) const
    {
        settings.m_nameOf = [this](const btCollisionObject& body) { return nameOf(m_scene, body); };
        return settings;
    }
    void pullHeld();

    ClothScene m_scene;
    Plugin m_plugin;
    std::unique_ptr<SceneWorld> m_world;
    bool m_byBullet = false;
    int m_steps = 0;
    double m_stepMs = 0;
    std::array<float, 120> m_history = {};
};
}  // namespace drape::window
