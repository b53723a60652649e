// idle_cost: what Drape costs an app beside stock Bullet where it has nothing to do: start, first step, each step and
// memory.
//
// The worlds of all methods run in turns, a few steps each, so that a busy machine slows all of them. A difference is
// the median over the rounds of what a method took longer than stock Bullet in the same round.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>

#include <unistd.h>

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <CLI/CLI.hpp>
#include <btBulletDynamicsCommon.h>
#include <drape/drape.h>

#include "benchmarks/support/arguments.h"
#include "benchmarks/support/samples.h"
#include "tools/common/program.h"

namespace drape::bench
{
namespace
{
constexpr const char* kProgram = "idle_cost";
constexpr btScalar kDt = btScalar(1.0 / 60);  // s
constexpr int kMethods = 3;
const char* const kMethodNames[kMethods] = {"stock", "drape_bullet_links", "drape"};
constexpr double kEmptyLimitUs = 1, kFallLimit = 0.02;

const std::vector<std::string> kScenes = {"empty", "rigid_100", "fall_33", "fall_65"};

struct IdleOptions : CommonOptions
{
    std::vector<std::string> m_scenes;
    int m_steps = 6000, m_together = 0;
    unsigned m_threads = 1;
    bool m_check = false;
};

double residentMiB()
{
    std::ifstream file("/proc/self/statm");
    double size = 0, pages = 0;
    file >> size >> pages;
    return pages * double(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

double usOf(double ms)
{
    return 1e3 * ms;
}

// A world of one method and its bodies. Worlds with cloth have a mesh that is far away.
class IdleWorld
{
public:
    IdleWorld(const std::string& scene, Plugin* plugin)
        : m_configuration(plugin ? std::unique_ptr<btCollisionConfiguration>(new CollisionConfiguration(*plugin))
                                 : std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>()),
          m_solver(plugin ? std::make_unique<SoftBodySolver>(*plugin) : nullptr),
          m_dispatcher(m_configuration.get()),
          m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, m_configuration.get(), m_solver.get())
    {
        if (scene == "rigid_100") addBoxes();
        if (scene.rfind("fall_", 0) == 0) addCloth(std::stoi(scene.substr(5)));
    }
    ~IdleWorld()
    {
        if (m_cloth) m_world.removeSoftBody(m_cloth.get());
        for (const auto& body : m_bodies)
            m_world.removeRigidBody(body.get());
    }
    IdleWorld(const IdleWorld&) = delete;
    IdleWorld& operator=(const IdleWorld&) = delete;

    // Returns the time of `count` steps, us.
    double step(int count)
    {
        const Clock::time_point start = Clock::now();
        for (int i = 0; i < count; ++i)
            m_world.stepSimulation(kDt, 1, kDt);
        return usOf(millisecondsSince(start));
    }

private:
    // A hundred boxes that lie beside each other on a plate, awake.
    void addBoxes()
    {
        add(std::make_unique<btBoxShape>(btVector3(50, 1, 50)), 0, btVector3(0, -1, 0));
        for (int i = 0; i < 100; ++i)
        {
            if (i == 0) m_shapes.push_back(std::make_unique<btBoxShape>(btVector3(1, 1, 1)));
            addBody(*m_shapes.back(), 1, btVector3(btScalar(3 * (i % 10)), 1, btScalar(3 * (i / 10))));
        }
    }

    // A cloth that starts falling, a kilometre beside a mesh.
    void addCloth(int nodes)
    {
        m_triangles.addTriangle(btVector3(-1, 0, -1), btVector3(0, 0, 1), btVector3(1, 0, -1));
        add(std::make_unique<btBvhTriangleMeshShape>(&m_triangles, true), 0, btVector3(1000, 0, 0));
        m_cloth.reset(btSoftBodyHelpers::CreatePatch(m_world.getWorldInfo(), btVector3(-1, 0, -1), btVector3(1, 0, -1),
                                                     btVector3(-1, 0, 1), btVector3(1, 0, 1), nodes, nodes, 0, true));
        m_cloth->getCollisionShape()->setMargin(btScalar(0.01));
        m_cloth->m_cfg.piterations = 4;
        m_world.addSoftBody(m_cloth.get());
    }

    void add(std::unique_ptr<btCollisionShape> shape, btScalar mass, const btVector3& place)
    {
        m_shapes.push_back(std::move(shape));
        addBody(*m_shapes.back(), mass, place);
    }

    void addBody(btCollisionShape& shape, btScalar mass, const btVector3& place)
    {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(mass, inertia);
        m_bodies.push_back(std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia));
        const btTransform pose(btQuaternion::getIdentity(), place);
        m_bodies.back()->setCenterOfMassTransform(pose);
        m_bodies.back()->setInterpolationWorldTransform(pose);
        m_bodies.back()->setActivationState(DISABLE_DEACTIVATION);
        m_world.addRigidBody(m_bodies.back().get());
    }

    std::unique_ptr<btCollisionConfiguration> m_configuration;
    std::unique_ptr<btSoftBodySolver> m_solver;
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    btTriangleMesh m_triangles;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_bodies;
    std::unique_ptr<btSoftBody> m_cloth;
    btSoftRigidDynamicsWorld m_world;
};

// One method's plugin and measurements in a scene. Stock Bullet has no plugin.
struct MethodRun
{
    void start(int method, const IdleOptions& options)
    {
        Settings settings = options.settings();
        settings.m_threads = options.m_threads;
        if (method == 1) settings.m_solver = Solver::Bullet;
        const double before = residentMiB();
        const Clock::time_point begin = Clock::now();
        if (method > 0) m_plugin = std::make_unique<Plugin>(settings);
        m_constructorUs = usOf(millisecondsSince(begin));
        m_constructorMiB = residentMiB() - before;
    }

    // Makes a new world and takes its first step.
    void restart(const std::string& scene)
    {
        m_world.reset();
        const double before = residentMiB();
        m_world = std::make_unique<IdleWorld>(scene, m_plugin.get());
        m_first.add(m_world->step(1));
        if (m_first.count() == 1) m_worldMiB = residentMiB() - before;
    }

    std::unique_ptr<Plugin> m_plugin;
    std::unique_ptr<IdleWorld> m_world;
    double m_constructorUs = 0, m_constructorMiB = 0, m_worldMiB = 0;
    Samples m_first, m_steps, m_extra;  // us
};

Row rowOf(const std::string& scene, int method, const MethodRun& run, const MethodRun& stock)
{
    Row row;
    row["scene"] = scene;
    row["method"] = kMethodNames[method];
    row["constructor_us"] = run.m_constructorUs;
    row["constructor_mib"] = run.m_constructorMiB;
    row["world_mib"] = run.m_worldMiB;
    row["first_step_us"] = run.m_first.median();
    row["samples"] = run.m_steps.count();
    row["step_us"] = run.m_steps.median();
    row["step_p95_us"] = run.m_steps.quantile(0.95);
    row["extra_us"] = run.m_extra.median();
    row["extra_share"] = run.m_extra.median() / stock.m_steps.median();
    return row;
}

// Returns what the row lacks; empty if it keeps the limits. Drape's own links are other work than Bullet's.
std::string problemOf(const Row& row)
{
    const double us = row["extra_us"], share = row["extra_share"];
    const bool isFall = row["scene"].get<std::string>().rfind("fall_", 0) == 0;
    const bool isGood = isFall ? row["method"] == "drape" || share <= kFallLimit : us <= kEmptyLimitUs;
    if (isGood) return "";
    return row["scene"].get<std::string>() + ", " + row["method"].get<std::string>() + ": " +
           (isFall ? std::to_string(100 * share) + " %" : std::to_string(us) + " us") + " more a step";
}

void measure(const std::string& scene, const IdleOptions& options, Table& table)
{
    const bool isFall = scene.rfind("fall_", 0) == 0;
    // Steps that are timed together, and steps after which the worlds are made anew: a fall of ten seconds.
    const int together = options.m_together > 0 ? options.m_together : isFall ? 1 : 20;
    const int life = isFall ? 600 : options.m_steps;
    MethodRun runs[kMethods];
    for (int method = 0; method < kMethods; ++method)
        runs[method].start(method, options);
    for (int step = 0; step < options.m_steps; step += together)
    {
        double stock = 0;
        for (int turn = 0; turn < kMethods; ++turn)
        {
            MethodRun& run = runs[turn];
            if (step % life < together) run.restart(scene);
            const double us = run.m_world->step(together) / together;
            if (turn == 0) stock = us;
            run.m_steps.add(us);
            run.m_extra.add(us - stock);
        }
    }
    for (int method = 0; method < kMethods; ++method)
        table.add(rowOf(scene, method, runs[method], runs[0]));
}

int run(int argc, char** argv)
{
    CLI::App app("Measures what Drape costs beside stock Bullet where it has nothing to do.", kProgram);
    IdleOptions options;
    options.m_backend = "host";
    addCommonOptions(app, options);
    app.add_option("--scene", options.m_scenes, "empty, rigid_100, fall_33 or fall_65; all by default");
    app.add_option("--steps", options.m_steps, "steps of each world; --quick: 200 at most")
        ->check(CLI::Validator(wholeNumber(1, 10000000), ""));
    app.add_option("--together", options.m_together, "steps that are timed together; 0: 20, or 1 with cloth")
        ->check(CLI::Validator(wholeNumber(0, 1000), ""));
    app.add_option("--threads", options.m_threads, "see cloth_drop")->check(CLI::Validator(wholeNumber(0, 64), ""));
    app.add_flag("--check", options.m_check,
                 "fail if a step takes 1 us more than stock Bullet's without soft bodies, or 2 % more with Bullet's "
                 "links in free fall");
    int exitCode = kExitGood;
    const auto problem = [&] { return unknownName("--scene", options.m_scenes, kScenes); };
    if (!parseArguments(app, argc, argv, problem, exitCode)) return exitCode;
    if (options.m_quick) options.m_steps = std::min(options.m_steps, 200);
    Table table;
    for (const std::string& scene : options.m_scenes.empty() ? kScenes : options.m_scenes)
    {
        std::cerr << kProgram << ": " << scene << std::endl;
        measure(scene, options, table);
    }
    const int code = finishTable(kProgram, table, options);
    if (code != kExitGood || !options.m_check) return code;
    std::string problems;
    for (const Row& row : table.rows())
        if (row["method"] != "stock" && !problemOf(row).empty())
            problems += (problems.empty() ? "" : "; ") + problemOf(row);
    return problems.empty() ? kExitGood : fail(kProgram, kExitFailed, problems);
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("idle_cost", [&] { return drape::bench::run(argc, argv); });
}
