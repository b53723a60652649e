// Command lines of Drape's programs, on CLI11. Its header takes seconds to compile: only what defines options includes
// it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/common/program.h"

namespace CLI
{
class App;
class Option;
}  // namespace CLI

namespace drape
{
// Returns a check for CLI11. The check returns "" if the text is a number above `least` (or equal, when inclusive) that
// is finite as float32 and not rounded to 0. Otherwise it returns the reason, which says `what` it must be.
std::function<std::string(std::string&)> numberAbove(double least, bool inclusive, const char* what);

// Returns a check like numberAbove() that also refuses numbers above `most`.
std::function<std::string(std::string&)> numberUpTo(double most, double least, bool inclusive, const char* what);

// Returns a check for CLI11 that accepts whole numbers from `least` to `most`.
std::function<std::string(std::string&)> wholeNumber(long long least, long long most);

// Transforms the name of an output file. Returns "" if it is not empty. Standard output becomes - under its other
// names, too, so that two outputs cannot overwrite each other there.
std::string outputFile(std::string& text);

// Makes the option refuse every value that is none of the names, and say which one may be meant.
void acceptOnly(CLI::Option* option, const std::vector<std::string>& names);

// Makes the shell's completion offer these words for an option whose value may be something else, too, such as a file.
void offerWords(const CLI::Option* option, const std::vector<std::string>& words);

// Adds --version, --man-page and --completion, and parses. argument_mistakes.h names the mistakes. `conflict` then
// returns the reason why the options contradict each other, or "". Returns true if the program goes on. Returns false
// if it must leave with `exitCode`, after printing the help, the version, a page, or one line on standard error.
bool parseArguments(CLI::App& app, int argc, const char* const* argv, const std::function<std::string()>& conflict,
                    int& exitCode);

// Runs a program: `parse` fills the options like parseArguments, `run` does the work and returns the exit code.
template <typename Options>
int runProgram(const char* program, int argc, char** argv, bool (*parse)(int, const char* const*, Options&, int&),
               int (*run)(const Options&))
{
    Options options;
    int exitCode = kExitGood;
    if (!parse(argc, argv, options, exitCode)) return exitCode;
    return runGuarded(program, [&] { return run(options); });
}
}  // namespace drape
