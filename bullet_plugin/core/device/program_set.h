// The programs of a back end, each built once.
//
// A CPU's driver reads OpenCL's own declarations for every program, which takes 30 ms with PoCL even for cached
// kernels. It also compiles code that several programs include once per program. Files that are needed together
// therefore form one program on a CPU. On a GPU each file is a program, so that its kernels' registers depend on that
// file alone.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "program.h"

namespace drape
{
class ProgramSet
{
public:
    using Names = std::vector<std::string>;  // names in "kernels/<name>.cl"

    // together: files that form one program on a CPU; if a file is in several, the first counts. cacheFolder,
    // defines: see buildJoinedProgram(). The device is kept.
    ProgramSet(Device& device, std::string cacheFolder, std::vector<Names> together,
               std::string defines = std::string());

    // Returns the program that contains the file, built at the first call. Errors: in the device.
    cl::Program load(const std::string& name);
    ProgramLoader loader()
    {
        return [this](const char* name) { return load(name); };
    }
    // Returns whether all loaded programs came from the cache.
    bool fromCache() const { return m_fromCache; }
    // Returns the time of builds that did not come from the cache, ms. Drivers may compile more at the first launch.
    double compileMs() const { return m_compileMs; }

private:
    Names namesWith(const std::string& name) const;

    Device& m_device;
    std::string m_cacheFolder, m_defines;
    std::vector<Names> m_groups;
    std::map<Names, cl::Program> m_programs;
    bool m_fromCache = true;
    double m_compileMs = 0;
};
}  // namespace drape
