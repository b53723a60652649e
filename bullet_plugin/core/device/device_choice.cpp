#include "device_choice.h"

#include <limits>
#include <locale>
#include <sstream>

#include "bullet_plugin/core/public_call.h"
#include "device.h"
#include "driver_files.h"
#include "environment.h"
#include "missing_device.h"

namespace drape
{
namespace
{
std::string describe(const DeviceInfo& info)
{
    return info.m_name + " (" + info.m_platform + (info.m_isGpu ? ", GPU)" : ")");
}

// The device's name that a setting or the variable gives, and which of them.
struct WantedName
{
    explicit WantedName(const Settings& settings)
    {
        const std::string ofVariable = variable("DRAPE_DEVICE");
        const bool fromVariable = settings.m_device.empty() && !ofVariable.empty();
        m_name = fromVariable ? ofVariable : settings.m_device;
        m_origin = fromVariable ? "DRAPE_DEVICE" : "the name";
    }

    bool isHost() const { return lowered(m_name) == "host"; }

    std::string m_name, m_origin;
};

std::string listing(const std::vector<DeviceInfo>& devices)
{
    std::string text = "devices there are: host";
    for (const DeviceInfo& info : devices)
        text += ", " + describe(info);
    return text;
}

// whyNone: the reason if there is no device.
DeviceChoice chooseByName(const std::vector<DeviceInfo>& devices, const WantedName& name, const std::string& whyNone,
                          Error& error)
{
    const std::string &wanted = name.m_name, &origin = name.m_origin;
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

bool decidesByCost(const Settings& settings)
{
    const bool mayBeEither = settings.m_backend == Backend::Auto || settings.m_backend == Backend::ByCost;
    return mayBeEither && WantedName(settings).m_name.empty();
}

std::string whyNoDriver(const Settings& settings)
{
    if (settings.m_backend == Backend::Auto) return whyNoGpu();
    if (!kHasOpenCl) return kNoOpenClBuild;
    const DriverFiles drivers = findDriverFiles();
    return drivers.m_libraries.empty() && !drivers.m_mayHaveOthers ? "no OpenCL driver is installed" : "";
}

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
                         chooseDevice(settings, error);
                         if (decidesByCost(settings)) wantedCrossover(settings, pairs, error);
                         return error.failed() ? error.m_call + "; " + error.m_detail : std::string();
                     });
}

DeviceChoice chooseDevice(const Settings& settings, Error& error)
{
    DeviceChoice choice;
    const WantedName wanted(settings);
    if (settings.m_backend == Backend::OpenCl && wanted.isHost())
    {
        error.m_call =
            "an OpenCL device was requested, but the host by " + wanted.m_origin + " \"" + wanted.m_name + "\"";
        error.m_detail = listing(deviceInfos());
        return choice;
    }
    if (settings.m_backend == Backend::Host || wanted.isHost())
    {
        choice.m_reason =
            settings.m_backend == Backend::Host ? "the host back end was requested" : "requested by " + wanted.m_origin;
        return choice;
    }
    choice.m_byCost = decidesByCost(settings);
    if (choice.m_byCost) choice.m_reason = whyNoDriver(settings);
    if (!choice.m_reason.empty()) return choice;
    std::string whyNone;
    const std::vector<DeviceInfo> devices = deviceInfos(whyNone);
    if (!wanted.m_name.empty()) return chooseByName(devices, wanted, whyNone, error);
    if (settings.m_backend == Backend::Auto && !devices.empty() && !devices[0].m_isGpu)
    {
        choice.m_reason = "no GPU was found; " + listing(devices);
        return choice;
    }
    if (devices.empty())
    {
        choice.m_reason = "no OpenCL device was found: " + whyNone;
        if (settings.m_backend == Backend::OpenCl)
        {
            error.m_call = "an OpenCL device was requested, but none was found";
            error.m_detail = whyNone;
            if (kHasOpenCl) error.m_detail += "; a driver for any CPU is PoCL (package pocl-opencl-icd)";
        }
        return choice;
    }
    choice.m_onHost = false;
    choice.m_device = devices[0];
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
