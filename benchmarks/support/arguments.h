// Command-line options that all benchmark programs share.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/support/table.h"
#include "drape/settings.h"
#include "tools/common/arguments.h"

namespace drape::bench
{
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

// Returns "" if all names are known. Otherwise returns one line with the first unknown name, a similar name, and all
// known names.
std::string unknownName(const char* option, const std::vector<std::string>& names,
                        const std::vector<std::string>& known);

// Writes the table to the files that the options name, or as CSV to standard output if they name none. Returns
// kExitOtherHash if a row is void, else kExitFailed if something could not be measured.
int finishTable(const std::string& program, const Table& table, const CommonOptions& options);
}  // namespace drape::bench
