#include "tools/common/arguments.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>

#include "tools/common/argument_mistakes.h"
#include "tools/common/command_pages.h"
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

// Says in a plain sentence what CLI11 found. CLI11's own texts are for programmers.
std::string plainText(const CLI::ParseError& error)
{
    const std::string text = error.what(), kind = error.get_name();
    const auto upTo = [&text](const char* mark) { return text.substr(0, text.find(mark)); };
    if (kind == "RequiredError") return upTo(" is required") + " is missing; see --help";
    if (kind == "ExcludesError")
        return upTo(" excludes ") + " and " + text.substr(text.rfind(' ') + 1) + " exclude each other";
    if (kind == "ArgumentMismatch")
    {
        const bool missing = text.size() > 7 && text.compare(text.size() - 7, 7, "missing") == 0;
        return upTo(":") + (missing ? " needs a value; see --help" : " may be given only once");
    }
    const std::string failed = "Could not convert: ";
    const std::size_t equals = text.find(" = ");
    if (kind == "ConversionError" && text.rfind(failed, 0) == 0 && equals != std::string::npos)
        return text.substr(failed.size(), equals - failed.size()) + " cannot take the value '" +
               text.substr(equals + 3) + "'; see --help";
    return text;
}
}  // namespace

std::function<std::string(std::string&)> numberAbove(double least, bool inclusive, const char* what)
{
    return [=](std::string& text) -> std::string
    {
        double value = 0;
        const std::string problem = asNumber(text, value);
        if (!problem.empty()) return problem;
        // The programs compute with float: a larger number is infinite there, and a smaller one is 0.
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

std::function<std::string(std::string&)> wholeNumber(long long least, long long most)
{
    return [=](std::string& text) -> std::string
    {
        const std::string problem =
            "'" + text + "' must be a whole number from " + std::to_string(least) + " to " + std::to_string(most);
        try
        {
            std::size_t end = 0;
            const long long value = std::stoll(text, &end);
            return end == text.size() && value >= least && value <= most ? "" : problem;
        }
        catch (const std::exception&)
        {
            return problem;
        }
    };
}

std::string outputFile(std::string& text)
{
    for (const char* name : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"})
        if (text == name) text = "-";
    return text.empty() ? "the name of the file is empty" : "";
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
                         "print the version and exit");
    std::string problem, shell;
    bool man = false;
    app.add_flag("--man-page", man, "print a man page and exit");
    acceptOnly(app.add_option("--completion", shell, "print a script for the shell's completion and exit"),
               {kBash, kZsh, kFish});
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
        if (problem.empty() && man) return printAndLeave(manPage(app));
        if (problem.empty() && !shell.empty()) return printAndLeave(completionScript(app, shell));
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
        if (problem.empty()) problem = plainText(error);
    }
    if (problem.empty()) return true;
    exitCode = fail(app.get_name(), kExitBadInput, problem);
    return false;
}
}  // namespace drape
