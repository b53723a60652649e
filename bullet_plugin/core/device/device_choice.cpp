#include "device_choice.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <limits>
#include <locale>
#include <sstream>

#include "bullet_plugin/core/public_call.h"
#include "device.h"
#include "missing_device.h"

namespace drape
{
namespace
{
std::string lowered(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::string describe(const DeviceInfo& info)
{
    return info.m_name + " (" + info.m_platform + (info.m_isGpu ? ", GPU)" : ")");
}

std::string listing(const std::vector<DeviceInfo>& devices)
{
    std::string text = "devices there are: host";
    for (const DeviceInfo& info : devices)
        text += ", " + describe(info);
    return text;
}

// whyNone: the reason if there is no device.
DeviceChoice chooseByName(const std::vector<DeviceInfo>& devices, const std::string& wanted, const std::string& origin,
                          const std::string& whyNone, Error& error)
{
    DeviceChoice choice;
    for (std::size_t i = 0; i < devices.size(); ++i)
    {
        std::string text = lowered(devices[i].m_name + " " + devices[i].m_platform);
        if (text.find("portable computing language") != std::string::npos) text += " pocl";
        if (text.find(lowered(wanted)) == std::string::npos) continue;
        choice.m_onHost = false;
        choice.m_index = i;
        choice.m_device = devices[i];
        choice.m_reason = "asked for by " + origin + " \"" + wanted + "\"";
        return choice;
    }
    error.m_call = "no OpenCL device matches " + origin + " \"" + wanted + "\"";
    error.m_detail = listing(devices);
    if (devices.empty()) error.m_detail += "; no OpenCL device was found: " + whyNone;
    return choice;
}
}  // namespace

std::string hostSince(const DeviceInfo& device, const Error& error)
{
    return "the host, since " + device.m_name + " failed: " + error.m_call;
}

std::string whyNoDevice(const Settings& settings)
{
    return guardedOr(std::string(kOutOfMemory),
                     [&]
                     {
                         Error error;
                         double pairs;
                         if (chooseDevice(settings, error).m_byCost) wantedCrossover(settings, pairs, error);
                         return error.failed() ? error.m_call + "; " + error.m_detail : std::string();
                     });
}

DeviceChoice chooseDevice(const Settings& settings, Error& error)
{
    DeviceChoice choice;
    const char* variable = std::getenv("DRAPE_DEVICE");
    const bool fromVariable = settings.m_device.empty() && variable && *variable;
    const std::string wanted = fromVariable ? variable : settings.m_device;
    const std::string origin = fromVariable ? "DRAPE_DEVICE" : "the name";
    if (settings.m_backend == Backend::OpenCl && lowered(wanted) == "host")
    {
        error.m_call = "an OpenCL device was requested, but the host by " + origin + " \"" + wanted + "\"";
        error.m_detail = listing(deviceInfos());
        return choice;
    }
    if (settings.m_backend == Backend::Host || lowered(wanted) == "host")
    {
        choice.m_reason =
            settings.m_backend == Backend::Host ? "the host back end was requested" : "requested by " + origin;
        return choice;
    }
    std::string whyNone;
    const std::vector<DeviceInfo> devices = deviceInfos(whyNone);
    if (!wanted.empty()) return chooseByName(devices, wanted, origin, whyNone, error);
    if (devices.empty())
    {
        choice.m_reason = "no OpenCL device was found: " + whyNone;
        if (settings.m_backend == Backend::OpenCl)
        {
            error.m_call = "an OpenCL device was requested, but none was found";
            error.m_detail = whyNone + "; a driver for any CPU is PoCL (package pocl-opencl-icd)";
        }
        return choice;
    }
    choice.m_onHost = false;
    choice.m_device = devices[0];
    choice.m_byCost = settings.m_backend == Backend::Auto;
    choice.m_reason = devices[0].m_isGpu ? "the first GPU" : "the first OpenCL device, no GPU found";
    return choice;
}

bool wantedCrossover(const Settings& settings, double& pairs, Error& error)
{
    pairs = settings.m_crossover;
    const char* const variable = std::getenv("DRAPE_CROSSOVER");
    if (pairs >= 0 || !variable || !*variable) return true;
    std::istringstream text(variable);
    text.imbue(std::locale::classic());  // whatever language the app speaks
    if (std::string(variable) == "inf")
        pairs = std::numeric_limits<double>::infinity();
    else if (!(text >> pairs && text.peek() == std::istringstream::traits_type::eof()))
        pairs = -1;
    if (pairs >= 0) return true;
    error.m_call = "DRAPE_CROSSOVER is \"" + std::string(variable) + "\"";
    error.m_detail = "it should be a number of pairs of triangles, 0 or more (inf: always the host)";
    return false;
}
}  // namespace drape
