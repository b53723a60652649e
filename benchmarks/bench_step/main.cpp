// bench_step: whole collision steps, host to host, of Drape and its peers over scenes of many sizes.
//
// Every scene is run by Drape's host back end first: the hash of its contacts is the reference of all other methods. A
// row whose hash differs is void, and the program ends with 3.
#include <algorithm>
#include <iostream>
#include <map>

#include <CLI/CLI.hpp>

#include "benchmarks/bench_step/measure_scene.h"
#include "benchmarks/bench_step/world_method.h"
#include "benchmarks/support/arguments.h"
#include "scenes/models.h"
#include "benchmarks/support/samples.h"

namespace drape::bench
{
namespace
{
struct Options : CommonOptions
{
    std::vector<std::string> m_scenes, m_methods;
    std::string m_set;
    std::string m_reference;
};

bool contains(const std::vector<std::string>& list, const std::string& text)
{
    return std::find(list.begin(), list.end(), text) != list.end();
}

const char* const kReference = "drape_host";

// The host comes first, since it is the reference.
std::vector<MethodEntry> allMethods(const Options& options)
{
    Settings host;
    host.m_backend = Backend::Host;
    const Settings device = options.settings();
    std::vector<MethodEntry> entries;
    const auto add = [&entries](const std::string& name, auto make) { entries.push_back({name, make}); };
    const auto drape = [](Settings settings) {
        return [settings](const StepScene& scene, std::string& error)
        { return makeDrapeMethod(scene, settings, error); };
    };
    const bool onHost = device.m_backend == Backend::Host;
    Settings profiled = device;
    profiled.m_profileKernels = true;  // apart, since it costs time of its own
    add(kReference, drape(host));
    if (!onHost) add("drape", drape(device));
    if (!onHost) add("drape_kernels", drape(profiled));
#ifdef DRAPE_BENCH_WORLDS
    const auto world = [](Settings settings) {
        return [settings](const StepScene& scene, std::string& error)
        { return makeWorldMethod(scene, settings, error); };
    };
    add("drape_world_host", world(host));
    if (!onHost) add("drape_world", world(device));
#endif
    for (const int threads : {2, 1})
    {
        const std::string suffix = "_" + std::to_string(threads);
        add("embree_contacts" + suffix, [threads](const StepScene& scene, std::string& error)
            { return makeEmbreeMethod(scene, threads, contactReach(scene), true, error); });
        add("embree_pairs" + suffix, [threads](const StepScene& scene, std::string& error)
            { return makeEmbreeMethod(scene, threads, scene.m_thickness, false, error); });
    }
    add("fcl_pairs", [](const StepScene& scene, std::string& error) { return makeFclMethod(scene, true, error); });
    add("fcl_collide", [](const StepScene& scene, std::string& error) { return makeFclMethod(scene, false, error); });
    return entries;
}

// Keeps the reference even where it was not asked for: without it nothing is checked but against --reference.
std::vector<MethodEntry> chosenMethods(const Options& options)
{
    std::vector<MethodEntry> entries = allMethods(options);
    if (options.m_methods.empty()) return entries;
    const auto isUnneeded = [&](const MethodEntry& entry)
    { return entry.m_name != kReference && !contains(options.m_methods, entry.m_name); };
    entries.erase(std::remove_if(entries.begin(), entries.end(), isUnneeded), entries.end());
    return entries;
}

// Returns the methods for a scene. If the reference's hash is known, the reference is left out unless it was asked for.
std::vector<MethodEntry> methodsFor(const SceneSpec& spec, std::vector<MethodEntry> methods, const Options& options,
                                    const MeasureSettings& settings)
{
    const auto isLeftOut = [&](const MethodEntry& entry)
    {
        // FCL has no collision of a model with itself, the plugin none of cloth with itself.
        if (spec.m_self && (entry.m_name.rfind("fcl", 0) == 0 || entry.m_name.rfind("drape_world", 0) == 0))
            return true;
        return !options.m_methods.empty() && !contains(options.m_methods, entry.m_name) && !settings.m_expected.empty();
    };
    methods.erase(std::remove_if(methods.begin(), methods.end(), isLeftOut), methods.end());
    return methods;
}

std::vector<SceneSpec> chosenScenes(const Options& options)
{
    std::vector<SceneSpec> chosen;
    for (const SceneSpec& spec : sceneSpecs())
    {
        const bool wanted = options.m_set == "sweep" ? !spec.m_sweep.empty()
                            : options.m_scenes.empty()
                                ? spec.m_quick == options.m_quick
                                : contains(options.m_scenes, spec.m_name) || contains(options.m_scenes, spec.m_sweep);
        if (wanted) chosen.push_back(spec);
    }
    return chosen;
}

// Hashes by scene.
using Hashes = std::map<std::string, std::string>;

// Reads the hashes of an earlier run; reads none for an empty path.
bool readReference(const std::string& path, Hashes& hashes, std::string& error)
{
    const auto take = [&hashes](const Row& row)
    {
        if (row.value("valid", "") == "yes") hashes[row.at("scene")] = row.at("hash");
    };
    return path.empty() || readRows(path, take, error);
}

std::string nameProblem(const Options& options)
{
    std::vector<std::string> scenes, sweeps, methods;
    for (const SceneSpec& spec : sceneSpecs())
    {
        scenes.push_back(spec.m_name);
        if (!spec.m_sweep.empty() && !contains(sweeps, spec.m_sweep)) sweeps.push_back(spec.m_sweep);
    }
    scenes.insert(scenes.end(), sweeps.begin(), sweeps.end());
    for (const MethodEntry& entry : allMethods(options))
        methods.push_back(entry.m_name);
    const std::string problem = unknownName("--scene", options.m_scenes, scenes);
    return problem.empty() ? unknownName("--method", options.m_methods, methods) : problem;
}

void list(const Options& options)
{
    for (const SceneSpec& spec : sceneSpecs())
        std::cout << "scene " << spec.m_name << (spec.m_sweep.empty() ? "" : ", sweep " + spec.m_sweep) << ": "
                  << spec.m_cloths << " cloth(s), " << spec.clothTriangles() << " triangles, on " << spec.m_model
                  << "\n";
    for (const MethodEntry& entry : allMethods(options))
        std::cout << "method " << entry.m_name << "\n";
}

int measure(const Options& options)
{
    const std::vector<SceneSpec> scenes = chosenScenes(options);
    Hashes reference;
    std::string problem;
    if (!readReference(options.m_reference, reference, problem)) return fail("bench_step", kExitBadInput, problem);
    const std::vector<MethodEntry> methods = chosenMethods(options);
    const std::vector<std::string> folders = modelFolders(options.m_models);
    const Clock::time_point begin = Clock::now();
    Table table;
    bool good = true;
    for (const SceneSpec& spec : scenes)
    {
        TriangleMesh obstacle;
        std::string error;
        if (millisecondsSince(begin) > 60000 * options.m_minutes) error = "left out: the time limit is reached";
        if (!error.empty() || !makeModel(spec.m_model, folders, obstacle, error))
        {
            std::cerr << "bench_step: " << spec.m_name << ": " << error << std::endl;
            continue;
        }
        std::cerr << "bench_step: " << spec.m_name << std::endl;
        const MeasureSettings settings = {options.m_repeats, options.m_seconds, reference[spec.m_name]};
        const std::vector<MethodEntry> chosen = methodsFor(spec, methods, options, settings);
        good = measureScene(makeStepScene(spec, obstacle), chosen, settings, table) && good;
    }
    const int exitCode = finishTable("bench_step", table, options);
    if (table.rows().empty()) return fail("bench_step", kExitFailed, "nothing was measured");
    return exitCode == kExitGood && !good ? kExitFailed : exitCode;
}

int run(int argc, char** argv)
{
    Options options;
    CLI::App app("Measures whole collision steps of Drape and its peers.", "bench_step");
    addCommonOptions(app, options);
    app.add_option("--scene", options.m_scenes, "measure only these scenes or sweeps");
    CLI::Option* set = app.add_option("--set", options.m_set,
                                      "sweep: the scenes of all sweeps, from 512 to 2 million cloth triangles");
    set->excludes("--scene");
    acceptOnly(set, {"sweep"});
    app.add_option("--method", options.m_methods, "measure only these methods and the reference");
    app.add_option("--reference", options.m_reference, "JSON of an earlier run whose hashes the contacts must have")
        ->type_name("FILE")
        ->check(CLI::ExistingFile);
    int exitCode = kExitGood;
    if (!parseArguments(
            app, argc, argv, [&options] { return nameProblem(options); }, exitCode))
        return exitCode;
    if (!options.m_list) return measure(options);
    list(options);
    return kExitGood;
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("bench_step", [&] { return drape::bench::run(argc, argv); });
}
