// Opens the device that settings select, builds its kernels, and finds the crossover where cost decides.
//
// Input: the settings. Output: the back end, or why there is none, and times for the report. Touches nothing else, so
// that it may run on any thread. Cost: milliseconds to seconds; the first start on a machine compiles the kernels and
// measures the crossover.
#pragma once

#include <memory>
#include <string>

#include "bullet_plugin/core/backends/device_backend.h"
#include "bullet_plugin/core/device/device_choice.h"

namespace drape
{
struct StartedDevice
{
    DeviceChoice m_wanted;
    std::unique_ptr<DeviceBackend> m_backend;  // null: the host computes
    double m_buildMs = 0;
    // The crossover and its origin, if cost decides.
    double m_crossover = 0;
    std::string m_crossoverSource;
    double m_measureMs = 0;
    std::string m_remark;  // why a device that works is not used, for Plugin::error(); else empty
    Error m_error;         // the device is missing or failed
};

// Waits for the kernels. stop: ends the start early, see Device::open(); its result is then of no use.
StartedDevice startDevice(const Settings& settings, const StopFlag& stop = nullptr);

// Opens a chosen device. Returns null, with error filled, if it cannot be opened or its kernels cannot be built.
std::unique_ptr<DeviceBackend> openBackend(const DeviceChoice& choice, const Settings& settings, Error& error,
                                           const StopFlag& stop = nullptr);
}  // namespace drape
