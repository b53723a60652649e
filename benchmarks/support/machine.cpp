#include "benchmarks/support/machine.h"

#include <ctime>
#include <thread>

#include "bullet_plugin/core/platform/platform.h"

namespace drape::bench
{
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
