// The command line of drape_check: which question, about which files, on which back end.
// Lengths in metres. parseOptions checks every value, so that the rest of the program may trust them.
#pragma once

#include <string>

#include <drape/queries.h>
#include "tools/common/program.h"

namespace drape
{
enum class Command
{
    Ccd,
    Triangles,
    Pairs,
    Step
};

struct Options
{
    Command m_command = Command::Ccd;
    std::string m_first, m_second;                               // files; m_second is empty for a mesh with itself
    double m_thickness = 0;                                      // pairs
    std::size_t m_candidateLimit = Settings().m_candidateLimit;  // pairs and step
    bool m_join = false;                                         // pairs and step: join vertices at equal positions
    TriangleTest m_test = TriangleTest::Certified;
    double m_separation = 0;  // ccd and step
    double m_tolerance = 0;
    double m_timeTolerance = 1;
    std::string m_backend = "auto";
    std::string m_device;
    bool m_listDevices = false;
    std::string m_json;  // - is standard output
    bool m_quiet = false;
};

// Returns true if the program goes on. Returns false if it must leave with `exitCode`, after printing the help or one
// line on standard error.
bool parseOptions(int argc, const char* const* argv, Options& options, int& exitCode);
}  // namespace drape
