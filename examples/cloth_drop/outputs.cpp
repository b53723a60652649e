#include "examples/cloth_drop/outputs.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <map>

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
bool areApart(const std::vector<Output>& outputs, std::string& error)
{
    std::map<fs::path, const char*> optionOf;
    for (const Output& output : outputs)
    {
        if (output.m_path.empty()) continue;
        std::error_code code;
        const fs::path place =
            output.m_path == kStandardOutput ? fs::path(kStandardOutput) : fs::weakly_canonical(output.m_path, code);
        const auto added = optionOf.emplace(place, output.m_option);
        if (added.second || fs::is_other(place, code)) continue;  // a device takes both
        error = std::string(added.first->second) + " and " + output.m_option + " both write " + output.m_path;
        return false;
    }
    return true;
}
}  // namespace

bool prepareOutputs(const Options& options, std::string& error)
{
    const std::vector<Output> outputs = {
        {"--csv", options.m_csv}, {"--json", options.m_json}, {"--picture", options.m_picture}};
    for (const Output& output : outputs)
        if (!couldWrite(output.m_path, error)) return false;
    if (!areApart(outputs, error)) return false;
    if (options.m_frames.empty()) return true;
    std::error_code code;
    fs::create_directories(options.m_frames, code);
    if (!fs::is_directory(options.m_frames) || ::access(options.m_frames.c_str(), W_OK) != 0)
        error = options.m_frames + ": cannot write: " + (code ? code.message() : std::string(std::strerror(errno)));
    return error.empty();
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
