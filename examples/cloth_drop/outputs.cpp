#include "examples/cloth_drop/outputs.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

#include <unistd.h>

#include "scenes/atomic_file.h"

namespace drape
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* kStandardOutput = "-";

struct Output
{
    const char* m_option;
    const std::string& m_path;
};

// Two that go to one place would leave one of them.
bool areApart(const Output& one, const Output& other, std::string& error)
{
    if (one.m_path.empty() || other.m_path.empty()) return true;
    const bool same = one.m_path == kStandardOutput || other.m_path == kStandardOutput
                          ? one.m_path == other.m_path
                          : areOneFile(one.m_path, other.m_path);
    if (same) error = std::string(one.m_option) + " and " + other.m_option + " both write " + other.m_path;
    return !same;
}

bool makeFolder(const std::string& path, std::string& error)
{
    std::error_code code;
    fs::create_directories(path, code);
    if (!fs::is_directory(path, code) || ::access(path.c_str(), W_OK) != 0)
        error = path + ": cannot write: " + (code ? code.message() : std::string(std::strerror(errno)));
    return error.empty();
}
}  // namespace

bool prepareOutputs(const Options& options, std::string& error)
{
    if (!options.m_frames.empty() && !makeFolder(options.m_frames, error)) return false;
    const Output outputs[] = {{"--csv", options.m_csv}, {"--json", options.m_json}, {"--picture", options.m_picture}};
    for (const Output& output : outputs)
        if (!couldWrite(output.m_path, error)) return false;
    return areApart(outputs[0], outputs[1], error) && areApart(outputs[0], outputs[2], error) &&
           areApart(outputs[1], outputs[2], error);
}

bool writeOutputs(const Options& options, const std::vector<NamedRun>& runs, std::string& error)
{
    const auto write = [&error](const std::string& path, const std::string& bytes)
    {
        std::string problem;
        if (path == kStandardOutput)
            std::cout << bytes;
        else if (!path.empty() && !writeFileAtomically(path, bytes, problem) && error.empty())
            error = problem;
    };
    write(options.m_csv, asCsv(runs.front().m_record, options.m_dt));
    write(options.m_json, asJson(runs).dump(2) + "\n");
    const bool taken = options.m_csv == kStandardOutput || options.m_json == kStandardOutput;
    if (!options.m_quiet && !taken) std::cout << asTable(runs);
    return flushOutput(error);
}
}  // namespace drape
