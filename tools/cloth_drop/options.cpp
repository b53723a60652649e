#include "tools/cloth_drop/options.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>

#include "tools/cloth_drop/drop_scene.h"
#include "scenes/cloth_scene.h"
#include "scenes/shapes.h"
#include "tools/common/arguments.h"
#include "tools/common/program.h"
#include "tools/common/suggestion.h"
#include "tools/scene_file/built_in_scene.h"

namespace drape
{
namespace
{
// The part of --help that explains --json and the exit codes.
constexpr const char* kResultsText =
    "JSON keys end in their units. step_ms, step_parts_ms (medians), collision_ms and penetration_p99_m cover the\n"
    "steps in contact; they are null if there were none. step_ms is the whole stepSimulation. Its parts with Drape:\n"
    "  rigid         Bullet's step outside of the solver's calls and of dispatch\n"
    "  dispatch      Bullet's collision detection, where Drape notes its pairs\n"
    "  mirror        pairs, mirrors of bodies and meshes, motions of obstacles, bounds beside moving obstacles\n"
    "  predict       forces, predicted positions, bounds, and velocities before them\n"
    "  read          links and nodes of bodies whose links Drape solves\n"
    "  upload        copying nodes for the detection, enqueueing\n"
    "  wait          detection and download of its contacts\n"
    "  sort          contacts by body, and ends of paths at the first impact\n"
    "  solve         links in substeps, contact sweeps, motion limits\n"
    "  bullet_links  Bullet's link solver\n"
    "  write_back    positions and velocities to Bullet's nodes\n"
    "  check         checking displaced nodes\n"
    "  normals       Bullet's normals of faces and nodes\n"
    "--csv has the parts of every step. collision_ms is the sum of dispatch, mirror, read, upload, wait, sort, solve,\n"
    "write_back and check. finding_ms leaves out read, solve, write_back and check.\n"
    "Bullet's own collision_ms contains no solving, either. Penetration is the depth of a node below the surface, or\n"
    "of a vertex of the obstacle above a face. intersecting_pairs_max is the largest number of intersecting pairs of\n"
    "triangles after any step. intersecting_pairs_max_step is the first step with that number (0: there was no pair).\n"
    "An exact check runs after each step, outside of the measured times; --csv lists its results for every step.\n"
    "self_intersecting_pairs_max and _end count pairs of cloth triangles; only with --self or several --layers. With\n"
    "--compare there is one object for each run: drape, bullet_stock, bullet_tuned and, with --compare-vfss,\n"
    "bullet_vfss. capped_at_step is the last complete step before a time limit, --compare-cap, a signal or a failure\n"
    "ended the run. The first SIGINT, SIGTERM or SIGHUP ends the run like --time-limit, but with exit code 1 and\n"
    "without a picture. A second signal ends the program at once.";

constexpr double kLeastThickness = 1e-4;  // m, of Drape

// Bullet leaves out of all collision what is 10^6 m across, corner to corner (btCollisionWorld::updateSingleAabb), and
// cloth's bounds have its way of three steps in them (btSoftBody::predictMotion). So far out a float is no finer than
// 62 mm, either: at the length it is 1 mm, less than cloth falls in its first step.
constexpr double kLongest = 1e4;   // m
constexpr double kFarthest = 1e5;  // m, in a step

constexpr int kMostNodesASide = 4096;  // 16.8 million nodes: beyond what a step can hold, below any overflow

std::string grid(std::string& text)
{
    const std::size_t split = text.find_first_of("xX");
    const bool digits = split != std::string::npos && split > 0 && split + 1 < text.size() && text.size() <= 11 &&
                        std::count_if(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; }) ==
                            static_cast<std::ptrdiff_t>(text.size()) - 1;
    if (!digits) return "'" + text + "' is not of the form NxM, such as 33x33";
    const int columns = std::stoi(text.substr(0, split)), rows = std::stoi(text.substr(split + 1));
    if (std::min(columns, rows) < 2 || std::max(columns, rows) > kMostNodesASide)
        return "'" + text + "' needs 2 to " + std::to_string(kMostNodesASide) + " nodes a side";
    return "";
}

std::string hash(std::string& text)
{
    if (text.size() != 16 || text.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        return "'" + text + "' is not a hash of 16 hex digits";
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return "";
}

const std::map<std::string, BulletMode>& bulletModes()
{
    static const std::map<std::string, BulletMode> modes = {
        {"stock", BulletMode::Stock}, {"tuned", BulletMode::Tuned}, {"vfss", BulletMode::SoftPair}};
    return modes;
}

void addSceneOptions(CLI::App& app, Options& options, std::string& cloth)
{
    const auto positive = CLI::Validator(numberAbove(0, false, "more than 0"), "");
    const auto length = CLI::Validator(numberUpTo(kLongest, 0, false, "more than 0, 10000 at most"), "");
    app.add_option("--obstacle", options.m_obstacle,
                   "mesh file (OBJ, PLY, STL, glTF) or one of: " + joinedWords(shapeNames()))
        ->type_name("FILE|SHAPE");
    app.add_option("--obstacle-size", options.m_obstacleSize, "largest extent of the obstacle, m, 10000 at most")
        ->check(length);
    app.add_option("--cloth", cloth, "cloth nodes along x and z")->type_name("NxM")->check(CLI::Validator(grid, ""));
    app.add_option("--cloth-size", options.m_clothSize, "longer side of the cloth, m, 10000 at most")->check(length);
    app.add_option("--layers", options.m_layers, "sheets of cloth above one another, 1 to 100")
        ->check(CLI::Validator(wholeNumber(1, 100), ""));
    app.add_flag("--self", options.m_self, "let sheets collide with themselves and with each other");
    app.add_option("--drop-height", options.m_dropHeight, "free fall before the thickness is reached, m, 10000 at most")
        ->check(CLI::Validator(numberUpTo(kLongest, 0, true, "0 or more, 10000 at most"), ""));
    app.add_option("--drop-speed", options.m_dropSpeed,
                   "speed of the cloth downwards at the start, m/s; 100000 m a step at most")
        ->check(CLI::Validator(numberAbove(0, true, "0 or more"), ""));
    app.add_option("--steps", options.m_steps, "simulation steps")->check(positive);
    app.add_option("--time-limit", options.m_timeLimit,
                   "seconds, including the check, after which the run ends and reports its steps; with --compare it "
                   "limits Drape's run only")
        ->check(positive)
        ->default_str("none");
    app.add_option("--dt", options.m_dt, "time step, s")->check(positive);
    app.add_option("--thickness", options.m_thickness,
                   "gap at rest, the sum of the cloth's and the obstacle's equal margins, m, 0.0001 to 10000")
        ->check(CLI::Validator(numberUpTo(kLongest, kLeastThickness, true, "0.0001 or more, 10000 at most"), ""));
}

void addSceneFileOptions(CLI::App& app, Options& options)
{
    offerWords(app.add_option("--scene", options.m_scene,
                              "run a scene file (JSON) or a built-in scene instead of the drop on an obstacle")
                   ->type_name("FILE|NAME"),
               clothSceneNames());
    app.add_flag("--list-scenes", options.m_listScenes, "list the built-in scenes and exit");
    app.add_option("--seed", options.m_seed, "seed of a built-in scene, 0 to 2147483647")
        ->check(CLI::Validator(wholeNumber(0, 2147483647), ""));
    app.add_option("--detail", options.m_detail,
                   "detail of a built-in scene, 1 to 50; twice as much has four times as many triangles")
        ->check(CLI::Validator(wholeNumber(1, 50), ""));
    app.add_option("--sheets", options.m_sheets, "sheets of a built-in scene that drops sheets, 1 to 100")
        ->check(CLI::Validator(wholeNumber(1, 100), ""));
    app.add_option("--write-scene", options.m_writeScene,
                   "write the scene as a file, which gives the same positions, and exit")
        ->type_name("FILE.json")
        ->transform(CLI::Validator(outputFile, ""));
    app.add_flag("--list-materials", options.m_listMaterials, "list the materials of scene files and exit");
}

void addBackendOptions(CLI::App& app, Options& options, std::string& mode)
{
    acceptOnly(app.add_option(
                   "--backend", options.m_backend,
                   "auto: a GPU, but the host if it is faster; cost: the same with any OpenCL device; bullet: Bullet's "
                   "own collision"),
               {"auto", "opencl", "host", "cost", "bullet"});
    acceptOnly(app.add_option("--mode", options.m_contactMode, "how Drape treats motion within a step"),
               {"discrete", "continuous", "automatic"});
    acceptOnly(app.add_option("--solver", options.m_solver,
                              "who solves the cloth's links; drape: in substeps, with less stretch; auto: drape"),
               {"auto", "drape", "bullet"});
    acceptOnly(app.add_option("--solver-place", options.m_solverPlace,
                              "where Drape's solver computes; auto: a GPU for large cloth, else the host"),
               {"auto", "host", "device"});
    app.add_option("--threads", options.m_threads,
                   "number of threads of the solver and of the host back end, 0 to 64; 0: one per core, 8 at most")
        ->check(CLI::Validator(wholeNumber(0, 64), ""));
    acceptOnly(
        app.add_option(
            "--bullet-mode", mode,
            "with --backend bullet: distance field with default (stock) or tuned settings, or two soft bodies (VF_SS)"),
        {"stock", "tuned", "vfss"});
    app.add_option("--device", options.m_device, "part of an OpenCL device's or platform's name")->type_name("TEXT");
    app.add_flag("--list-devices", options.m_listDevices, "list the OpenCL devices and exit");
    app.add_flag(
        "--compare", options.m_compare,
        "afterwards run the same scene with Bullet's own collision, with default settings (stock) and tuned ones");
    app.add_flag("--compare-vfss", options.m_compareSoftPair,
                 "with --compare: also run Bullet with two soft bodies (VF_SS)");
    app.add_option("--compare-cap", options.m_compareCap,
                   "seconds of stepping after which each run of Bullet's own collision in --compare ends")
        ->check(CLI::Validator(numberAbove(0, false, "more than 0"), ""));
}

void addOutputOptions(CLI::App& app, Options& options)
{
    const auto add = [&app](const char* name, std::string& path, const char* type, const char* text)
    { app.add_option(name, path, text)->type_name(type)->transform(CLI::Validator(outputFile, "")); };
    add("--csv", options.m_csv, "FILE", "write a row for each step; - is standard output");
    add("--json", options.m_json, "FILE", "write the summary; - is standard output");
    add("--frames", options.m_frames, "DIR", "write obstacle.ply, and cloth_NNNN.ply for each step");
    add("--picture", options.m_picture, "FILE.png",
        "write a shaded picture (PNG) of the last frame; with --compare it shows all runs side by side");
    add("--replay", options.m_replay, "FILE.html",
        "write a page that plays the run in a browser; with --compare it shows all runs side by side");
    add("--animation", options.m_animation, "FILE.webp",
        "write a shaded animation (WebP); with --compare it shows all runs side by side");
    add("--point-cache", options.m_pointCache, "DIR",
        "write OBJ, PC2 and MDD files of the run, for Blender and Houdini");
    add("--gltf", options.m_gltf, "FILE.glb", "write the run as glTF (.glb) with 60 morph targets at most");
    app.add_option("--validate-hash", options.m_validateHash, "exit with 3 if the run's hash differs from H")
        ->type_name("H")
        ->transform(CLI::Validator(hash, ""));
    app.add_flag("--quiet", options.m_quiet, "print neither progress nor summary");
    app.add_flag("--stream-steps", options.m_streamSteps, "")->group("");
    app.add_flag("--stream-positions", options.m_streamPositions, "")->group("");
    app.add_flag("--stream-frames", options.m_streamFrames, "")->group("");
}

// Returns the reason why options of the drop and of scenes contradict each other, or "".
std::string sceneConflict(const CLI::App& app, const Options& options)
{
    const auto given = [&app](const char* name) { return app.count(name) > 0; };
    if (!options.m_scene.empty())
        for (const char* name : {"--obstacle", "--obstacle-size", "--cloth", "--cloth-size", "--layers", "--self",
                                 "--drop-height", "--drop-speed", "--thickness", "--compare-vfss"})
            if (given(name)) return std::string(name) + " has no effect with --scene";
    if (given("--scene") && options.m_scene.empty()) return "--scene is empty";
    const bool builtIn = !options.m_scene.empty() && !isSceneFile(options.m_scene);
    for (const char* name : {"--seed", "--detail", "--sheets"})
        if (given(name) && !builtIn && !options.m_streamSteps)
            return std::string(name) + " needs a built-in scene; see --list-scenes";
    if (!options.m_scene.empty() && options.m_bulletMode == BulletMode::SoftPair)
        return "--bullet-mode vfss runs the drop on an obstacle alone";
    if (options.m_writeScene == "-") return "--write-scene needs a file, not -";
    return "";
}

std::string conflict(const Options& options)
{
    if (!((options.m_dropSpeed + kGravity * options.m_dt) * options.m_dt <= kFarthest))
        return "--drop-speed and --dt let the cloth move more than 100000 m in a step";
    if (!options.usesDrape() && options.m_compare) return "--compare needs a back end of Drape, not --backend bullet";
    if (!options.usesDrape() && !options.m_device.empty()) return "--device has no effect with --backend bullet";
    if (options.m_compareSoftPair && !options.m_compare) return "--compare-vfss needs --compare";
    if (!options.usesDrape() && options.m_timeLimit > 0 && !options.m_frames.empty())
        return "--time-limit with --backend bullet leaves no cloth for --frames";
    if (options.m_obstacle.empty()) return "--obstacle is empty";
    if (options.m_picture == "-") return "--picture needs a file, not -";
    if (options.m_animation == "-") return "--animation needs a file, not -";
    if (options.m_replay == "-") return "--replay needs a file, not -";
    if (options.m_gltf == "-") return "--gltf needs a file, not -";
    return "";
}
}  // namespace

bool parseOptions(int argc, const char* const* argv, Options& options, int& exitCode)
{
    CLI::App app("Drops a cloth on an obstacle in Bullet and reports what happened.", "cloth_drop");
    app.footer(std::string(kResultsText) + "\n" + kExitCodesText);
    std::string cloth = "33x33", mode = "stock";
    app.option_defaults()->always_capture_default();
    addSceneOptions(app, options, cloth);
    addSceneFileOptions(app, options);
    addBackendOptions(app, options, mode);
    addOutputOptions(app, options);
    const auto problem = [&]() -> std::string
    {
        if (options.usesDrape() && app.count("--bullet-mode") > 0)
            return "--bullet-mode needs --backend bullet; --compare runs stock and tuned, --compare-vfss also vfss";
        options.m_bulletMode = bulletModes().at(mode);
        const std::string reason = sceneConflict(app, options);
        return reason.empty() ? conflict(options) : reason;
    };
    if (!parseArguments(app, argc, argv, problem, exitCode)) return false;
    std::sscanf(cloth.c_str(), "%d%*c%d", &options.m_clothColumns, &options.m_clothRows);
    options.m_stepsGiven = app.count("--steps") > 0;
    options.m_dtGiven = app.count("--dt") > 0;
    return true;
}
}  // namespace drape
