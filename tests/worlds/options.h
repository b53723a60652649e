// The command line of drape_worlds.
#pragma once

#include <string>

#include "tests/worlds/kinds.h"

namespace drape::test
{
struct WorldsOptions
{
    std::string m_kind = "all";  // a kind, or all, tiny or skirts
    std::uint64_t m_seed = 0;
    std::size_t m_count = 1000;
    ModifierChoice m_modifiers;
    std::string m_backend = "host";
    int m_jobs = 1;
    double m_timeout = 60;  // s
    std::size_t m_mostFailing = 0;
    bool m_list = false;
    bool m_verbose = false;
};

// Returns false when the program is to leave with `exitCode`; help or an error has been printed then.
bool parseOptions(int argc, const char* const* argv, WorldsOptions& options, int& exitCode);
}  // namespace drape::test
