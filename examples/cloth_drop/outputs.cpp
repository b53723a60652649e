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

bool couldWrite(const std::string& path, std::string& error)
{
    if (path.empty() || path == "-") return true;
    std::error_code code;
    const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    if (fs::is_directory(path, code))
        error = path + ": cannot write: is a folder";
    else if (!fs::is_directory(folder, code))
        error = path + ": cannot write: no folder " + folder.string();
    else if (::access(folder.c_str(), W_OK) != 0)
        error = path + ": cannot write: " + std::strerror(errno);
    return error.empty();
}
}  // namespace

bool prepareOutputs(const Options& options, std::string& error)
{
    for (const std::string* path : {&options.m_csv, &options.m_json, &options.m_picture})
        if (!couldWrite(*path, error)) return false;
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
        if (!path.empty() && !writeFileAtomically(path, bytes, problem) && error.empty()) error = problem;
    };
    write(options.m_csv, asCsv(runs.front().m_record, options.m_dt));
    const std::string json = asJson(runs).dump(2) + "\n";
    if (options.m_json != "-") write(options.m_json, json);
    if (!options.m_quiet && options.m_json != "-") std::cout << asTable(runs);
    if (options.m_json == "-") std::cout << json;
    std::cout.flush();
    if (!std::cout && error.empty()) error = "standard output: cannot write";
    return error.empty();
}
}  // namespace drape
