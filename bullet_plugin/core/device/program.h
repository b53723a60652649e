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

// The texts of kernels/<file>, one behind the other, with every include replaced by the included text once. Texts of
// kernels/lib/any_width are included as often as they are named. Line directives keep each line's own file and number,
// so a compiler's message names the .cl or .h file. Empty when a file is not embedded.
std::string assembleSources(const std::vector<std::string>& paths, const KernelTexts& others = {});
inline std::string assembleSource(const std::string& path)
{
    return assembleSources({path});
}

// Returns a compiler's log in which files and lines of the kernels replace every "<kernel>:line" of the assembled
// source. Drivers write such lines if they ignore line directives.
std::string translateLog(const std::string& log, const std::string& source);

struct ProgramBuild
{
    bool m_fromCache = false;
};

// Returns whether the platform caches its own compilations. PoCL does: a kernel for each group size that it was
// launched with. A request for a binary makes PoCL compile every kernel again for groups of any size. No launch needs
// that, and it takes twice as long as everything else.
bool keepsItsOwn(const DeviceInfo& device);

// Builds "kernels/<name>.cl" of all the names as one program, with contraction off and correctly rounded ÷ and √;
// DRAPE_CPU is defined unless the device is a GPU. A failed build stores the files and the whole log in the device's
// error. Built programs are kept in cacheFolder, unless the platform keeps its own (empty: the user's cache; "none": no
// cache). A problem with the cache causes a build, never a failure. defines: lines of text before the source.
cl::Program buildJoinedProgram(Device& device, const std::vector<std::string>& names, const std::string& cacheFolder,
                               ProgramBuild& build, const std::string& defines = std::string(),
                               const KernelTexts& texts = {});
inline cl::Program buildProgram(Device& device, const std::string& name, const std::string& cacheFolder,
                                ProgramBuild& build, const std::string& defines = std::string(),
                                const KernelTexts& texts = {})
{
    return buildJoinedProgram(device, {name}, cacheFolder, build, defines, texts);
}

// Returns the program that contains "kernels/<name>.cl", alone or with other files; for stages that need several.
using ProgramLoader = std::function<cl::Program(const char* name)>;

// Builds a source text unchanged. what: its name in an error. options: null for those of all kernels.
cl::Program compileSource(Device& device, const std::string& what, const std::string& source,
                          const char* options = nullptr);

// A kernel with its name, for messages. Launches are enqueued; nothing waits.
class Kernel
{
public:
    void create(Device& device, const cl::Program& program, const char* name);

    // Sets all arguments in order and enqueues globalSize work-items, rounded up to groups of localSize. Launches
    // nothing for zero work-items.
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
    // Sets an argument unless it already has the value: a launch has a dozen, and few change from step to step.
    template <typename T>
    void set(Device& device, cl_uint index, const T& value)
    {
        if (isSet(index, identity(value))) return;
        const cl_int code = m_kernel.setArg(index, value);
        if (code != CL_SUCCESS) device.check(code, "clSetKernelArg " + std::to_string(index), m_name);
    }
    // Identifies an argument's value: its bytes, or those of a buffer's handle or of a local size.
    using Identity = std::string;
    static Identity identity(const cl::Buffer& value) { return bytesOf(value()); }
    static Identity identity(const cl::LocalSpaceArg& value) { return bytesOf(value.size_); }
    template <typename T>
    static Identity identity(const T& value)
    {
        return bytesOf(value);
    }
    template <typename T>
    static Identity bytesOf(const T& value)
    {
        static_assert(std::is_trivially_copyable<T>::value);
        return Identity(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    // Returns whether the argument has the value; if not, records it as the current value.
    bool isSet(cl_uint index, const Identity& value);
    // A new buffer may get the handle of a released one.
    void forgetOldBuffers(const Device& device);
    void enqueue(Device& device, std::size_t globalSize, std::size_t localSize);

    std::vector<std::pair<bool, Identity>> m_arguments;
    std::size_t m_bufferCount = 0;

    cl::Kernel m_kernel;
    std::string m_name;
};
}  // namespace drape
