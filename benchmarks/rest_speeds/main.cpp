// rest_speeds: measures how much cloth moves that should lie still, in several falls on each obstacle.
//
// Cloth of 33 x 33 nodes falls, gets steps to settle, and is measured over the steps after them (oracle/rest_meter.h).
#include <algorithm>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>
#include <drape/drape.h>

#include "benchmarks/error_vs_time/error_scene.h"
#include "benchmarks/support/arguments.h"
#include "benchmarks/support/result_hash.h"
#include "oracle/measure.h"
#include "oracle/rest_meter.h"
#include "scenes/models.h"
#include "tools/cloth_drop/drop_world.h"
#include "tools/cloth_drop/node_positions.h"
#include "tools/common/program.h"

namespace drape::bench
{
namespace
{
constexpr const char* kProgram = "rest_speeds";

const std::vector<std::string> kScenes = {"stairs", "pile", "bunny", "dragon"};

struct RestOptions : CommonOptions
{
    std::vector<std::string> m_scenes;
    std::vector<int> m_falls = {1, 2, 3, 4, 5, 6, 7, 8};
    int m_settle = 400, m_steps = 2000;
    unsigned m_threads = 0;
    double m_damping = 0.02;  // kDP
    double m_most = 0;        // mm/s; 0 for no limit
};

double rmsVelocity(const btSoftBody& cloth)
{
    double sum2 = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        sum2 += double(cloth.m_nodes[i].m_v.length2());
    return std::sqrt(sum2 / cloth.m_nodes.size());
}

Row measure(const RestOptions& options, const ErrorScene& scene, int fall)
{
    Settings settings = options.settings();
    settings.m_threads = options.m_threads;
    Plugin plugin(settings);
    DropWorld world(std::make_unique<CollisionConfiguration>(plugin), std::make_unique<SoftBodySolver>(plugin));
    world.addMeshObstacle(scene.m_drop);
    world.addCloth(scene.m_drop, false);
    world.cloth().m_cfg.kDP = btScalar(options.m_damping);
    for (int i = 0; i < options.m_settle; ++i)
        world.step(scene.m_drop.m_dt);
    std::vector<float> positions;
    copyPositions(world.cloth(), positions);
    RestMeter meter(positions);
    double velocity2 = 0;
    std::uint32_t status = 0;
    for (int i = 0; i < options.m_steps; ++i)
    {
        world.step(scene.m_drop.m_dt);
        copyPositions(world.cloth(), positions);
        meter.add(positions, scene.m_drop.m_dt);
        velocity2 += std::pow(rmsVelocity(world.cloth()), 2) / options.m_steps;
        status |= plugin.statistics().m_status;
    }
    const StepMeasure check =
        PenetrationMeter(scene.m_drop.m_obstacle, scene.m_drop.m_cloth.m_mesh).measure(positions.data());
    Row row;
    row["scene"] = scene.m_name;
    row["fall"] = fall;
    row["damping"] = options.m_damping;
    row["settle"] = options.m_settle;
    row["steps"] = options.m_steps;
    row["speed_mm_s"] = 1e3 * meter.speed();
    row["velocity_mm_s"] = 1e3 * std::sqrt(velocity2);
    row["creep_mm_s"] = 1e3 * meter.creep();
    row["worst_step_mm_s"] = 1e3 * meter.worstStep();
    row["fastest_node_mm_s"] = 1e3 * meter.fastestNode();
    row["farthest_mm"] = 1e3 * meter.farthest();
    row["intersecting"] = check.m_intersectingPairs;
    row["gap_least"] = check.m_gapMin;
    row["status"] = status;
    row["hash"] = hashText(hashOf(positions, kEmptyHash));
    return row;
}

int measureAll(const RestOptions& options)
{
    Table table;
    double most = 0;
    for (const std::string& name : options.m_scenes.empty() ? kScenes : options.m_scenes)
    {
        ErrorScene scene;
        std::string error;
        if (!makeErrorScene(name, options.m_quick, modelFolders(options.m_models), scene, error))
        {
            table.leaveOut(name + ": " + error);
            continue;
        }
        for (const int fall : options.m_falls)
        {
            ErrorScene varied = scene;
            varyFall(varied, std::uint32_t(fall));
            const Row row = measure(options, varied, fall);
            std::cerr << kProgram << ": " << name << ", fall " << fall << std::endl;
            most = std::max(most, double(row["speed_mm_s"]));
            table.add(row);
        }
    }
    const int code = finishTable(kProgram, table, options);
    if (code == kExitGood && options.m_most > 0 && most > options.m_most) return kExitFailed;
    return code;
}

int run(int argc, char** argv)
{
    CLI::App app("Measures the motion of cloth at rest.", kProgram);
    RestOptions options;
    options.m_backend = "host";
    addCommonOptions(app, options);
    app.add_option("--scene", options.m_scenes, "stairs, pile, bunny or dragon; all by default");
    app.add_option("--fall", options.m_falls, "seeds of the falls; 1 to 8 by default");
    app.add_option("--settle", options.m_settle, "steps before those that are measured")
        ->check(CLI::Validator(wholeNumber(0, 1000000), ""));
    app.add_option("--steps", options.m_steps, "steps that are measured")
        ->check(CLI::Validator(wholeNumber(1, 1000000), ""));
    app.add_option("--damping", options.m_damping, "share of a velocity that is lost in a step (kDP), 0 to 1")
        ->check(CLI::Validator(numberUpTo(1, 0, true, "0 to 1"), ""));
    app.add_option("--threads", options.m_threads, "see cloth_drop")->check(CLI::Validator(wholeNumber(0, 64), ""));
    app.add_option("--most", options.m_most, "greatest speed_mm_s with which the program succeeds");
    int exitCode = kExitGood;
    const auto problem = [&] { return unknownName("--scene", options.m_scenes, kScenes); };
    if (!parseArguments(app, argc, argv, problem, exitCode)) return exitCode;
    return measureAll(options);
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("rest_speeds", [&] { return drape::bench::run(argc, argv); });
}
