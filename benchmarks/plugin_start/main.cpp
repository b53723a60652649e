// plugin_start: measures the start of a plugin, and shows a world that moves to a device once that is ready.
//
// One start for each run of the program: a process loads its drivers once. A cloth falls on stairs meanwhile, and
// the hash of its nodes does not depend on the back end or on the step in which the world moves.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <thread>

#include <CLI/CLI.hpp>
#include <drape/drape.h>

#include "benchmarks/error_vs_time/error_scene.h"
#include "benchmarks/support/arguments.h"
#include "benchmarks/support/result_hash.h"
#include "scenes/models.h"
#include "tools/cloth_drop/drop_world.h"
#include "tools/cloth_drop/node_positions.h"
#include "tools/common/program.h"

namespace drape::bench
{
namespace
{
constexpr const char* kProgram = "plugin_start";

struct StartOptions : CommonOptions
{
    double m_crossover = -1;
    bool m_fresh = false;
    int m_steps = 120, m_mostSteps = 100000;
    double m_frameMs = 1000.0 / 60;
};

Backend backendOf(const std::string& name)
{
    return name == "host"     ? Backend::Host
           : name == "opencl" ? Backend::OpenCl
           : name == "cost"   ? Backend::ByCost
                              : Backend::Auto;
}

double residentMb()
{
    std::ifstream file("/proc/self/statm");
    double size = 0, pages = 0;
    file >> size >> pages;
    return pages * 4096e-6;
}

// Milliseconds and megabytes since the plugin's constructor began.
class StartMeter
{
public:
    double ms() const
    {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - m_begin).count();
    }
    double mb() const { return residentMb() - m_residentMb; }

private:
    std::chrono::steady_clock::time_point m_begin = std::chrono::steady_clock::now();
    double m_residentMb = residentMb();
};

Row measure(const StartOptions& options, const DropScene& scene)
{
    Settings settings;
    settings.m_backend = backendOf(options.m_backend);
    settings.m_device = options.m_device;
    settings.m_crossover = options.m_crossover;
    Row row;
    row["backend"] = options.m_backend;
    row["fresh"] = options.m_fresh;
    const StartMeter meter;
    Plugin plugin(settings);
    row["constructor_ms"] = meter.ms();
    row["constructor_mb"] = meter.mb();
    DropWorld world(std::make_unique<CollisionConfiguration>(plugin), std::make_unique<SoftBodySolver>(plugin));
    world.addMeshObstacle(scene);
    world.addCloth(scene, false);
    // Frames of an app, until the device is there.
    int steps = 0, onHost = 0;
    double longest = 0;
    for (; steps < options.m_steps || (plugin.device().m_isStarting && steps < options.m_mostSteps); ++steps)
    {
        const double stepMs = world.step(scene.m_dt);
        onHost += plugin.statistics().m_onHost || plugin.statistics().m_skipped;
        if (!plugin.device().m_isStarting) continue;
        longest = std::max(longest, stepMs);
        row["ready_ms"] = meter.ms();
        std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(options.m_frameMs - stepMs));
    }
    row["ready_mb"] = meter.mb();
    row["build_ms"] = plugin.device().m_buildMs;
    row["measure_ms"] = plugin.device().m_measureMs;
    row["steps"] = steps;
    row["steps_on_host"] = onHost;
    row["longest_step_ms"] = longest;
    row["device"] = plugin.device().m_device.m_name;
    row["reason"] = plugin.device().m_reason;
    std::vector<float> positions;
    copyPositions(world.cloth(), positions);
    row["hash"] = hashText(hashOf(positions, kEmptyHash));
    return row;
}

int run(int argc, char** argv)
{
    CLI::App app("Measures the start of a plugin, while a world steps.", kProgram);
    app.option_defaults()->always_capture_default();
    StartOptions options;
    acceptOnly(app.add_option("--backend", options.m_backend, "as Settings::m_backend; cost: ByCost"),
               {"auto", "opencl", "host", "cost"});
    app.add_option("--device", options.m_device, "part of an OpenCL device's or platform's name")->type_name("TEXT");
    app.add_option("--crossover", options.m_crossover,
                   "as Settings::m_crossover; 0: the device as soon as it is ready");
    app.add_flag("--fresh", options.m_fresh, "use empty caches, as the first start on a machine");
    app.add_option("--steps", options.m_steps, "least number of steps")
        ->check(CLI::Validator(wholeNumber(1, 1000000), ""));
    app.add_option("--csv", options.m_csv, "write the row as CSV; - is standard output")->type_name("FILE");
    app.add_option("--json", options.m_json, "write machine and row as JSON; - is standard output")->type_name("FILE");
    int exitCode = kExitGood;
    if (!parseArguments(
            app, argc, argv, [] { return std::string(); }, exitCode))
        return exitCode;
    ErrorScene scene;
    std::string error;
    if (!makeErrorScene("stairs", true, modelFolders(""), scene, error)) return fail(kProgram, kExitFailed, error);
    std::string folder = (std::filesystem::temp_directory_path() / "drape_start_XXXXXX").string();
    if (options.m_fresh)
    {
        if (!mkdtemp(folder.data())) return fail(kProgram, kExitFailed, "no folder " + folder);
        setenv("XDG_CACHE_HOME", folder.c_str(), 1);
        unsetenv("POCL_CACHE_DIR");
    }
    Table table;
    table.add(measure(options, scene.m_drop));
    if (options.m_fresh) std::filesystem::remove_all(folder);
    return finishTable(kProgram, table, options);
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("plugin_start", [&] { return drape::bench::run(argc, argv); });
}
