#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iostream>

#include <drape/drape.h>

#include "examples/cloth_drop/drop_world.h"
#include "examples/cloth_drop/node_positions.h"
#include "examples/cloth_drop/simulation.h"

namespace drape
{
namespace
{
class DrapeSimulation : public Simulation
{
public:
    DrapeSimulation(const DropScene& scene, const Settings& settings)
        : m_plugin(std::make_unique<Plugin>(settings)),
          m_world(std::make_unique<CollisionConfiguration>(*m_plugin), std::make_unique<SoftBodySolver>(*m_plugin)),
          m_dt(scene.m_dt)
    {
        m_world.addMeshObstacle(scene);
        m_world.addCloth(scene, false);
    }

    const Plugin& plugin() const { return *m_plugin; }

    StepTimes step() override
    {
        StepTimes times;
        times.m_stepMs = m_world.step(m_dt);
        const StepStatistics& statistics = m_plugin->statistics();
        times.m_collisionMs = m_world.world().collisionMs() + statistics.collisionMs();
        times.m_contacts = statistics.m_contacts;
        m_status |= statistics.m_status;
        return times;
    }

    const std::vector<float>& positions() override { return copyPositions(m_world.cloth(), m_positions); }
    std::string backend() const override { return m_plugin->device().m_onHost ? "host" : "opencl"; }
    std::string device() const override { return m_plugin->device().m_device.m_name; }
    std::string deviceReason() const override { return m_plugin->device().m_reason; }
    double prepareMs() const override { return m_plugin->device().m_buildMs; }
    std::string trouble() const override
    {
        if (m_status & kStepDeviceFailed)
            return "the device failed during the run; the host took over: " + m_plugin->error();
        if (m_status & kStepClothsLeftOut)
            return "more candidates or contacts than a step may have; such steps left the cloth out";
        if (m_status & kStepContactLimit) return "a buffer reached the device's limit; such steps ran on the host";
        return "";
    }

private:
    std::unique_ptr<Plugin> m_plugin;  // before the world: it must outlive the configuration's users
    DropWorld m_world;
    double m_dt;
    std::uint32_t m_status = 0;
    std::vector<float> m_positions;
};

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

std::unique_ptr<Simulation> makeDrapeSimulation(const DropScene& scene, const Options& options, std::string& error,
                                                int& exitCode)
{
    Settings settings;
    settings.m_backend = options.m_backend == "host"     ? Backend::Host
                         : options.m_backend == "opencl" ? Backend::OpenCl
                                                         : Backend::Auto;
    settings.m_device = options.m_device;
    const char* environment = std::getenv("DRAPE_DEVICE");
    const std::string wanted = !options.m_device.empty() || environment == nullptr ? options.m_device : environment;
    exitCode = kExitBadInput;
    if (settings.m_backend == Backend::Host && !options.m_device.empty() && lowerCase(options.m_device) != "host")
        error = "--device " + options.m_device + " contradicts --backend host";
    else if (settings.m_backend != Backend::Host)
        error = deviceProblem(wanted, settings.m_backend == Backend::OpenCl);
    if (!error.empty()) return nullptr;
    auto simulation = std::make_unique<DrapeSimulation>(scene, settings);
    if (simulation->plugin().ready()) return simulation;
    exitCode = kExitFailed;
    error = simulation->plugin().error();
    return nullptr;
}

void printDevices()
{
    const std::vector<DeviceInfo> devices = listDevices();
    for (const DeviceInfo& device : devices)
        std::cout << describe(device) << "\n";
    if (devices.empty()) std::cout << "no OpenCL device; Drape would run on the host\n";
}
}  // namespace drape
