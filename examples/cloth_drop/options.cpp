#include "examples/cloth_drop/options.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>

#include "examples/cloth_drop/drop_scene.h"
#include "scenes/shapes.h"
#include "tools/common/arguments.h"
#include "tools/common/program.h"
#include "tools/common/suggestion.h"

namespace drape
{
namespace
{
// What --help says of --json and of how runs end.
constexpr const char* kResultsText =
    "JSON keys end in their units. step_ms, collision_ms, collision_parts_ms (medians) and penetration_p99_m are over\n"
    "the steps in contact, and null where there were none. Of the collision, finding_ms leaves out solving the\n"
    "contacts, which Bullet's own figures leave out, too. Penetration is how far a node was below the surface, or a\n"
    "vertex of the obstacle above a face. intersecting_pairs_max is the largest number of intersecting pairs of\n"
    "triangles after any step, intersecting_pairs_max_step the first step that had it (0: none had any). Each step\n"
    "is checked, exactly and outside of the measured times; --csv has the number of each. With --compare there is an\n"
    "object a run: drape, bullet_stock, bullet_tuned and, where asked for, bullet_vfss. capped_at_step is the last\n"
    "step that was done before a limit of time, --compare-cap, a signal or a failure ended the run.\n"
    "The first SIGINT, SIGTERM or SIGHUP ends the run as --time-limit does, but with exit code 1 and without a\n"
    "picture; one that is being drawn is given up. A second signal ends the program at once.";

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
    app.add_option("--drop-height", options.m_dropHeight, "free fall before the thickness is reached, m, 10000 at most")
        ->check(CLI::Validator(numberUpTo(kLongest, 0, true, "0 or more, 10000 at most"), ""));
    app.add_option("--drop-speed", options.m_dropSpeed,
                   "speed of the cloth downwards at the start, m/s; 100000 m a step at most")
        ->check(CLI::Validator(numberAbove(0, true, "0 or more"), ""));
    app.add_option("--steps", options.m_steps, "simulation steps")->check(positive);
    app.add_option("--time-limit", options.m_timeLimit,
                   "seconds, measuring included, after which the run ends with the steps it has done; with --compare "
                   "Drape's run alone")
        ->check(positive)
        ->default_str("none");
    app.add_option("--dt", options.m_dt, "seconds a step")->check(positive);
    app.add_option("--thickness", options.m_thickness,
                   "gap at rest: half is the cloth's margin, half the obstacle's, m, 0.0001 to 10000")
        ->check(CLI::Validator(numberUpTo(kLongest, kLeastThickness, true, "0.0001 or more, 10000 at most"), ""));
}

void addBackendOptions(CLI::App& app, Options& options, std::string& mode)
{
    acceptOnly(app.add_option(
                   "--backend", options.m_backend,
                   "auto: a GPU, else any OpenCL device, unless the scene costs less on the host; bullet: built in"),
               {"auto", "opencl", "host", "bullet"});
    acceptOnly(app.add_option("--mode", options.m_contactMode, "how Drape looks at motion within a step"),
               {"discrete", "continuous", "automatic"});
    app.add_flag("--all-contacts", options.m_allContacts, "solve contacts too that others imply");
    app.add_option("--threads", options.m_threads,
                   "that hold contacts, and of the host; 0: as many as there are cores, 8 at most")
        ->check(CLI::Range(0, 64));
    acceptOnly(
        app.add_option("--bullet-mode", mode, "distance field of --backend bullet, or the obstacle as a soft body"),
        {"stock", "tuned", "vfss"});
    app.add_option("--device", options.m_device, "part of an OpenCL device's or platform's name")->type_name("TEXT");
    app.add_flag("--list-devices", options.m_listDevices, "list the OpenCL devices and leave");
    app.add_flag("--compare", options.m_compare, "then run Bullet's built-in collision on the same scene");
    app.add_flag("--compare-vfss", options.m_compareSoftPair, "with --compare: also two soft bodies (VF_SS)");
    app.add_option("--compare-cap", options.m_compareCap,
                   "seconds of stepping after which a built-in run of --compare is ended")
        ->check(CLI::Validator(numberAbove(0, false, "more than 0"), ""));
}

void addOutputOptions(CLI::App& app, Options& options)
{
    const auto add = [&app](const char* name, std::string& path, const char* type, const char* text)
    { app.add_option(name, path, text)->type_name(type)->transform(CLI::Validator(outputFile, "")); };
    add("--csv", options.m_csv, "FILE", "write a row a step; - is standard output");
    add("--json", options.m_json, "FILE", "write the summary; - is standard output");
    add("--frames", options.m_frames, "DIR", "write obstacle.ply and a cloth_NNNN.ply a step");
    add("--picture", options.m_picture, "FILE.png",
        "write a shaded picture, a PNG, of the last frame; with --compare of every run's, side by side");
    app.add_option("--validate-hash", options.m_validateHash, "exit with 3 unless the run's hash is this")
        ->type_name("H")
        ->transform(CLI::Validator(hash, ""));
    app.add_flag("--quiet", options.m_quiet, "no progress and no summary");
    app.add_flag("--stream-steps", options.m_streamSteps, "")->group("");
    app.add_flag("--stream-positions", options.m_streamPositions, "")->group("");
}

std::string conflict(const Options& options)
{
    if (!((options.m_dropSpeed + kGravity * options.m_dt) * options.m_dt <= kFarthest))
        return "--drop-speed and --dt let the cloth go more than 100000 m in a step";
    if (!options.usesDrape() && options.m_compare) return "--compare needs a back end of Drape, not --backend bullet";
    if (!options.usesDrape() && !options.m_device.empty()) return "--device means nothing with --backend bullet";
    if (options.m_compareSoftPair && !options.m_compare) return "--compare-vfss needs --compare";
    if (!options.usesDrape() && options.m_timeLimit > 0 && !options.m_frames.empty())
        return "--time-limit with --backend bullet leaves no cloth for --frames";
    if (options.m_obstacle.empty()) return "--obstacle is empty";
    if (options.m_picture == "-") return "--picture needs a file, not -";
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
    addBackendOptions(app, options, mode);
    addOutputOptions(app, options);
    if (!parseArguments(
            app, argc, argv, [&options] { return conflict(options); }, exitCode))
        return false;
    std::sscanf(cloth.c_str(), "%d%*c%d", &options.m_clothColumns, &options.m_clothRows);
    static const std::map<std::string, BulletMode> modes = {
        {"stock", BulletMode::Stock}, {"tuned", BulletMode::Tuned}, {"vfss", BulletMode::SoftPair}};
    options.m_bulletMode = modes.at(mode);
    return true;
}
}  // namespace drape
