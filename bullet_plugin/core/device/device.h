// An OpenCL device with its context and in-order queue.
//
// Errors are sticky: after the first failure every later call on the device is a no-op and error() says what failed,
// with which code and log. The pipeline checks once a step. A device belongs to one thread; several threads may open
// and close devices of their own (opencl_lock.h). The only folder that includes OpenCL headers is this one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "background_work.h"
#include "drape/error.h"
#include "drape/report.h"
#include "drape/settings.h"
#include "memory_ledger.h"
#include "opencl.h"
#include "profiler.h"

namespace drape
{
// Returns the devices that listDevices() lists. Throws if memory runs out.
std::vector<DeviceInfo> deviceInfos();

class Device
{
public:
    // Opens the index-th device of deviceInfos(). Returns null, with error filled, if the context or queue cannot be
    // created. profiled: the queue measures every launch's time, see profiler.h. stop: counts as a failure once it is
    // true, so that work on the device ends soon; null for never.
    static std::unique_ptr<Device> open(std::size_t index, Error& error, bool profiled = false,
                                        const StopFlag& stop = nullptr);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return m_info; }
    bool isGpu() const { return m_info.m_isGpu; }
    bool failed() const { return m_error.failed() || (m_stop && *m_stop); }
    const Error& error() const { return m_error; }

    // Records a failure when code is not CL_SUCCESS. Returns whether the device is still good.
    bool check(cl_int code, const std::string& call, const std::string& detail = std::string()) noexcept;

    cl::Context& context() { return m_context; }
    cl::CommandQueue& queue() { return m_queue; }
    cl::Device& handle() { return m_device; }
    MemoryLedger& memory() { return m_memory; }
    // Null unless the device was opened profiled.
    Profiler* profiler() { return m_profiler.get(); }

    // Starts the work enqueued so far; does not wait.
    void flush();
    // Waits for all work enqueued so far.
    void wait();
    // Returns the number of calls of wait().
    std::size_t waits() const { return m_waits; }

    // Number of buffers made so far: while it is unchanged, a handle stands for the same buffer.
    std::size_t bufferCount() const { return m_bufferCount; }
    void countBuffer() { ++m_bufferCount; }

    std::size_t maxAllocationBytes() const { return m_maxAllocationBytes; }
    std::size_t computeUnits() const { return m_computeUnits; }

private:
    Device() = default;

    DeviceInfo m_info;
    cl::Device m_device;
    cl::Context m_context;
    cl::CommandQueue m_queue;
    std::size_t m_maxAllocationBytes = 0;
    std::size_t m_bufferCount = 0;
    std::size_t m_computeUnits = 1;
    std::size_t m_waits = 0;
    std::unique_ptr<Profiler> m_profiler;
    MemoryLedger m_memory;
    StopFlag m_stop;
    Error m_error;
};

// Waits for the device in its destructor. Declared after the memory that a scope transfers from or to, it keeps that
// memory alive until then, however the scope ends.
class WaitAtEnd
{
public:
    explicit WaitAtEnd(Device& device) : m_device(device) {}
    ~WaitAtEnd() { m_device.wait(); }
    WaitAtEnd(const WaitAtEnd&) = delete;
    WaitAtEnd& operator=(const WaitAtEnd&) = delete;

private:
    Device& m_device;
};
}  // namespace drape
