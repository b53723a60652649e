#include "examples/cloth_drop/outputs.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

#include <unistd.h>

#include "scenes/atomic_file.h"

namespace drape
{
bool prepareOutputs(const Options& options, std::string& error)
{
    for (const std::string* path : {&options.m_csv, &options.m_json, &options.m_picture})
        if (!couldWrite(*path, error)) return false;
    if (options.m_frames.empty()) return true;
    namespace fs = std::filesystem;
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
        if (!path.empty() && !writeFileAtomically(path, bytes, problem) && error.empty()) error = problem;
    };
    write(options.m_csv, asCsv(runs.front().m_record, options.m_dt));
    const std::string json = asJson(runs).dump(2) + "\n";
    if (options.m_json != "-") write(options.m_json, json);
    if (!options.m_quiet && options.m_json != "-") std::cout << asTable(runs);
    if (options.m_json == "-") std::cout << json;
    return flushOutput(error);
}
}  // namespace drape
