#include "tools/common/device_option.h"

#include <strings.h>

#include <iostream>

#include "drape/report.h"
#include "tools/common/program.h"

namespace drape
{
bool deviceSettings(const std::string& backend, const std::string& device, Settings& settings, std::string& error)
{
    settings.m_backend = backend == "host"     ? Backend::Host
                         : backend == "opencl" ? Backend::OpenCl
                         : backend == "cost"   ? Backend::ByCost
                                               : Backend::Auto;
    settings.m_device = device;
    if (settings.m_backend == Backend::Host && !device.empty() && strcasecmp(device.c_str(), "host") != 0)
        error = "--device " + device + " contradicts --backend host";
    else
        error = whyNoDevice(settings);
    return error.empty();
}

bool printDevices(std::string& error)
{
    const std::vector<DeviceInfo> devices = listDevices();
    for (const DeviceInfo& device : devices)
        std::cout << device.m_name << " (" << device.m_platform << ", driver " << device.m_driver
                  << (device.m_isGpu ? ", GPU)" : ")") << "\n";
    if (devices.empty()) std::cout << "no OpenCL device; Drape would run on the host\n";
    return flushOutput(error);
}
}  // namespace drape
