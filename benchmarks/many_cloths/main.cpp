// many_cloths: drops cloths on one obstacle and measures whole steps of Bullet, with Drape's solver on the host and on
// a device, with nodes that stay on the device, or with Bullet's links.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>
#include <numeric>

#include <CLI/CLI.hpp>
#include <drape/drape.h>

#include "benchmarks/support/arguments.h"
#include "benchmarks/support/result_hash.h"
#include "tools/cloth_drop/drop_world.h"
#include "tools/cloth_drop/step_parts.h"
#include "tools/common/program.h"

namespace drape::bench
{
namespace
{
constexpr const char* kProgram = "many_cloths";
constexpr double kTurn = 2.399963;  // rad, between the places of two cloths: the golden angle

struct ManyOptions : CommonOptions
{
    std::string m_obstacle = "sphere";
    std::vector<std::string> m_methods;
    int m_cloths = 200, m_nodes = 17, m_steps = 120, m_fetchEvery = 10;
    double m_clothSize = 0.6;
    unsigned m_threads = 0;
};

// Settings of a run.
struct Method
{
    const char* m_name;
    Solver m_solver;
    SolverPlace m_place;
    bool m_keeps;  // nodes on the device
};

constexpr Method kMethods[] = {{"host", Solver::Drape, SolverPlace::Host, false},
                               {"device", Solver::Drape, SolverPlace::Device, false},
                               {"kept", Solver::Drape, SolverPlace::Device, true},
                               {"auto", Solver::Auto, SolverPlace::Auto, false},
                               {"bullet_links", Solver::Bullet, SolverPlace::Host, false}};

// Returns the median of the second half of the run, in which most cloths are in contact.
double median(const std::vector<double>& all)
{
    std::vector<double> values(all.begin() + std::ptrdiff_t(all.size() / 2), all.end());
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

// Returns the mean of the same part of the run.
double mean(const std::vector<double>& all)
{
    const std::size_t first = all.size() / 2;
    return std::accumulate(all.begin() + std::ptrdiff_t(first), all.end(), 0.0) / double(all.size() - first);
}

// Brings the nodes of all cloths to Bullet. Returns the time, ms.
double fetchAll(Plugin& plugin, DropWorld& world, int cloths)
{
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < cloths; ++i)
        plugin.beginFetch(world.cloth(std::size_t(i)));
    for (int i = 0; i < cloths; ++i)
        plugin.fetch(world.cloth(std::size_t(i)));
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// Adds the medians of the step's parts to the row.
void addParts(const std::vector<WholeStepParts>& steps, Row& row)
{
    for (const NamedPart& part : stepParts())
    {
        std::vector<double> ms;
        for (const WholeStepParts& step : steps)
            ms.push_back(step.*part.m_ms);
        row[std::string(part.m_name) + "_ms"] = median(ms);
    }
}

// Moves the cloth to its place on a spiral, some millimetres above the one before.
void placeCloth(const TriangleMesh& flat, int index, int count, TriangleMesh& cloth)
{
    const double radius = 0.8 * std::sqrt((index + 0.5) / count), angle = kTurn * index;
    const float shift[3] = {float(radius * std::cos(angle)), 0.005f * float(index), float(radius * std::sin(angle))};
    for (std::size_t i = 0; i < flat.m_positions.size(); ++i)
        cloth.m_positions[i] = flat.m_positions[i] + shift[i % 3];
}

Row measure(const ManyOptions& options, const DropScene& scene, const Method& method)
{
    Settings settings = options.settings();
    settings.m_threads = options.m_threads;
    settings.m_solver = method.m_solver;
    settings.m_solverPlace = method.m_place;
    Plugin plugin(settings);
    DropWorld world(std::make_unique<CollisionConfiguration>(plugin), std::make_unique<SoftBodySolver>(plugin));
    world.addMeshObstacle(scene);
    DropScene moved = scene;
    for (int i = 0; i < options.m_cloths; ++i)
    {
        placeCloth(scene.m_cloth.m_mesh, i, options.m_cloths, moved.m_cloth.m_mesh);
        world.addCloth(moved, false);
        if (method.m_keeps) plugin.keepOnDevice(world.cloth(std::size_t(i)), true);
    }
    std::vector<double> stepMs;
    std::vector<WholeStepParts> parts;
    std::size_t onDevice = 0, kept = 0;
    std::uint64_t hash = kEmptyHash;
    const std::clock_t cpu = std::clock();
    for (int step = 0; step < options.m_steps; ++step)
    {
        stepMs.push_back(world.step(scene.m_dt));
        const StepStatistics statistics = plugin.statistics();
        parts.push_back(partsOf(statistics, stepMs.back(), world.world().collisionMs(), statistics.callsMs()));
        onDevice = std::max(onDevice, statistics.m_clothsSolvedOnDevice);
        kept += statistics.m_clothsKept;
        if (method.m_keeps && (step + 1) % options.m_fetchEvery == 0)
            stepMs.back() += fetchAll(plugin, world, options.m_cloths);
    }
    const double cpuMs = 1e3 * double(std::clock() - cpu) / CLOCKS_PER_SEC / options.m_steps;
    fetchAll(plugin, world, options.m_cloths);
    for (int i = 0; i < options.m_cloths; ++i)
        for (int k = 0; k < world.cloth(std::size_t(i)).m_nodes.size(); ++k)
            hash = hashBytes(hash, &world.cloth(std::size_t(i)).m_nodes[k].m_x, 3 * sizeof(btScalar));
    Row row;
    row["scene"] = options.m_obstacle;
    row["method"] = method.m_name;
    row["cloths"] = options.m_cloths;
    row["nodes"] = options.m_nodes * options.m_nodes;
    row["device"] = plugin.device().m_device.m_name;
    row["cloths_on_device"] = onDevice;
    row["kept_share"] = double(kept) / options.m_cloths / options.m_steps;
    row["median_ms"] = median(stepMs);
    row["mean_ms"] = mean(stepMs);
    row["cpu_ms"] = cpuMs;
    addParts(parts, row);
    row["hash"] = hashText(hash);
    return row;
}

int run(int argc, char** argv)
{
    CLI::App app("Measures steps of cloths that drop on one obstacle.", kProgram);
    ManyOptions options;
    addCommonOptions(app, options);
    app.add_option("--obstacle", options.m_obstacle, "mesh file or shape, as cloth_drop takes it");
    app.add_option("--method", options.m_methods, "host, device, kept, auto or bullet_links; all by default");
    app.add_option("--cloths", options.m_cloths, "number of cloths")->check(CLI::Validator(wholeNumber(1, 10000), ""));
    app.add_option("--nodes", options.m_nodes, "nodes along a cloth's side")
        ->check(CLI::Validator(wholeNumber(2, 1000), ""));
    app.add_option("--cloth-size", options.m_clothSize, "side of a cloth, m");
    app.add_option("--fetch-every", options.m_fetchEvery, "steps after which the nodes of kept cloths are fetched")
        ->check(CLI::Validator(wholeNumber(1, 1000000), ""));
    app.add_option("--steps", options.m_steps, "steps of 1/60 s")->check(CLI::Validator(wholeNumber(2, 1000000), ""));
    app.add_option("--threads", options.m_threads, "see cloth_drop")->check(CLI::Validator(wholeNumber(0, 64), ""));
    std::vector<std::string> names;
    for (const Method& method : kMethods)
        names.push_back(method.m_name);
    int exitCode = kExitGood;
    const auto problem = [&] { return unknownName("--method", options.m_methods, names); };
    if (!parseArguments(app, argc, argv, problem, exitCode)) return exitCode;
    if (options.m_quick) options.m_cloths = std::min(options.m_cloths, 10);
    Options drop;
    drop.m_obstacle = options.m_obstacle;
    drop.m_clothColumns = drop.m_clothRows = options.m_nodes;
    drop.m_clothSize = options.m_clothSize;
    DropScene scene;
    std::string error;
    if (!makeDropScene(drop, scene, error))
    {
        std::cerr << kProgram << ": " << error << std::endl;
        return kExitBadInput;
    }
    Table table;
    for (const Method& method : kMethods)
    {
        const std::vector<std::string>& wanted = options.m_methods;
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), method.m_name) == wanted.end()) continue;
        table.add(measure(options, scene, method));
    }
    return finishTable(kProgram, table, options);
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("many_cloths", [&] { return drape::bench::run(argc, argv); });
}
