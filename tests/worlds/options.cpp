#include "tests/worlds/options.h"

#include <sstream>

#include <CLI/CLI.hpp>

#include "tests/worlds/modifiers.h"
#include "tools/common/arguments.h"
#include "tools/common/suggestion.h"

namespace drape::test
{
namespace
{
std::string modifierProblem(const std::string& text, std::uint32_t& bits)
{
    if (parseModifiers(text, bits)) return "";
    std::vector<std::string> known = {"none", "random"};
    for (const ModifierName& modifier : modifierNames())
        known.push_back(modifier.m_name);
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');)
        if (!parseModifiers(word, bits)) return "--modifiers: " + unknownWord(word, known);
    return "--modifiers: '" + text + "' is not known; see --list";
}

std::string kindProblem(const WorldsOptions& options)
{
    if (!worldsOf(options.m_kind, 0, 1, options.m_modifiers).empty()) return "";
    std::vector<std::string> known = {"all", "tiny", "skirts"};
    known.insert(known.end(), kindNames().begin(), kindNames().end());
    return "--kind: " + unknownWord(options.m_kind, known);
}

void addWorlds(CLI::App& app, WorldsOptions& options, std::string& modifiers)
{
    app.add_option(
        "--kind", options.m_kind,
        "a kind of --list; all: the random ones without ropes and loads; tiny: worlds of 4 to 9 nodes; skirts: two "
        "grids of settings");
    app.add_option("--seed", options.m_seed, "first seed, or first setting of a grid, 0 to 1000000000")
        ->check(CLI::Validator(wholeNumber(0, 1000000000), ""));
    app.add_option("--count", options.m_count, "number of worlds of every chosen kind, with consecutive seeds")
        ->check(CLI::Validator(wholeNumber(0, 1000000000), ""));
    app.add_option(
        "--modifiers", modifiers,
        "none, random (each of the first sixteen of --list with probability 0.18), or names joined by commas");
}

void addRunning(CLI::App& app, WorldsOptions& options)
{
    acceptOnly(app.add_option("--backend", options.m_backend,
                              "where Drape runs; stock: Bullet's own collision, for comparison"),
               {"host", "opencl", "stock", "substeps"});
    app.add_option("--jobs", options.m_jobs, "number of parallel processes, 1 to 1024")
        ->check(CLI::Validator(wholeNumber(1, 1024), ""));
    app.add_option("--timeout", options.m_timeout, "time limit of one world, s")
        ->check(CLI::Validator(numberAbove(0, false, "more than 0"), ""));
    app.add_option("--most-failing", options.m_mostFailing,
                   "largest number of failing worlds that still ends with exit code 0");
    app.add_flag("--list", options.m_list, "list kinds and modifiers, and exit");
    app.add_flag("--verbose", options.m_verbose,
                 "print a line for every world; with a single world also for every step");
}
}  // namespace

bool parseOptions(int argc, const char* const* argv, WorldsOptions& options, int& exitCode)
{
    CLI::App app(
        "Runs random worlds of cloth and obstacles in Bullet, and checks after every step that no cloth triangle or "
        "rope\n"
        "intersects an obstacle and no node went through, unless the step's status reports it.",
        "drape_worlds");
    app.footer("Exit codes: 0 success, 1 more worlds fail than allowed, 2 arguments cannot be used.");
    app.option_defaults()->always_capture_default();
    std::string modifiers = "none";
    addWorlds(app, options, modifiers);
    addRunning(app, options);
    const auto conflict = [&]() -> std::string
    {
        options.m_modifiers.m_random = modifiers == "random";
        const std::string problem =
            options.m_modifiers.m_random ? "" : modifierProblem(modifiers, options.m_modifiers.m_bits);
        return problem.empty() ? kindProblem(options) : problem;
    };
    return parseArguments(app, argc, argv, conflict, exitCode);
}
}  // namespace drape::test
