// What every benchmark program may be told on its command line.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "benchmarks/support/table.h"
#include "drape/settings.h"

namespace drape::bench
{
enum ExitCode
{
    kExitGood = 0,
    kExitFailed = 1,    // a measurement could not be made, or a result not be written
    kExitBadInput = 2,  // arguments, files or device
    kExitOtherHash = 3  // a row is void
};

struct CommonOptions
{
    std::string m_device;
    std::string m_backend = "auto";
    std::string m_models;  // folder
    std::string m_csv, m_json;
    std::string m_commit = "unknown";
    bool m_quick = false;
    bool m_list = false;
    int m_repeats = 3;
    double m_seconds = 10;   // for one measurement
    double m_minutes = 1e6;  // for all; those that do not fit are named and left out

    Settings settings() const;
};

void addCommonOptions(CLI::App& app, CommonOptions& options);

// True: go on. False: leave with `exitCode`; help or one line on standard error has been printed.
bool parseArguments(CLI::App& app, int argc, const char* const* argv, int& exitCode);

// Prints "<program>: <reason>" to standard error and returns the code.
int fail(const std::string& program, int exitCode, const std::string& reason);

// Runs body; an exception becomes a line on standard error and kExitFailed.
int guarded(const std::string& program, const std::function<int()>& body);

// Writes the table where the options say (or a CSV to standard output where they name nothing) and returns the exit
// code: kExitOtherHash when a row is void, else kExitFailed when something was left out that could not be measured.
int finishTable(const std::string& program, const Table& table, const CommonOptions& options);
}  // namespace drape::bench
