#include <drape/drape.h>
#include <drape/recorder.h>

#include <iostream>

#include "tools/cloth_drop/drop_world.h"
#include "tools/cloth_drop/simulation.h"
#include "tools/cloth_drop/timed_solver.h"
#include "tools/common/device_option.h"

namespace drape
{
namespace
{
class DrapeSimulation : public Simulation
{
public:
    DrapeSimulation(const DropScene& scene, const Settings& settings)
        : m_plugin(std::make_unique<Plugin>(settings)),
          m_solver(new TimedSolver(*m_plugin)),
          m_world(std::make_unique<CollisionConfiguration>(*m_plugin), std::unique_ptr<btSoftBodySolver>(m_solver)),
          m_dt(scene.m_dt)
    {
        m_plugin->awaitDevice();
        m_world.addMeshObstacle(scene);
        m_world.addCloths(scene, false);
        for (std::size_t i = 0; scene.m_self && i < scene.m_layers; ++i)
            m_plugin->setSelfCollision(m_world.cloth(i), true);
        const TimedSolver::Timer timer(m_meshesMs);
        m_plugin->prepare(m_world.world());
    }

    const Plugin& plugin() const { return *m_plugin; }

    StepTimes step() override
    {
        StepTimes times;
        times.m_stepMs = m_world.step(m_dt);
        const StepStatistics& statistics = m_plugin->statistics();
        times.m_parts = partsOf(statistics, times.m_stepMs, m_world.world().collisionMs(), m_solver->ms());
        times.m_collisionMs = times.m_parts.m_dispatchMs + statistics.collisionMs();
        times.m_contacts = statistics.m_contacts;
        times.m_candidates = statistics.m_candidates;
        times.m_sweptTests = statistics.m_sweptTests;
        times.m_clothsSkipped = statistics.m_clothsSkipped;
        times.m_obstaclesKept = statistics.m_obstaclesKept;
        times.m_skipped = statistics.m_skipped;
        times.m_onHost = statistics.m_onHost;
        m_status |= statistics.m_status;
        return times;
    }

    const std::vector<float>& positions() override { return m_world.positions(); }
    const btCollisionWorld& world() override { return m_world.world(); }
    void addContacts(Recorder& recorder) const override { recorder.addContacts(*m_plugin); }
    std::string backend() const override { return m_plugin->device().m_onHost ? "host" : "opencl"; }
    std::string device() const override { return m_plugin->device().m_device.m_name; }
    std::string deviceReason() const override { return m_plugin->device().m_reason; }
    std::string solver() const override
    {
        return m_plugin->whyBulletSolves(m_world.cloth()).empty() ? "drape" : "bullet";
    }
    double prepareMs() const override
    {
        return m_plugin->device().m_buildMs + m_plugin->device().m_measureMs + m_meshesMs;
    }
    std::string trouble() const override
    {
        const std::string status = statusText(m_status);
        if (m_plugin->error().empty()) return status;
        return status + (status.empty() ? "" : "; ") + m_plugin->device().m_reason;
    }

private:
    std::unique_ptr<Plugin> m_plugin;  // before the world, which uses it
    TimedSolver* m_solver;             // the world's
    DropWorld m_world;
    double m_dt;
    double m_meshesMs = 0;  // time to prepare cloth and obstacle
    std::uint32_t m_status = 0;
};
}  // namespace

std::unique_ptr<Simulation> makeDrapeSimulation(const DropScene& scene, const Options& options, std::string& error,
                                                int& exitCode)
{
    Settings settings;
    exitCode = kExitBadInput;
    if (!deviceSettings(options.m_backend, options.m_device, settings, error)) return nullptr;
    settings.m_threads = options.m_threads;
    settings.m_mode = options.m_contactMode == "discrete"     ? ContactMode::Discrete
                      : options.m_contactMode == "continuous" ? ContactMode::Continuous
                                                              : ContactMode::Automatic;
    settings.m_solverPlace = options.m_solverPlace == "host"     ? SolverPlace::Host
                             : options.m_solverPlace == "device" ? SolverPlace::Device
                                                                 : SolverPlace::Auto;
    settings.m_solver = options.m_solver == "drape"    ? Solver::Drape
                        : options.m_solver == "bullet" ? Solver::Bullet
                                                       : Solver::Auto;
    auto simulation = std::make_unique<DrapeSimulation>(scene, settings);
    error = simulation->plugin().error();
    if (!simulation->plugin().ready())
    {
        exitCode = kExitFailed;
        return nullptr;
    }
    if (!error.empty()) std::cerr << "cloth_drop: " << error << "\n";  // a device that failed; the host goes on
    error.clear();
    return simulation;
}
}  // namespace drape
