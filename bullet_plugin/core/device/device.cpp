#include "device.h"

#include <algorithm>

#include "bullet_plugin/core/public_call.h"
#include "missing_device.h"
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

// The result of a search for devices.
struct DeviceSearch
{
    std::vector<FoundDevice> m_found;  // GPUs first, otherwise in the loader's order
    std::string m_refused;             // platforms without a device and unusable devices, with the reasons
    bool m_poclWithoutDevice = false;
};

const char* whyRefused(const cl::Device& device)
{
    if (!device.getInfo<CL_DEVICE_AVAILABLE>()) return "is not available";
    if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>()) return "has no compiler";
    return device.getInfo<CL_DEVICE_ENDIAN_LITTLE>() ? nullptr : "is not little-endian";
}

void addDevices(const cl::Platform& platform, DeviceSearch& search)
{
    const auto refuse = [&](const std::string& name, const std::string& why)
    { search.m_refused += (search.m_refused.empty() ? "" : ", ") + name + " " + why; };
    const std::string platformName = platform.getInfo<CL_PLATFORM_NAME>();
    std::vector<cl::Device> devices;
    const cl_int code = platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    if (code != CL_SUCCESS || devices.empty())
    {
        refuse(platformName, "shows no device (OpenCL code " + std::to_string(code) + ")");
        search.m_poclWithoutDevice = search.m_poclWithoutDevice || platformName == kPoclPlatform;
        return;
    }
    for (const cl::Device& device : devices)
    {
        FoundDevice entry;
        entry.m_device = device;
        entry.m_info.m_platform = platformName;
        entry.m_info.m_name = device.getInfo<CL_DEVICE_NAME>();
        entry.m_info.m_driver = device.getInfo<CL_DRIVER_VERSION>();
        entry.m_info.m_isGpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
        if (const char* const why = whyRefused(device))
            refuse(entry.m_info.m_name, why);
        else
            search.m_found.push_back(entry);
    }
}

DeviceSearch findDevices()
{
    const OpenClLock lock;
    std::vector<cl::Platform> platforms;
    DeviceSearch search;
    const cl_int code = cl::Platform::get(&platforms);
    endOpenClAtExit();
    if (code != CL_SUCCESS) return search;
    for (const cl::Platform& platform : platforms)
        addDevices(platform, search);
    std::stable_partition(search.m_found.begin(), search.m_found.end(),
                          [](const FoundDevice& entry) { return entry.m_info.m_isGpu; });
    return search;
}
}  // namespace

std::vector<DeviceInfo> deviceInfos(std::string& whyNone)
{
    const OpenClLock lock;  // until the devices found are released
    const DeviceSearch search = findDevices();
    std::vector<DeviceInfo> infos;
    for (const FoundDevice& entry : search.m_found)
        infos.push_back(entry.m_info);
    if (infos.empty()) whyNone = whyNoDeviceFound(search.m_refused, search.m_poclWithoutDevice);
    return infos;
}

std::vector<DeviceInfo> deviceInfos()
{
    std::string ignored;
    return deviceInfos(ignored);
}

std::vector<DeviceInfo> listDevices()
{
    return guardedOr(std::vector<DeviceInfo>(), [] { return deviceInfos(); });
}

std::unique_ptr<Device> Device::open(std::size_t index, Error& error, bool profiled, const StopFlag& stop)
{
    const OpenClLock lock;
    const DeviceSearch search = findDevices();
    const std::vector<FoundDevice>& found = search.m_found;
    if (index >= found.size())
    {
        error.m_call = "the OpenCL device is no longer found";
        if (found.empty()) error.m_detail = whyNoDeviceFound(search.m_refused, search.m_poclWithoutDevice);
        return nullptr;
    }
    std::unique_ptr<Device> device(new Device);
    device->m_stop = stop;
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
    ++m_waits;
    check(m_queue.finish(), "clFinish");  // after a failure, too: transfers from before it may be under way
}
}  // namespace drape
