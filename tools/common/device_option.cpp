#include "tools/common/device_option.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iostream>

#include "drape/report.h"

namespace drape
{
namespace
{
std::string lowerCase(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::string describe(const DeviceInfo& device)
{
    return device.m_name + " (" + device.m_platform + ", driver " + device.m_driver + (device.m_isGpu ? ", GPU)" : ")");
}

// "" when a device with this text in its name is there, or the text asks for the host; else why not, with the list.
std::string deviceProblem(const std::string& text, bool demanded)
{
    if (!demanded && (text.empty() || lowerCase(text) == "host")) return "";
    const std::vector<DeviceInfo> devices = listDevices();
    for (const DeviceInfo& device : devices)
        if (lowerCase(device.m_name + "\n" + device.m_platform).find(lowerCase(text)) != std::string::npos) return "";
    if (devices.empty()) return "there is no OpenCL device on this machine";
    std::string list;
    for (const DeviceInfo& device : devices)
        list += (list.empty() ? "" : "; ") + describe(device);
    return "unknown device '" + text + "'; there are: " + list;
}
}  // namespace

bool deviceSettings(const std::string& backend, const std::string& device, Settings& settings, std::string& error)
{
    settings.m_backend = backend == "host" ? Backend::Host : backend == "opencl" ? Backend::OpenCl : Backend::Auto;
    settings.m_device = device;
    const char* environment = std::getenv("DRAPE_DEVICE");
    const std::string wanted = !device.empty() || environment == nullptr ? device : environment;
    if (settings.m_backend == Backend::Host && !device.empty() && lowerCase(device) != "host")
        error = "--device " + device + " contradicts --backend host";
    else if (settings.m_backend != Backend::Host)
        error = deviceProblem(wanted, settings.m_backend == Backend::OpenCl);
    return error.empty();
}

void printDevices()
{
    const std::vector<DeviceInfo> devices = listDevices();
    for (const DeviceInfo& device : devices)
        std::cout << describe(device) << "\n";
    if (devices.empty()) std::cout << "no OpenCL device; Drape would run on the host\n";
}
}  // namespace drape
