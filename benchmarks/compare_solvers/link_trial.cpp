#include "benchmarks/compare_solvers/link_trial.h"

#include <drape/drape.h>

#include <algorithm>
#include <cmath>

#include "bullet_plugin/core/solver/link_strength.h"
#include "tools/cloth_drop/drop_world.h"

namespace drape::bench
{
namespace
{
constexpr double kStep = 1.0 / 60;    // s
constexpr double kGravity = 9.81;     // m/s², that of DropWorld
constexpr int kSweepsOfASubstep = 3;  // sweeps over the links in each of Drape's substeps

// A world without obstacles. The plugin is null for Bullet's own solver.
std::unique_ptr<DropWorld> makeWorld(Plugin* plugin)
{
    if (plugin)
        return std::make_unique<DropWorld>(std::make_unique<CollisionConfiguration>(*plugin),
                                           std::make_unique<SoftBodySolver>(*plugin));
    return std::make_unique<DropWorld>(std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>(), nullptr);
}

// Returns the number of Bullet's steps in a step.
int stepsOf(const LinkSetting& setting, LinkSolver solver)
{
    return solver == LinkSolver::BulletInSubsteps ? setting.m_iterations : 1;
}

void configure(btSoftBody& body, const LinkSetting& setting, LinkSolver solver)
{
    const int steps = stepsOf(setting, solver);
    double stiffness = setting.m_stiffness;
    body.m_cfg.piterations = setting.m_iterations;
    if (steps > 1)
    {
        stiffness = visitShare(stiffness, setting.m_iterations, steps, kSweepsOfASubstep);
        body.m_cfg.piterations = kSweepsOfASubstep;
    }
    body.m_cfg.kDP = btScalar(1 - std::pow(1 - setting.m_damping, 1.0 / steps));
    body.m_materials[0]->m_kLST = btScalar(stiffness);
    body.updateConstants();
    if (solver == LinkSolver::BulletShuffled) body.randomizeConstraints();
    body.setActivationState(DISABLE_DEACTIVATION);
}

LinkStep measure(const btSoftBody& body)
{
    LinkStep step;
    double speed2 = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btSoftBody::Node& node = body.m_nodes[i];
        for (int axis = 0; axis < 3; ++axis)
            step.m_positions.push_back(float(node.m_x[axis]));
        if (!(node.m_im > 0)) continue;
        const double mass = 1 / double(node.m_im);
        step.m_kinetic += 0.5 * mass * double(node.m_v.length2());
        step.m_potential += mass * kGravity * double(node.m_x.y());
        speed2 += double(node.m_v.length2());
    }
    step.m_speed = std::sqrt(speed2 / body.m_nodes.size());
    for (int i = 0; i < body.m_links.size(); ++i)
    {
        const btSoftBody::Link& link = body.m_links[i];
        const double stretch = double((link.m_n[0]->m_x - link.m_n[1]->m_x).length() / link.m_rl) - 1;
        step.m_stretchMean += stretch / body.m_links.size();
        step.m_stretchMax = std::max(step.m_stretchMax, stretch);
    }
    return step;
}
}  // namespace

const char* nameOf(LinkSolver solver)
{
    switch (solver)
    {
        case LinkSolver::Bullet:
            return "bullet";
        case LinkSolver::BulletShuffled:
            return "bullet_shuffled";
        case LinkSolver::BulletInSubsteps:
            return "bullet_in_substeps";
        default:
            return "drape";
    }
}

LinkRun runLinks(const LinkScene& scene, int nodes, const LinkSetting& setting, LinkSolver solver, int steps,
                 const Settings& settings)
{
    Settings own = settings;
    own.m_solver = Solver::Drape;
    const std::unique_ptr<Plugin> plugin(solver == LinkSolver::Drape ? new Plugin(own) : nullptr);
    const std::unique_ptr<DropWorld> world = makeWorld(plugin.get());
    const std::unique_ptr<btSoftBody> body = scene.m_make(world->world().getWorldInfo(), nodes);
    configure(*body, setting, solver);
    world->world().addSoftBody(body.get());
    LinkRun run;
    run.m_start = measure(*body);
    const int parts = stepsOf(setting, solver);
    for (int step = 0; step < steps; ++step)
    {
        double ms = 0;
        for (int part = 0; part < parts; ++part)
        {
            if (scene.m_drive) scene.m_drive(*body, nodes, kStep * (step + double(part + 1) / parts));
            ms += world->step(kStep / parts);
        }
        run.m_stepMs.add(ms);
        run.m_steps.push_back(measure(*body));
    }
    world->world().removeSoftBody(body.get());
    return run;
}
}  // namespace drape::bench
