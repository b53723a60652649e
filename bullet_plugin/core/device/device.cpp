#include "device.h"

#include "bullet_plugin/core/public_call.h"
#include "opencl_lock.h"

namespace drape
{
namespace
{
struct FoundDevice
{
    cl::Device m_device;
    DeviceInfo m_info;
};

void appendDevices(const cl::Platform& platform, std::vector<FoundDevice>& found)
{
    std::vector<cl::Device> devices;
    if (platform.getDevices(CL_DEVICE_TYPE_ALL, &devices) != CL_SUCCESS) return;
    for (const cl::Device& device : devices)
    {
        if (!device.getInfo<CL_DEVICE_AVAILABLE>() || !device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) continue;
        if (!device.getInfo<CL_DEVICE_ENDIAN_LITTLE>()) continue;
        FoundDevice entry;
        entry.m_device = device;
        entry.m_info.m_platform = platform.getInfo<CL_PLATFORM_NAME>();
        entry.m_info.m_name = device.getInfo<CL_DEVICE_NAME>();
        entry.m_info.m_driver = device.getInfo<CL_DRIVER_VERSION>();
        entry.m_info.m_isGpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
        found.push_back(entry);
    }
}

// GPUs first, otherwise in the loader's order.
std::vector<FoundDevice> findDevices()
{
    const OpenClLock lock;
    std::vector<cl::Platform> platforms;
    std::vector<FoundDevice> all, sorted;
    if (cl::Platform::get(&platforms) != CL_SUCCESS) return sorted;
    for (const cl::Platform& platform : platforms)
        appendDevices(platform, all);
    for (int wantGpu = 1; wantGpu >= 0; --wantGpu)
    {
        for (const FoundDevice& entry : all)
        {
            if (entry.m_info.m_isGpu == (wantGpu == 1)) sorted.push_back(entry);
        }
    }
    return sorted;
}
}  // namespace

std::vector<DeviceInfo> deviceInfos()
{
    const OpenClLock lock;  // until the devices found are released
    std::vector<DeviceInfo> infos;
    for (const FoundDevice& entry : findDevices())
        infos.push_back(entry.m_info);
    return infos;
}

std::vector<DeviceInfo> listDevices()
{
    return guardedOr(std::vector<DeviceInfo>(), [] { return deviceInfos(); });
}

std::unique_ptr<Device> Device::open(std::size_t index, Error& error, bool profiled)
{
    const OpenClLock lock;
    const std::vector<FoundDevice> found = findDevices();
    if (index >= found.size())
    {
        error.m_call = "the OpenCL device is gone";
        return nullptr;
    }
    std::unique_ptr<Device> device(new Device);
    device->m_info = found[index].m_info;
    device->m_device = found[index].m_device;
    cl_int code = CL_SUCCESS;
    device->m_context = cl::Context(device->m_device, nullptr, nullptr, nullptr, &code);
    if (device->check(code, "clCreateContext"))
    {
        const cl_command_queue_properties properties = profiled ? CL_QUEUE_PROFILING_ENABLE : 0;
        device->m_queue = cl::CommandQueue(device->m_context, device->m_device, properties, &code);
        if (profiled) device->m_profiler.reset(new Profiler);
        device->check(code, "clCreateCommandQueue");
    }
    if (device->failed())
    {
        error = device->error();
        return nullptr;
    }
    device->m_maxAllocationBytes = device->m_device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    device->m_computeUnits = device->m_device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    return device;
}

Device::~Device()
{
    const OpenClLock lock;
    m_queue = cl::CommandQueue();
    m_context = cl::Context();
    m_device = cl::Device();
}

bool Device::check(cl_int code, const std::string& call, const std::string& detail) noexcept
{
    if (code == CL_SUCCESS || m_error.failed()) return !m_error.failed();
    try
    {
        m_error.m_detail = detail;
        m_error.m_call = call + " failed with OpenCL code " + std::to_string(code) + " on " + m_info.m_name;
    }
    catch (const std::bad_alloc&)
    {
        m_error.m_call = "OpenCL failed";  // short enough to take no memory
    }
    return false;
}

void Device::flush()
{
    if (!failed()) check(m_queue.flush(), "clFlush");
}

void Device::wait()
{
    if (m_queue() == nullptr) return;
    check(m_queue.finish(), "clFinish");  // after a failure, too: transfers from before it may be under way
}
}  // namespace drape
