#include "tools/common/arguments.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>

#include "tools/common/argument_mistakes.h"
#include "tools/common/suggestion.h"
#include "drape/version.h"

namespace drape
{
namespace
{
std::string asNumber(const std::string& text, double& value)
{
    try
    {
        std::size_t end = 0;
        value = std::stod(text, &end);
        if (end == text.size() && std::isfinite(static_cast<float>(value))) return "";
    }
    catch (const std::exception&)
    {
    }
    return "'" + text + "' is not a finite number";
}
}  // namespace

std::function<std::string(std::string&)> numberAbove(double least, bool inclusive, const char* what)
{
    return [=](std::string& text) -> std::string
    {
        double value = 0;
        const std::string problem = asNumber(text, value);
        if (!problem.empty()) return problem;
        // The programs compute with float: what is beyond it is no finite number there, and what is below it 0.
        if (value > 0 && !(static_cast<float>(value) > 0)) return "'" + text + "' is too small for float32";
        return value > least || (inclusive && value >= least) ? "" : "'" + text + "' must be " + what;
    };
}

std::function<std::string(std::string&)> numberUpTo(double most, double least, bool inclusive, const char* what)
{
    return [=, above = numberAbove(least, inclusive, what)](std::string& text) -> std::string
    {
        const std::string problem = above(text);
        return !problem.empty() || std::stod(text) <= most ? problem : "'" + text + "' must be " + what;
    };
}

std::string outputFile(std::string& text)
{
    for (const char* name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"})
        if (text == name) text = "-";
    return text.empty() ? "is empty" : "";
}

void acceptOnly(CLI::Option* option, const std::vector<std::string>& names)
{
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "{" : ",") + name;
    const auto isKnown = [names](const std::string& text)
    { return std::find(names.begin(), names.end(), text) == names.end() ? unknownWord(text, names) : std::string(); };
    option->check(CLI::Validator(isKnown, all + "}"));
}

bool parseArguments(CLI::App& app, int argc, const char* const* argv, const std::function<std::string()>& conflict,
                    int& exitCode)
{
    app.set_version_flag("--version", app.get_name() + " (Drape) " + DRAPE_VERSION_STRING,
                         "print the version and leave");
    std::string problem;
    const auto printAndLeave = [&](const std::string& text)
    {
        std::cout << text;
        exitCode = flushOutput(problem) ? kExitGood : fail(app.get_name(), kExitFailed, problem);
        return false;
    };
    const auto mistake = [&]
    { return argumentMistake(app, std::vector<std::string>(argv + std::min(argc, 1), argv + argc)); };
    try
    {
        app.parse(argc, argv);
        problem = mistake();
        if (problem.empty()) problem = conflict();
    }
    catch (const CLI::CallForHelp&)
    {
        return printAndLeave(app.help());
    }
    catch (const CLI::CallForVersion& version)
    {
        return printAndLeave(version.what() + std::string("\n"));
    }
    catch (const CLI::ParseError& error)
    {
        problem = mistake();
        if (problem.empty()) problem = error.what();
    }
    if (problem.empty()) return true;
    exitCode = fail(app.get_name(), kExitBadInput, problem);
    return false;
}
}  // namespace drape
