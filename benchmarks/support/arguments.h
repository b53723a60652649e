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

// "" when all names are known, else one line with the first that is not, the one that may be meant, and all there are.
std::string unknownName(const char* option, const std::vector<std::string>& names,
                        const std::vector<std::string>& known);

// Writes the table to the files that the options name, or as CSV to standard output if they name none. Returns
// kExitOtherHash if a row is void, else kExitFailed if something could not be measured.
int finishTable(const std::string& program, const Table& table, const CommonOptions& options);
}  // namespace drape::bench
