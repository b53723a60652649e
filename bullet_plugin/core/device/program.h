// Programs of the embedded kernels: source with includes resolved, built for a device or taken from the cache on disk.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "device.h"
#include "embedded_kernels.h"

namespace drape
{
// Kernels of another folder than the library's: their texts, which may include the library's, and where they are.
struct KernelTexts
{
    const char* m_folder = "kernels";
    const EmbeddedFile* m_files = nullptr;
    std::size_t m_count = 0;
};

// The texts of kernels/<file>, one behind the other, with every include replaced by the included text once. Line
// directives keep each line's own file and number, so a compiler's message names the .cl or .h file. Empty when a file
// is not embedded.
std::string assembleSources(const std::vector<std::string>& paths, const KernelTexts& others = {});
inline std::string assembleSource(const std::string& path)
{
    return assembleSources({path});
}

// A compiler's log with every "<kernel>:line", as drivers write that ignore line directives, replaced by the file and
// line of the kernels that this line of the assembled source came from.
std::string translateLog(const std::string& log, const std::string& source);

struct ProgramBuild
{
    bool m_fromCache = false;
};

// Whether the platform keeps what it has compiled itself. PoCL does, a kernel for each size of group that it was
// launched with. Asked for a binary it compiles every kernel once more, for groups of any size: that no launch needs,
// and it takes twice as long as all the rest.
bool keepsItsOwn(const DeviceInfo& device);

// Builds "kernels/<name>.cl" of all the names as one program, with contraction off and correctly rounded ÷ and √;
// DRAPE_CPU is defined unless the device is a GPU. A failed build puts the files and the whole log into the device's
// error. What was built is kept in cacheFolder, unless the platform keeps its own (empty: the user's cache; "none": no
// cache); cache trouble means a build, never a failure. defines: lines of text put before the source. texts: names
// are those of its folder's files.
cl::Program buildJoinedProgram(Device& device, const std::vector<std::string>& names, const std::string& cacheFolder,
                               ProgramBuild& build, const std::string& defines = std::string(),
                               const KernelTexts& texts = {});
inline cl::Program buildProgram(Device& device, const std::string& name, const std::string& cacheFolder,
                                ProgramBuild& build, const std::string& defines = std::string(),
                                const KernelTexts& texts = {})
{
    return buildJoinedProgram(device, {name}, cacheFolder, build, defines, texts);
}

// Gives the program of "kernels/<name>.cl", alone or with others, to a stage that needs several.
using ProgramLoader = std::function<cl::Program(const char* name)>;

// Builds a source text as given. what: names it in an error.
cl::Program compileSource(Device& device, const std::string& what, const std::string& source);

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
        forgetOldBuffers(device);
        cl_uint index = 0;
        (set(device, index++, arguments), ...);
        enqueue(device, globalSize, localSize);
    }

private:
    // Sets an argument unless it has the value already: a launch has a dozen, of which few change from step to step.
    template <typename T>
    void set(Device& device, cl_uint index, const T& value)
    {
        if (isSet(index, identity(value))) return;
        const cl_int code = m_kernel.setArg(index, value);
        if (code != CL_SUCCESS) device.check(code, "clSetKernelArg " + std::to_string(index), m_name);
    }
    // What tells an argument's values apart, as far as they are set here.
    using Identity = std::uint64_t;
    static Identity identity(const cl::Buffer& value) { return reinterpret_cast<Identity>(value()); }
    static Identity identity(const cl::LocalSpaceArg& value) { return value.size_; }
    template <typename T>
    static Identity identity(const T& value)
    {
        static_assert(std::is_trivially_copyable<T>::value && sizeof(T) <= sizeof(Identity));
        Identity result = 0;
        std::memcpy(&result, &value, sizeof(T));
        return result;
    }
    // Whether the argument has the value; if not, it counts as having it from now on.
    bool isSet(cl_uint index, Identity value);
    // A new buffer may have the handle of one that is gone.
    void forgetOldBuffers(const Device& device);
    void enqueue(Device& device, std::size_t globalSize, std::size_t localSize);

    std::vector<std::pair<bool, Identity>> m_arguments;
    std::size_t m_bufferCount = 0;

    cl::Kernel m_kernel;
    std::string m_name;
};
}  // namespace drape
