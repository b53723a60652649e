#include "program_set.h"

#include <algorithm>
#include <utility>

#include "bullet_plugin/core/stopwatch.h"

namespace drape
{
ProgramSet::ProgramSet(Device& device, std::string cacheFolder, std::vector<Names> together, std::string defines)
    : m_device(device), m_cacheFolder(std::move(cacheFolder)), m_defines(std::move(defines))
{
    if (!device.isGpu()) m_groups = std::move(together);
}

ProgramSet::Names ProgramSet::namesWith(const std::string& name) const
{
    for (const Names& group : m_groups)
        if (std::find(group.begin(), group.end(), name) != group.end()) return group;
    return Names{name};
}

cl::Program ProgramSet::load(const std::string& name)
{
    const Names names = namesWith(name);
    const auto known = m_programs.find(names);
    if (known != m_programs.end()) return known->second;
    ProgramBuild build;
    Stopwatch watch;
    const cl::Program program = buildJoinedProgram(m_device, names, m_cacheFolder, build, m_defines);
    m_fromCache = m_fromCache && build.m_fromCache;
    if (!build.m_fromCache) m_compileMs += watch.lapMs();
    m_programs.emplace(names, program);
    return program;
}
}  // namespace drape
