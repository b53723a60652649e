#include "tools/drape_check/options.h"

#include <CLI/CLI.hpp>

#include "mesh_io/read_mesh_file.h"
#include "tools/common/arguments.h"
#include "tools/common/program.h"

namespace drape
{
namespace
{
constexpr const char* kCheckExitCodes =
    "Exit codes: 0 success, 1 the computation failed or its answer could not be written,\n"
    "2 arguments, files or a device cannot be used, or there are more pairs than --candidate-limit.";

const std::string kMeshFile = std::string("mesh file (") + kMeshFormats + ")";

void addFile(CLI::App& command, const char* name, std::string& target, const std::string& what, bool needed = true)
{
    CLI::Option* option = command.add_option(name, target, what)->type_name("PATH");
    if (needed) option->required();
}

void addMotionOptions(CLI::App& command, Options& options)
{
    command.add_option("--separation", options.m_separation, "distance up to which features count as touching, m")
        ->check(CLI::Validator(numberAbove(0, true, "0 or more"), ""));
    command
        .add_option("--tolerance", options.m_tolerance,
                    "accuracy of the distance at which the search ends, relative to the pair's extent")
        ->check(CLI::Validator(numberAbove(0, false, "more than 0"), ""));
    command
        .add_option("--time-tolerance", options.m_timeTolerance,
                    "accuracy of the time of impact, as a part of the step; 1: do not search for the time")
        ->check(CLI::Validator(numberAbove(0, false, "more than 0"), ""));
}

void addLimit(CLI::App& command, Options& options)
{
    command
        .add_option("--candidate-limit", options.m_candidateLimit,
                    "largest number of pairs of triangles, or of features, to test, 1 to 268435456; "
                    "with more pairs the command reports their number and ends with 2")
        ->check(CLI::Validator(wholeNumber(1, 1 << 28), ""));
}

void addJoin(CLI::App& command, Options& options)
{
    command.add_flag(
        "--join", options.m_join,
        "join vertices at equal positions; without it only vertices of files without indices (STL) are joined");
}

void addCcd(CLI::App& app, Options& options)
{
    CLI::App& command =
        *app.add_subcommand("ccd", "do moving vertices, faces and edges touch? Reads records with answers");
    addFile(command, "FILE", options.m_first, "records of 104 bytes: 24 floats, kind, answer");
    addMotionOptions(command, options);
    command.callback([&options] { options.m_command = Command::Ccd; });
}

void addTriangles(CLI::App& app, Options& options, std::string& mode)
{
    CLI::App& command = *app.add_subcommand("triangles", "do triangles intersect? Reads records with answers");
    addFile(command, "FILE", options.m_first, "records of 76 bytes: 18 floats, answer");
    acceptOnly(command.add_option("--mode", mode, "fast: misses none and also reports a few that nearly touch; exact"),
               {"fast", "exact"});
    command.callback([&options] { options.m_command = Command::Triangles; });
}

void addMeshes(CLI::App& app, Options& options)
{
    CLI::App& pairs = *app.add_subcommand("pairs", "which triangles of two meshes, or of one, are near or intersect?");
    addFile(pairs, "A", options.m_first, kMeshFile);
    addFile(
        pairs, "B", options.m_second,
        "mesh file; without it A is compared with itself, leaving out pairs that share a vertex by index (see --join)",
        false);
    pairs.add_option("--thickness", options.m_thickness, "largest distance of near triangles, m")
        ->check(CLI::Validator(numberAbove(0, true, "0 or more"), ""));
    addJoin(pairs, options);
    addLimit(pairs, options);
    pairs.callback([&options] { options.m_command = Command::Pairs; });

    CLI::App& step = *app.add_subcommand("step", "which features of a moving mesh touch one another during a step?");
    addFile(step, "A0", options.m_first, kMeshFile + ": the start");
    addFile(step, "A1", options.m_second, "mesh file: the end, with the same vertices and faces");
    addMotionOptions(step, options);
    addJoin(step, options);
    addLimit(step, options);
    step.callback([&options] { options.m_command = Command::Step; });
}
}  // namespace

bool parseOptions(int argc, const char* const* argv, Options& options, int& exitCode)
{
    CLI::App app("Answers collision questions with Drape. Counts its errors if the file has the true answers.",
                 "drape_check");
    app.footer(kCheckExitCodes);
    std::string mode = "fast";
    options.m_tolerance = defaultCcdSettings().m_tolerance;
    app.option_defaults()->always_capture_default();
    app.fallthrough();
    acceptOnly(app.add_option("--backend", options.m_backend, "auto: a GPU, else the host"),
               {"auto", "opencl", "host"});
    app.add_option("--device", options.m_device, "part of an OpenCL device's or platform's name")->type_name("TEXT");
    app.add_option("--json", options.m_json, "write the answer; - is standard output")
        ->type_name("FILE")
        ->transform(CLI::Validator(outputFile, ""));
    app.add_flag("--list-devices", options.m_listDevices, "list the OpenCL devices and exit");
    app.add_flag("--quiet", options.m_quiet, "print nothing");
    addCcd(app, options);
    addTriangles(app, options, mode);
    addMeshes(app, options);
    app.require_subcommand(0, 1);
    const auto conflict = [&]() -> std::string
    { return options.m_listDevices || !app.get_subcommands().empty() ? "" : "a command is needed; see --help"; };
    if (!parseArguments(app, argc, argv, conflict, exitCode)) return false;
    options.m_test = mode == "exact" ? TriangleTest::Exact : TriangleTest::Certified;
    return true;
}
}  // namespace drape
