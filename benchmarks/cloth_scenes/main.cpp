// cloth_scenes: runs the scenes of cloth with itself, with other cloth and with moving obstacles
// (scenes/cloth_scene.h), measures whole steps of Bullet, and checks every step exactly for triangles that intersect.
#include <algorithm>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <drape/drape.h>

#include "benchmarks/support/arguments.h"
#include "benchmarks/support/result_hash.h"
#include "oracle/self_intersections.h"
#include "tools/common/program.h"
#include "tools/scene_world/scene_world.h"

namespace drape::bench
{
namespace
{
constexpr const char* kProgram = "cloth_scenes";
constexpr double kFrame = 1.0 / 60;  // s
constexpr const char *kDrape = "drape", *kVertexFace = "bullet_vf_ss", *kClusters = "bullet_clusters";

struct SceneOptions : CommonOptions
{
    std::vector<std::string> m_scenes;
    std::vector<int> m_seeds = {1};
    int m_checkEvery = 1;
    ClothSceneSize m_size = {3, 8};
    std::vector<std::string> m_methods = {kDrape};
    int m_stepsPerFrame = 4;
    double m_seconds = 0;         // run of each scene; 0: all
    double m_mostSeconds = 1e12;  // limit on the time of a run
    unsigned m_threads = 0;
    int m_iterations = ClothScene().m_iterations;
};

double percentile(std::vector<double> values, double share)
{
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, std::size_t(share * double(values.size())))];
}

// Counts the pairs of triangles that intersect, exactly: of cloth with cloth, and of cloth with obstacles.
class SceneCheck
{
public:
    SceneCheck(const SceneWorld& world, const ClothScene& scene)
        : m_mesh(joined(world.mesh(), scene)), m_clothTriangles(world.mesh().triangleCount()), m_intersections(m_mesh)
    {
    }

    struct Pairs
    {
        std::size_t m_cloth = 0, m_obstacle = 0;
    };
    Pairs count(SceneWorld& world)
    {
        std::vector<float> positions = world.positions();
        world.addObstaclePositions(positions);
        Pairs pairs;
        for (const auto& pair : m_intersections.find(positions))
        {
            if (std::size_t(pair.first) >= m_clothTriangles) continue;
            ++(std::size_t(pair.second) < m_clothTriangles ? pairs.m_cloth : pairs.m_obstacle);
        }
        return pairs;
    }

private:
    static TriangleMesh joined(TriangleMesh mesh, const ClothScene& scene)
    {
        for (const SceneObstacle& obstacle : scene.m_obstacles)
        {
            const auto first = std::int32_t(mesh.vertexCount());
            for (const std::int32_t vertex : obstacle.m_mesh.m_triangles)
                mesh.m_triangles.push_back(first + vertex);
            mesh.m_positions.insert(mesh.m_positions.end(), obstacle.m_mesh.m_positions.begin(),
                                    obstacle.m_mesh.m_positions.end());
        }
        return mesh;
    }

    TriangleMesh m_mesh;
    std::size_t m_clothTriangles;
    SelfIntersections m_intersections;
};

// Returns the world of a scene with the named method. plugin: set for Drape's.
std::unique_ptr<SceneWorld> makeWorld(const SceneOptions& options, const ClothScene& scene, const std::string& method,
                                      std::unique_ptr<Plugin>& plugin)
{
    if (method != kDrape)
        return std::make_unique<SceneWorld>(
            scene, method == kVertexFace ? BulletCollision::NodesAndFaces : BulletCollision::Clusters);
    Settings settings = options.settings();
    settings.m_threads = options.m_threads;
    plugin = std::make_unique<Plugin>(settings);
    return std::make_unique<SceneWorld>(scene, *plugin);
}

// Sums and maxima of what Drape reports about the steps of a run.
struct Reported
{
    std::size_t m_shortened = 0, m_meeting = 0, m_contacts = 0, m_skipped = 0;
    std::uint32_t m_status = 0;

    void add(const StepStatistics& step)
    {
        m_shortened += step.m_nodesShortened;
        m_meeting = std::max(m_meeting, step.m_clothPairsMeeting);
        m_contacts = std::max(m_contacts, step.m_selfContacts);
        m_skipped += step.m_clothPairsSkipped;
        m_status |= step.m_status;
    }

    void write(std::size_t steps, Row& row) const
    {
        row["self_contacts_max"] = m_contacts;
        row["nodes_shortened"] = double(m_shortened) / double(steps);
        row["patch_pairs_skipped"] = double(m_skipped) / double(steps);
        row["meeting_max"] = m_meeting;
        row["status"] = m_status;
    }
};

Row measure(const SceneOptions& options, const ClothScene& scene, int seed, const std::string& method)
{
    std::unique_ptr<Plugin> plugin;
    const std::unique_ptr<SceneWorld> world = makeWorld(options, scene, method, plugin);
    SceneCheck check(*world, scene);
    const std::size_t most = std::size_t((options.m_seconds > 0 ? options.m_seconds : scene.m_seconds) / kFrame);
    std::vector<double> stepMs;
    SceneCheck::Pairs worst, last = check.count(*world);
    const SceneCheck::Pairs start = last;
    Reported reported;
    std::size_t bad = 0;
    double stretched = 0, allMs = 0;
    std::uint64_t hash = kEmptyHash;
    for (std::size_t step = 0; step < most && allMs < 1000 * options.m_mostSeconds; ++step)
    {
        stepMs.push_back(0);
        for (int part = 0; part < options.m_stepsPerFrame; ++part)
        {
            stepMs.back() += world->step(kFrame / options.m_stepsPerFrame);
            if (plugin) reported.add(plugin->statistics());
        }
        allMs += stepMs.back();
        stretched = std::max(stretched, world->stretch().m_most);
        const std::vector<float>& positions = world->positions();
        hash = hashBytes(hash, positions.data(), positions.size() * sizeof(float));
        if (step % std::size_t(options.m_checkEvery) != 0 && step + 1 < most) continue;
        last = check.count(*world);
        bad += last.m_cloth + last.m_obstacle > 0;
        worst.m_cloth = std::max(worst.m_cloth, last.m_cloth);
        worst.m_obstacle = std::max(worst.m_obstacle, last.m_obstacle);
    }
    Row row;
    row["scene"] = scene.m_name;
    row["method"] = method;
    row["seed"] = seed;
    row["cloths"] = scene.m_cloths.size();
    row["triangles"] = world->mesh().triangleCount();
    row["device"] = plugin ? plugin->device().m_device.m_name : "";
    row["steps"] = stepMs.size();
    row["median_ms"] = percentile(stepMs, 0.5);
    row["p95_ms"] = percentile(stepMs, 0.95);
    row["pairs_start"] = start.m_cloth + start.m_obstacle;
    row["self_pairs_max"] = worst.m_cloth;
    row["self_pairs_end"] = last.m_cloth;
    row["obstacle_pairs_max"] = worst.m_obstacle;
    row["obstacle_pairs_end"] = last.m_obstacle;
    row["bad_steps"] = bad;
    reported.write(stepMs.size() * std::size_t(options.m_stepsPerFrame), row);
    row["stretch_mean_end"] = world->stretch().m_mean;
    row["stretch_max"] = stretched;
    row["hash"] = hashText(hash);
    return row;
}

int measureAll(const SceneOptions& options)
{
    Table table;
    for (const std::string& name : options.m_scenes.empty() ? clothSceneNames() : options.m_scenes)
        for (const int seed : options.m_seeds)
            for (const std::string& method : options.m_methods)
            {
                ClothScene scene;
                makeClothScene(name, options.m_size, std::uint32_t(seed), scene);
                scene.m_iterations = options.m_iterations;
                table.add(measure(options, scene, seed, method));
                std::cerr << kProgram << ": " << name << ", seed " << seed << ", " << method << std::endl;
            }
    return finishTable(kProgram, table, options);
}

int run(int argc, char** argv)
{
    CLI::App app("Measures scenes of cloth with itself, with other cloth and with moving obstacles.", kProgram);
    SceneOptions options;
    options.m_backend = "host";
    addCommonOptions(app, options);
    app.add_option("--scene", options.m_scenes, "names of scenes; all by default");
    app.add_option("--seed", options.m_seeds, "seeds of the starts");
    app.add_option("--detail", options.m_size.m_detail, "1: small; twice as much has four times as many triangles")
        ->check(CLI::Validator(wholeNumber(1, 50), ""));
    app.add_option("--sheets", options.m_size.m_sheets, "number of sheets where sheets fall")
        ->check(CLI::Validator(wholeNumber(1, 100), ""));
    app.add_option("--length", options.m_seconds, "seconds of each scene that are run; 0: all");
    app.add_option("--method", options.m_methods, "Drape, or Bullet's own collision of cloth with cloth")
        ->check(CLI::IsMember({kDrape, kVertexFace, kClusters}));
    app.add_option("--most-seconds", options.m_mostSeconds, "time of a run's steps after which it ends");
    app.add_option("--check-every", options.m_checkEvery, "steps from one exact check to the next")
        ->check(CLI::Validator(wholeNumber(1, 1000000), ""));
    app.add_option("--steps-per-frame", options.m_stepsPerFrame, "steps of 1/60 s of the scene's time")
        ->check(CLI::Validator(wholeNumber(1, 100), ""));
    app.add_option("--iterations", options.m_iterations, "piterations of the cloth")
        ->check(CLI::Validator(wholeNumber(1, 1000), ""));
    app.add_option("--threads", options.m_threads, "see cloth_drop")->check(CLI::Validator(wholeNumber(0, 64), ""));
    int exitCode = kExitGood;
    const auto problem = [&] { return unknownName("--scene", options.m_scenes, clothSceneNames()); };
    if (!parseArguments(app, argc, argv, problem, exitCode)) return exitCode;
    if (options.m_quick) options.m_size.m_detail = 1;
    return measureAll(options);
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("cloth_scenes", [&] { return drape::bench::run(argc, argv); });
}
