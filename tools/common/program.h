// Entry and exit of Drape's programs: exit codes, one line on standard error, no exception out of main.
#pragma once

#include <functional>
#include <string>

namespace drape
{
enum ExitCode
{
    kExitGood = 0,
    kExitFailed = 1,    // the run or a measurement failed, or something could not be written
    kExitBadInput = 2,  // arguments, files (also one that can be seen beforehand not to be writable) or device
    kExitOtherHash = 3  // a hash is not the one to be: --validate-hash, or a row of a benchmark
};

// The part of --help that lists the codes of cloth_drop.
constexpr const char* kExitCodesText =
    "Exit codes: 0 success, 1 a run failed or its results could not be written,\n"
    "2 arguments, files or a device cannot be used, 3 the hash differs from --validate-hash.";

// Prints "program: reason" and returns the code.
int fail(const std::string& program, int exitCode, const std::string& reason);

// Runs a program's work, PoCL's threads kept apart (pocl_threads.h); what it throws becomes a failure.
int runGuarded(const std::string& program, const std::function<int()>& work);

// Flushes standard output. False, with a line in `error` unless there is one, when it could not be written.
bool flushOutput(std::string& error);

// Returns true if a file could be written there, before the work is done. - and an empty path are always accepted.
// Otherwise sets `error` to one line.
bool couldWrite(const std::string& path, std::string& error);
}  // namespace drape
