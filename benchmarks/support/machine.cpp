#include "benchmarks/support/machine.h"

#include <ctime>
#include <fstream>
#include <thread>

namespace drape::bench
{
namespace
{
std::string processorName()
{
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
    {
        if (line.compare(0, 10, "model name") != 0) continue;
        const std::size_t colon = line.find(": ");
        if (colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}
}  // namespace

Row describeMachine(const std::string& commit)
{
    char date[32];
    const std::time_t now = std::time(nullptr);
    std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
    Row machine;
    machine["date"] = date;
    machine["commit"] = commit;
    machine["processor"] = processorName();
    machine["cores"] = std::thread::hardware_concurrency();
    Row devices = Row::array();
    for (const DeviceInfo& device : listDevices())
    {
        Row entry;
        fillDevice(entry, device);
        devices.push_back(entry);
    }
    machine["devices"] = devices;
    return machine;
}

void fillDevice(Row& row, const DeviceInfo& device)
{
    row["device"] = device.m_name;
    row["driver"] = device.m_driver;
}
}  // namespace drape::bench
