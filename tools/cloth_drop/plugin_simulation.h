// A simulation with Drape's plugin: what all of them say about it.
#pragma once

#include <drape/drape.h>
#include <drape/recorder.h>

#include <memory>
#include <string>

#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include "tools/cloth_drop/simulation.h"
#include "tools/scene_world/timed_solver.h"

namespace drape
{
class PluginSimulation : public Simulation
{
public:
    explicit PluginSimulation(const Settings& settings) : m_plugin(std::make_unique<Plugin>(settings))
    {
        m_plugin->awaitDevice();
    }

    const Plugin& plugin() const { return *m_plugin; }
    void addContacts(Recorder& recorder) const override { recorder.addContacts(*m_plugin); }
    std::string backend() const override { return m_plugin->device().m_onHost ? "host" : "opencl"; }
    std::string device() const override { return m_plugin->device().m_device.m_name; }
    std::string deviceReason() const override { return m_plugin->device().m_reason; }
    std::string solver() const override { return m_plugin->whyBulletSolves(firstCloth()).empty() ? "drape" : "bullet"; }
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

protected:
    virtual const btSoftBody& firstCloth() const = 0;

    // Prepares cloth and obstacles.
    void prepare(btSoftRigidDynamicsWorld& world)
    {
        const TimedSolver::Timer timer(m_meshesMs);
        m_plugin->prepare(world);
    }

    // Adds the times and counts of a step, which took stepMs. collisionMs and solverMs: of Bullet's collision detection
    // and of its calls of the solver.
    void addStep(double stepMs, double collisionMs, double solverMs, StepTimes& times)
    {
        const StepStatistics& statistics = m_plugin->statistics();
        const WholeStepParts parts = partsOf(statistics, stepMs, collisionMs, solverMs);
        for (const NamedPart& part : stepParts())
            times.m_parts.*part.m_ms += parts.*part.m_ms;
        times.m_stepMs += stepMs;
        times.m_collisionMs += parts.m_dispatchMs + statistics.collisionMs();
        times.m_contacts = statistics.m_contacts;
        times.m_candidates += statistics.m_candidates;
        times.m_sweptTests += statistics.m_sweptTests;
        times.m_clothsSkipped += statistics.m_clothsSkipped;
        times.m_obstaclesKept += statistics.m_obstaclesKept;
        times.m_skipped = statistics.m_skipped;
        times.m_onHost = statistics.m_onHost;
        m_status |= statistics.m_status;
    }

    std::unique_ptr<Plugin> m_plugin;  // before the world of a derived class, which uses it

private:
    double m_meshesMs = 0;  // time to prepare cloth and obstacles
    std::uint32_t m_status = 0;
};
}  // namespace drape
