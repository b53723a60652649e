#include "tools/cloth_drop/drape_settings.h"
#include "tools/cloth_drop/drop_world.h"
#include "tools/cloth_drop/plugin_simulation.h"

namespace drape
{
namespace
{
class DrapeSimulation : public PluginSimulation
{
public:
    DrapeSimulation(const DropScene& scene, const Settings& settings)
        : PluginSimulation(settings),
          m_solver(new TimedSolver(*m_plugin)),
          m_world(std::make_unique<CollisionConfiguration>(*m_plugin), std::unique_ptr<btSoftBodySolver>(m_solver)),
          m_dt(scene.m_dt)
    {
        m_world.addMeshObstacle(scene);
        m_world.addCloths(scene, false);
        for (std::size_t i = 0; scene.m_self && i < scene.m_layers; ++i)
            m_plugin->setSelfCollision(m_world.cloth(i), true);
        prepare(m_world.world());
    }

    StepTimes step() override
    {
        StepTimes times;
        const double stepMs = m_world.step(m_dt);
        addStep(stepMs, m_world.world().collisionMs(), m_solver->ms(), times);
        return times;
    }

    const std::vector<float>& positions() override { return m_world.positions(); }
    const btCollisionWorld& world() override { return m_world.world(); }

private:
    const btSoftBody& firstCloth() const override { return m_world.cloth(); }

    TimedSolver* m_solver;  // the world's
    DropWorld m_world;
    double m_dt;
};
}  // namespace

std::unique_ptr<Simulation> makeDrapeSimulation(const DropScene& scene, const Options& options, std::string& error,
                                                int& exitCode)
{
    Settings settings;
    exitCode = kExitBadInput;
    if (!drapeSettings(options, settings, error)) return nullptr;
    settings.m_nameOf = [layers = scene.m_layers](const btCollisionObject& body)
    {
        if (!btSoftBody::upcast(&body)) return std::string("the obstacle");
        return layers == 1 ? "the cloth" : "cloth " + std::to_string(body.getUserIndex());
    };
    auto simulation = std::make_unique<DrapeSimulation>(scene, settings);
    if (!isReady(simulation->plugin(), error, exitCode)) return nullptr;
    return simulation;
}
}  // namespace drape
