#include "tools/cloth_drop/outputs.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string_view>

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
    std::string_view m_ending = "";  // the ending of its name; empty: any
    const char* m_format = "";
};

// Refuses two outputs to one file, of which only one would remain.
bool areApart(const Output& one, const Output& other, std::string& error)
{
    if (one.m_path.empty() || other.m_path.empty()) return true;
    const bool same = one.m_path == kStandardOutput || other.m_path == kStandardOutput
                          ? one.m_path == other.m_path
                          : areOneFile(one.m_path, other.m_path);
    if (same) error = std::string(one.m_option) + " and " + other.m_option + " both write " + other.m_path;
    return !same;
}

// Names that --frames writes.
bool isFrame(const std::string& name)
{
    const std::string end = ".ply";
    const auto isNumbered = [&](const std::string& start)
    {
        return name.size() > start.size() + end.size() && name.compare(0, start.size(), start) == 0 &&
               name.compare(name.size() - end.size(), end.size(), end) == 0;
    };
    return name == "obstacle.ply" || isNumbered("cloth_") || isNumbered("obstacle_");
}

// Refuses an output file that --frames would overwrite.
bool spares(const Options& options, const Output& file, std::string& error)
{
    if (file.m_path.empty() || file.m_path == kStandardOutput) return true;
    const fs::path path(file.m_path);
    const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
    if (!options.m_frames.empty() && isFrame(path.filename().string()) && areOneFile(folder, options.m_frames))
        error = file.m_path + ": --frames writes a file of that name there";
    return error.empty();
}

// Refuses an output that would replace a file that was read.
bool sparesInputs(const Output& output, const std::vector<std::pair<std::string, std::string>>& inputs,
                  std::string& error)
{
    if (output.m_path.empty() || output.m_path == kStandardOutput) return true;
    for (const auto& [option, path] : inputs)
        if (areOneFile(output.m_path, path))
            error = std::string(output.m_option) + " would write over the file of " + option + ", " + path;
    return error.empty();
}

// Accepts the ending of the option's format, and names without one. Any other promises a format that is not written.
bool endsRight(const Output& output, std::string& error)
{
    std::string ending = fs::path(output.m_path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (output.m_ending.empty() || ending.empty() || ending == output.m_ending) return true;
    error = std::string(output.m_option) + " writes a " + output.m_format + ", and " + output.m_path +
            " does not end in " + std::string(output.m_ending);
    return false;
}

bool makeFolder(const std::string& path, std::string& error)
{
    std::error_code code, ignored;
    fs::create_directories(path, code);
    if (!fs::is_directory(path, ignored))
        error = path + ": cannot write: " + (fs::exists(path, ignored) ? "it is not a folder" : code.message());
    else if (::access(path.c_str(), W_OK) != 0)
        error = path + ": cannot write: " + std::strerror(errno);
    return error.empty();
}
}  // namespace

bool prepareOutputs(const Options& options, const std::vector<std::pair<std::string, std::string>>& inputs,
                    std::string& error)
{
    if (!options.m_frames.empty() && !makeFolder(options.m_frames, error)) return false;
    if (!options.m_pointCache.empty() && !makeFolder(options.m_pointCache, error)) return false;
    const Output outputs[] = {{"--csv", options.m_csv},
                              {"--json", options.m_json},
                              {"--picture", options.m_picture, ".png", "PNG"},
                              {"--replay", options.m_replay, ".html", "page"},
                              {"--animation", options.m_animation, ".webp", "WebP"},
                              {"--gltf", options.m_gltf, ".glb", "binary glTF"}};
    for (const auto& [option, path] : inputs)
        if (!spares(options, {option.c_str(), path}, error)) return false;
    for (const Output& output : outputs)
    {
        if (!spares(options, output, error) || !couldWrite(output.m_path, error)) return false;
        if (!sparesInputs(output, inputs, error)) return false;
    }
    for (const Output& output : outputs)
    {
        if (!endsRight(output, error)) return false;
        for (const Output* other = outputs; other != &output; ++other)
            if (!areApart(*other, output, error)) return false;
    }
    return true;
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
    write(options.m_json, asJson(runs, options.m_compare).dump(2) + "\n");
    const bool taken = options.m_csv == kStandardOutput || options.m_json == kStandardOutput;
    if (!options.m_quiet && !taken) std::cout << asTable(runs);
    return flushOutput(error);
}
}  // namespace drape
