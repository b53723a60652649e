// compare_solvers: runs cloth and ropes without contact with Drape's substeps and with Bullet's iterations, and reports
// how their shapes, stretch and energy differ at equal settings.
//
// Bullet's run is the reference of the distances. Two variants of it show the effects of the order of links and of
// substeps alone. order_distance compares Drape's run with Bullet's links in the same substeps.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>

#include "benchmarks/compare_solvers/link_trial.h"
#include "benchmarks/support/arguments.h"
#include "benchmarks/support/result_hash.h"
#include "tools/common/program.h"

namespace drape::bench
{
namespace
{
constexpr const char* kProgram = "compare_solvers";

struct Options : CommonOptions
{
    std::vector<std::string> m_scenes;
    std::vector<double> m_stiffness = {1, 0.3};
    int m_iterations = 10;
    double m_damping = 0.01;
    int m_nodes = 0;
    int m_steps = 300;
};

// Distances between corresponding nodes, m.
struct Distances
{
    double m_mean = 0, m_max = 0;  // over nodes and steps
    double m_end = 0;              // mean after the last step
};

Distances distancesOf(const LinkRun& run, const LinkRun& reference)
{
    Distances distances;
    for (std::size_t step = 0; step < run.m_steps.size(); ++step)
    {
        const std::vector<float>&a = run.m_steps[step].m_positions, &b = reference.m_steps[step].m_positions;
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); i += 3)
        {
            const double distance = std::hypot(double(a[i]) - double(b[i]), double(a[i + 1]) - double(b[i + 1]),
                                               double(a[i + 2]) - double(b[i + 2]));
            distances.m_max = std::max(distances.m_max, distance);
            sum += distance;
        }
        distances.m_end = 3 * sum / double(a.size());
        distances.m_mean += distances.m_end / double(run.m_steps.size());
    }
    return distances;
}

void fillDistances(Row& row, const std::string& prefix, const Distances& distances)
{
    row[prefix + "_mean_m"] = distances.m_mean;
    row[prefix + "_max_m"] = distances.m_max;
    row[prefix + "_end_m"] = distances.m_end;
}

void fillFigures(Row& row, const LinkRun& run)
{
    double stretch = 0, most = 0, speed2 = 0, gain = 0;
    std::uint64_t hash = kEmptyHash;
    const std::size_t resting = run.m_steps.size() - run.m_steps.size() / 4;
    for (std::size_t i = 0; i < run.m_steps.size(); ++i)
    {
        const LinkStep& step = run.m_steps[i];
        stretch += step.m_stretchMean / double(run.m_steps.size());
        most = std::max(most, step.m_stretchMax);
        gain = std::max(gain, step.m_kinetic + step.m_potential - run.m_start.m_kinetic - run.m_start.m_potential);
        if (i >= resting) speed2 += step.m_speed * step.m_speed / double(run.m_steps.size() - resting);
        hash = hashOf(step.m_positions, hash);
    }
    const LinkStep& end = run.m_steps.back();
    row["stretch_mean"] = stretch;
    row["stretch_max"] = most;
    row["stretch_mean_end"] = end.m_stretchMean;
    row["stretch_max_end"] = end.m_stretchMax;
    row["kinetic_end_j"] = end.m_kinetic;
    row["potential_end_j"] = end.m_potential;
    row["energy_gain_j"] = gain;
    row["rest_speed_mm_s"] = 1000 * std::sqrt(speed2);
    row["hash"] = hashText(hash);
    run.m_stepMs.fill(row);
}

void measureScene(const LinkScene& scene, const Options& options, Table& table)
{
    Settings settings = options.settings();
    settings.m_threads = 1;
    const int nodes = options.m_nodes > 0 ? options.m_nodes : options.m_quick ? scene.m_quickNodes : scene.m_nodes;
    for (const double stiffness : options.m_stiffness)
    {
        const LinkSetting setting = {stiffness, options.m_iterations, options.m_damping};
        LinkRun reference, substeps;
        for (const LinkSolver solver :
             {LinkSolver::Bullet, LinkSolver::BulletShuffled, LinkSolver::BulletInSubsteps, LinkSolver::Drape})
        {
            const LinkRun run = runLinks(scene, nodes, setting, solver, options.m_steps, settings);
            if (solver == LinkSolver::Bullet) reference = run;
            if (solver == LinkSolver::BulletInSubsteps) substeps = run;
            Row row;
            row["scene"] = scene.m_name;
            row["nodes"] = run.m_start.m_positions.size() / 3;
            row["stiffness"] = stiffness;
            row["iterations"] = setting.m_iterations;
            row["damping"] = setting.m_damping;
            row["closed"] = scene.m_isClosed ? "yes" : "no";
            row["method"] = nameOf(solver);
            row["threads"] = 1;
            fillDistances(row, "distance", distancesOf(run, reference));
            if (solver == LinkSolver::Drape) fillDistances(row, "order_distance", distancesOf(run, substeps));
            fillFigures(row, run);
            table.add(row);
        }
    }
}

std::vector<std::string> sceneNames()
{
    std::vector<std::string> names;
    for (const LinkScene& scene : linkScenes())
        names.push_back(scene.m_name);
    return names;
}

int measure(const Options& options)
{
    Table table;
    for (const LinkScene& scene : linkScenes())
    {
        const std::vector<std::string>& wanted = options.m_scenes;
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), scene.m_name) == wanted.end()) continue;
        std::cerr << kProgram << ": " << scene.m_name << std::endl;
        measureScene(scene, options, table);
    }
    return finishTable(kProgram, table, options);
}

int run(int argc, char** argv)
{
    CLI::App app("Compares Drape's solver of links with Bullet's on scenes without contact.", kProgram);
    Options options;
    options.m_backend = "host";
    addCommonOptions(app, options);
    app.add_option("--scene", options.m_scenes, "measure only these scenes; --list names them");
    const auto share = CLI::Validator(numberUpTo(1, 0, true, "0 to 1"), "");
    app.add_option("--stiffness", options.m_stiffness, "stiffness of the links (kLST), 0 to 1")->check(share);
    app.add_option("--damping", options.m_damping, "share of a velocity that is lost in a step (kDP), 0 to 1")
        ->check(share);
    app.add_option("--iterations", options.m_iterations, "Bullet's iterations (piterations), 1 to 1000")
        ->check(CLI::Validator(wholeNumber(1, 1000), ""));
    app.add_option("--nodes", options.m_nodes, "nodes a side; 0: 33, or 41 along the rope; 13 with --quick")
        ->check(CLI::Validator(wholeNumber(0, 1000), ""));
    app.add_option("--steps", options.m_steps, "steps of 1/60 s")->check(CLI::Validator(wholeNumber(1, 1000000), ""));
    int exitCode = kExitGood;
    const auto problem = [&] { return unknownName("--scene", options.m_scenes, sceneNames()); };
    if (!parseArguments(app, argc, argv, problem, exitCode)) return exitCode;
    if (!options.m_list) return measure(options);
    for (const std::string& name : sceneNames())
        std::cout << "scene " << name << "\n";
    return kExitGood;
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("compare_solvers", [&] { return drape::bench::run(argc, argv); });
}
