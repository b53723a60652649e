// OpenCL's functions, called through an ICD loader that is opened when the first of them is needed.
//
// No library or program of Drape links the loader. A process without one runs, and finds no device: functions then
// return kNoOpenClLoader or null. Include this header in place of <CL/opencl.hpp>. It gives each function that Drape
// uses a name of its own, so that an app's own calls of OpenCL stay what they are.
#pragma once

#if DRAPE_OPENCL

#include <CL/cl.h>

#include <atomic>
#include <type_traits>

namespace drape
{
constexpr bool kHasOpenCl = true;

// CL_PLATFORM_NOT_FOUND_KHR, which the loader returns without a driver.
constexpr cl_int kNoOpenClLoader = -1001;

// Returns the address of a function of the process's OpenCL loader: the one that the app has linked or preloaded, else
// kOpenClLoader (core/platform). Null if there is none.
void* openClFunction(const char* name) noexcept;
inline bool hasOpenClLoader() noexcept
{
    return openClFunction("clGetPlatformIDs") != nullptr;
}

// Ends the use of OpenCL when the process ends: every later call does nothing and returns success. Objects at namespace
// scope may outlive the drivers that they use. Call it when drivers have been loaded: exit() runs the last handler
// first, and so this one before it ends the drivers.
void endOpenClAtExit() noexcept;
bool isOpenClEnded() noexcept;

template <typename Signature>
struct OpenClCall;

template <typename Result, typename... Arguments>
struct OpenClCall<Result(Arguments...)>
{
    template <const char* Name>
    static Result call(Arguments... arguments)
    {
        using Function = Result (*)(Arguments...);
        static std::atomic<Function> known{nullptr};
        if (isOpenClEnded()) return Result();
        Function function = known.load(std::memory_order_relaxed);
        if (!function) known = function = reinterpret_cast<Function>(openClFunction(Name));
        if (function) return function(arguments...);
        if constexpr (std::is_same_v<Result, cl_int>)
            return kNoOpenClLoader;
        else
            return Result();
    }
};
}  // namespace drape

// At global scope, where the C++ bindings look for the functions.
#define DRAPE_OPENCL_CALL(name)                       \
    inline constexpr char drapeName_##name[] = #name; \
    inline constexpr auto& drape_##name = drape::OpenClCall<decltype(::name)>::call<drapeName_##name>;
DRAPE_OPENCL_CALL(clBuildProgram)
DRAPE_OPENCL_CALL(clCreateBuffer)
DRAPE_OPENCL_CALL(clCreateCommandQueue)
DRAPE_OPENCL_CALL(clCreateContext)
DRAPE_OPENCL_CALL(clCreateKernel)
DRAPE_OPENCL_CALL(clCreateProgramWithBinary)
DRAPE_OPENCL_CALL(clCreateProgramWithSource)
DRAPE_OPENCL_CALL(clEnqueueCopyBuffer)
DRAPE_OPENCL_CALL(clEnqueueFillBuffer)
DRAPE_OPENCL_CALL(clEnqueueMapBuffer)
DRAPE_OPENCL_CALL(clEnqueueNDRangeKernel)
DRAPE_OPENCL_CALL(clEnqueueReadBuffer)
DRAPE_OPENCL_CALL(clEnqueueUnmapMemObject)
DRAPE_OPENCL_CALL(clEnqueueWriteBuffer)
DRAPE_OPENCL_CALL(clFinish)
DRAPE_OPENCL_CALL(clFlush)
DRAPE_OPENCL_CALL(clGetDeviceIDs)
DRAPE_OPENCL_CALL(clGetDeviceInfo)
DRAPE_OPENCL_CALL(clGetEventProfilingInfo)
DRAPE_OPENCL_CALL(clGetPlatformIDs)
DRAPE_OPENCL_CALL(clGetPlatformInfo)
DRAPE_OPENCL_CALL(clGetProgramBuildInfo)
DRAPE_OPENCL_CALL(clGetProgramInfo)
DRAPE_OPENCL_CALL(clReleaseCommandQueue)
DRAPE_OPENCL_CALL(clReleaseContext)
DRAPE_OPENCL_CALL(clReleaseDevice)
DRAPE_OPENCL_CALL(clReleaseEvent)
DRAPE_OPENCL_CALL(clReleaseKernel)
DRAPE_OPENCL_CALL(clReleaseMemObject)
DRAPE_OPENCL_CALL(clReleaseProgram)
DRAPE_OPENCL_CALL(clRetainCommandQueue)
DRAPE_OPENCL_CALL(clRetainContext)
DRAPE_OPENCL_CALL(clRetainDevice)
DRAPE_OPENCL_CALL(clRetainEvent)
DRAPE_OPENCL_CALL(clRetainKernel)
DRAPE_OPENCL_CALL(clRetainMemObject)
DRAPE_OPENCL_CALL(clRetainProgram)
DRAPE_OPENCL_CALL(clSetKernelArg)
#undef DRAPE_OPENCL_CALL

#define clBuildProgram drape_clBuildProgram
#define clCreateBuffer drape_clCreateBuffer
#define clCreateCommandQueue drape_clCreateCommandQueue
#define clCreateContext drape_clCreateContext
#define clCreateKernel drape_clCreateKernel
#define clCreateProgramWithBinary drape_clCreateProgramWithBinary
#define clCreateProgramWithSource drape_clCreateProgramWithSource
#define clEnqueueCopyBuffer drape_clEnqueueCopyBuffer
#define clEnqueueFillBuffer drape_clEnqueueFillBuffer
#define clEnqueueMapBuffer drape_clEnqueueMapBuffer
#define clEnqueueNDRangeKernel drape_clEnqueueNDRangeKernel
#define clEnqueueReadBuffer drape_clEnqueueReadBuffer
#define clEnqueueUnmapMemObject drape_clEnqueueUnmapMemObject
#define clEnqueueWriteBuffer drape_clEnqueueWriteBuffer
#define clFinish drape_clFinish
#define clFlush drape_clFlush
#define clGetDeviceIDs drape_clGetDeviceIDs
#define clGetDeviceInfo drape_clGetDeviceInfo
#define clGetEventProfilingInfo drape_clGetEventProfilingInfo
#define clGetPlatformIDs drape_clGetPlatformIDs
#define clGetPlatformInfo drape_clGetPlatformInfo
#define clGetProgramBuildInfo drape_clGetProgramBuildInfo
#define clGetProgramInfo drape_clGetProgramInfo
#define clReleaseCommandQueue drape_clReleaseCommandQueue
#define clReleaseContext drape_clReleaseContext
#define clReleaseDevice drape_clReleaseDevice
#define clReleaseEvent drape_clReleaseEvent
#define clReleaseKernel drape_clReleaseKernel
#define clReleaseMemObject drape_clReleaseMemObject
#define clReleaseProgram drape_clReleaseProgram
#define clRetainCommandQueue drape_clRetainCommandQueue
#define clRetainContext drape_clRetainContext
#define clRetainDevice drape_clRetainDevice
#define clRetainEvent drape_clRetainEvent
#define clRetainKernel drape_clRetainKernel
#define clRetainMemObject drape_clRetainMemObject
#define clRetainProgram drape_clRetainProgram
#define clSetKernelArg drape_clSetKernelArg

#include <CL/opencl.hpp>

#else
#include "without_opencl.h"
#endif
