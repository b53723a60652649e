// Stands in for OpenCL's headers in a build without them (DRAPE_OPENCL=OFF): code for devices compiles, there is no
// platform, and so none of it runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace drape
{
constexpr bool kHasOpenCl = false;

inline bool hasOpenClLoader() noexcept
{
    return false;
}
inline void endOpenClAtExit() noexcept {}

// The name of a value that OpenCL would report, with the value's type.
template <typename Value>
struct OpenClValue
{
    using Type = Value;
};
}  // namespace drape

using cl_int = std::int32_t;
using cl_uint = std::uint32_t;
using cl_ulong = std::uint64_t;
using cl_command_queue_properties = cl_ulong;

constexpr cl_int CL_SUCCESS = 0, CL_INVALID_BUFFER_SIZE = -61;
constexpr cl_uint CL_FALSE = 0, CL_TRUE = 1;
constexpr cl_uint CL_UINT_MAX = UINT32_MAX;
// Bits, as in CL/cl.h.
constexpr cl_ulong CL_MEM_READ_WRITE = 1, CL_MEM_ALLOC_HOST_PTR = 16, CL_MAP_READ = 1, CL_MAP_WRITE = 2,
                   CL_QUEUE_PROFILING_ENABLE = 2, CL_DEVICE_TYPE_GPU = 4, CL_DEVICE_TYPE_ALL = UINT32_MAX;

inline constexpr drape::OpenClValue<bool> CL_DEVICE_AVAILABLE, CL_DEVICE_COMPILER_AVAILABLE, CL_DEVICE_ENDIAN_LITTLE;
inline constexpr drape::OpenClValue<std::string> CL_PLATFORM_NAME, CL_DEVICE_NAME, CL_DRIVER_VERSION,
    CL_DEVICE_EXTENSIONS, CL_PROGRAM_BUILD_LOG;
inline constexpr drape::OpenClValue<std::size_t> CL_DEVICE_MAX_MEM_ALLOC_SIZE, CL_DEVICE_MAX_COMPUTE_UNITS;
inline constexpr drape::OpenClValue<cl_ulong> CL_DEVICE_TYPE, CL_PROFILING_COMMAND_START, CL_PROFILING_COMMAND_END;
inline constexpr drape::OpenClValue<std::vector<std::vector<unsigned char>>> CL_PROGRAM_BINARIES;

namespace cl
{
constexpr cl_int kNoPlatform = -1001;

// A member function that fails, whatever its arguments.
struct FailingCall
{
    template <typename... Arguments>
    cl_int operator()(const Arguments&...) const
    {
        return kNoPlatform;
    }
};

// Base of all objects. None of them stands for anything.
class Object
{
public:
    Object() = default;
    template <typename... Arguments>
    explicit Object(const Arguments&...)
    {
    }

    void* operator()() const { return nullptr; }
    template <const auto& Name>
    typename std::decay_t<decltype(Name)>::Type getInfo() const
    {
        return {};
    }
    template <typename... Arguments>
    cl_int getInfo(const Arguments&...) const
    {
        return kNoPlatform;
    }
};

class Device : public Object
{
};

class Platform : public Object
{
public:
    static cl_int get(std::vector<Platform>*) { return kNoPlatform; }
    FailingCall getDevices;
};

class Context : public Object
{
    using Object::Object;
};

class Event : public Object
{
public:
    FailingCall getProfilingInfo;
};

class Buffer : public Object
{
    using Object::Object;
};

class Program : public Object
{
public:
    using Object::Object;
    using Binaries = std::vector<std::vector<unsigned char>>;

    Program(const Context&, const std::vector<Device>&, const Binaries&, std::vector<cl_int>*, cl_int*) {}
    FailingCall build, getBuildInfo;
};

struct LocalSpaceArg
{
    std::size_t size_;
};

inline LocalSpaceArg Local(std::size_t bytes)
{
    return {bytes};
}

class Kernel : public Object
{
public:
    using Object::Object;

    FailingCall setArg;
};

struct NDRange
{
    explicit NDRange(std::size_t = 0) {}
};
inline const NDRange NullRange;

class CommandQueue : public Object
{
public:
    using Object::Object;

    FailingCall flush, finish;
    FailingCall enqueueCopyBuffer, enqueueFillBuffer, enqueueNDRangeKernel, enqueueReadBuffer, enqueueWriteBuffer,
        enqueueUnmapMemObject;
    template <typename... Arguments>
    void* enqueueMapBuffer(const Arguments&...) const
    {
        return nullptr;
    }
};
}  // namespace cl
