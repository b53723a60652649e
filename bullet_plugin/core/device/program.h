// Programs of the embedded kernels: source with includes resolved, built for a device or taken from the cache on disk.
#pragma once

#include <functional>
#include <string>

#include "device.h"

namespace drape
{
// The text of kernels/<file> with every include replaced by the included text once. Line directives keep each line's
// own file and number, so a compiler's message names the .cl or .h file. Empty when the file is not embedded.
std::string assembleSource(const std::string& path);

// A compiler's log with every "<kernel>:line", as drivers write that ignore line directives, replaced by the file and
// line of the kernels that this line of the assembled source came from.
std::string translateLog(const std::string& log, const std::string& source);

struct ProgramBuild
{
    bool m_fromCache = false;
};

// Builds "kernels/<name>.cl" with contraction off and correctly rounded ÷ and √. cacheFolder empty: the user's cache;
// "none": no cache. A failed build puts the file and the whole log into the device's error. Cache trouble means a
// build, never a failure.
// defines: lines of text put before the source.
cl::Program buildProgram(Device& device, const std::string& name, const std::string& cacheFolder, ProgramBuild& build,
                         const std::string& defines = std::string());

// Gives the program of "kernels/<name>.cl" to a stage that needs several.
using ProgramLoader = std::function<cl::Program(const char* name)>;

// Builds a source text as given, for tests of the log.
cl::Program compileSource(Device& device, const std::string& name, const std::string& source);

// A kernel with its name, for messages. Launches are enqueued; nothing waits.
class Kernel
{
public:
    void create(Device& device, const cl::Program& program, const char* name);

    // Sets all arguments in order and enqueues globalSize work-items, rounded up to groups of localSize. Nothing is
    // launched for zero work-items.
    template <typename... Arguments>
    void launch(Device& device, std::size_t globalSize, std::size_t localSize, Arguments&&... arguments)
    {
        if (device.failed() || globalSize == 0) return;
        cl_uint index = 0;
        (set(device, index++, arguments), ...);
        enqueue(device, globalSize, localSize);
    }

private:
    template <typename T>
    void set(Device& device, cl_uint index, const T& value)
    {
        const cl_int code = m_kernel.setArg(index, value);
        if (code != CL_SUCCESS) device.check(code, "clSetKernelArg " + std::to_string(index), m_name);
    }
    void enqueue(Device& device, std::size_t globalSize, std::size_t localSize);

    cl::Kernel m_kernel;
    std::string m_name;
};
}  // namespace drape
