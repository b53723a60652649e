// Whole steps of Bullet with Drape. The cloths start where the scene drapes them and come to rest under gravity.
#include "benchmarks/bench_step/world_method.h"

#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <vector>

#include "benchmarks/support/machine.h"
#include "tools/cloth_drop/drop_world.h"
#include "tools/cloth_drop/step_parts.h"
#include "tools/scene_world/timed_solver.h"

namespace drape::bench
{
namespace
{
constexpr double kStep = 1.0 / 60;  // s

class WorldMethod : public StepMethod
{
public:
    WorldMethod(std::unique_ptr<Plugin> plugin, const StepScene& scene)
        : m_plugin(std::move(plugin)),
          m_solver(new TimedSolver(*m_plugin)),
          m_world(std::make_unique<CollisionConfiguration>(*m_plugin), std::unique_ptr<btSoftBodySolver>(m_solver))
    {
        DropScene obstacle;
        obstacle.m_obstacle = scene.m_obstacle;
        obstacle.m_thickness = double(scene.m_thickness);
        m_world.addMeshObstacle(obstacle);
        for (const TriangleMesh& cloth : scene.m_cloths)
            addCloth(cloth, scene.m_thickness);
        const TimedSolver::Timer timer(m_prepareMs);
        m_plugin->prepare(m_world.world());
    }
    ~WorldMethod() override
    {
        for (const std::unique_ptr<btSoftBody>& cloth : m_cloths)
            m_world.world().removeSoftBody(cloth.get());
    }

    // The cloths move as Bullet moves them.
    StepOutcome step(const float* /*start*/, const float* /*end*/) override
    {
        StepOutcome outcome;
        const double ms = m_world.step(kStep);
        const StepStatistics& statistics = m_plugin->statistics();
        const WholeStepParts parts = partsOf(statistics, ms, m_world.world().collisionMs(), m_solver->ms());
        outcome.m_stages.push_back({"step", ms});
        for (const NamedPart& part : stepParts())
            outcome.m_stages.push_back({std::string("part: ") + part.m_name, parts.*part.m_ms});
        outcome.m_candidates = std::size_t(statistics.m_candidates);
        outcome.m_contacts = statistics.m_contacts;
        return outcome;
    }

    void describe(Row& row) const override
    {
        const DeviceReport& report = m_plugin->device();
        row["backend"] = report.m_onHost ? "host" : "opencl";
        fillDevice(row, report.m_device);
        row["prepare_ms"] = m_prepareMs;
        row["kernels_ms"] = report.m_buildMs;
    }

private:
    void addCloth(const TriangleMesh& mesh, float thickness)
    {
        const std::vector<btScalar> positions(mesh.m_positions.begin(), mesh.m_positions.end());
        const std::vector<int> triangles(mesh.m_triangles.begin(), mesh.m_triangles.end());
        btSoftBody* const cloth = btSoftBodyHelpers::CreateFromTriMesh(
            m_world.world().getWorldInfo(), positions.data(), triangles.data(), int(mesh.triangleCount()), false);
        m_cloths.emplace_back(cloth);
        cloth->setTotalMass(1);
        cloth->getCollisionShape()->setMargin(btScalar(0.5f * thickness));
        cloth->m_cfg.piterations = 5;
        cloth->m_cfg.kDP = btScalar(0.02);
        cloth->m_cfg.kDF = btScalar(0.6);
        m_world.world().addSoftBody(cloth);
    }

    std::unique_ptr<Plugin> m_plugin;  // before the world, which uses it
    TimedSolver* m_solver;             // the world's
    DropWorld m_world;
    std::vector<std::unique_ptr<btSoftBody>> m_cloths;
    double m_prepareMs = 0;
};
}  // namespace

std::unique_ptr<StepMethod> makeWorldMethod(const StepScene& scene, const Settings& settings, std::string& error)
{
    auto plugin = std::make_unique<Plugin>(settings);
    error = plugin->error();
    if (!plugin->ready()) return nullptr;
    return std::make_unique<WorldMethod>(std::move(plugin), scene);
}
}  // namespace drape::bench
