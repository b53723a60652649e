// drape_worlds: random worlds against the independent check. tests/README.md says how counts are read.
#include <cstdio>

#include "tests/worlds/modifiers.h"
#include "tests/worlds/options.h"
#include "tests/worlds/summary.h"
#include "tests/worlds/workers.h"
#include "tools/common/arguments.h"

namespace drape::test
{
namespace
{
void list()
{
    std::puts("kinds:");
    for (const std::string& name : kindNames())
        std::printf("  %s\n", name.c_str());
    std::puts("modifiers:");
    for (const ModifierName& modifier : modifierNames())
        std::printf("  %s (%u)\n", modifier.m_name, static_cast<unsigned>(modifier.m_bit));
}

WorldBackend backendOf(const std::string& name)
{
    if (name == "substeps") return WorldBackend::Substeps;
    return name == "stock" ? WorldBackend::Stock : name == "opencl" ? WorldBackend::OpenCl : WorldBackend::Host;
}

int run(const WorldsOptions& options)
{
    if (options.m_list)
    {
        list();
        return kExitGood;
    }
    const std::vector<WorldSpec> worlds =
        worldsOf(options.m_kind, options.m_seed, options.m_count, options.m_modifiers);
    Summary summary;
    const auto done = [&](const WorldSpec& spec, const WorldResult& result)
    {
        const std::size_t before = summary.failing();
        summary.add(spec, result);
        if (options.m_verbose || summary.failing() > before) std::puts(resultText(spec, result).c_str());
        std::fflush(stdout);
    };
    if (options.m_verbose && worlds.size() == 1)
        done(worlds[0], runWorld(worlds[0], backendOf(options.m_backend), true));
    else if (!runWorlds(worlds, {backendOf(options.m_backend), options.m_jobs, options.m_timeout}, done))
        return fail("drape_worlds", kExitFailed, "no process could be started");
    std::fputs(summary.text().c_str(), stdout);
    const bool good = summary.failing() <= options.m_mostFailing;
    return good ? kExitGood : kExitFailed;
}
}  // namespace
}  // namespace drape::test

int main(int argc, char** argv)
{
    return drape::runProgram("drape_worlds", argc, argv, drape::test::parseOptions, drape::test::run);
}
