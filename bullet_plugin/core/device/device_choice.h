// Chooses the device that settings and the environment name.
#pragma once

#include <cstddef>
#include <string>

#include "drape/error.h"
#include "drape/report.h"
#include "drape/settings.h"

namespace drape
{
// The device that settings (and DRAPE_DEVICE) select on this machine.
struct DeviceChoice
{
    bool m_onHost = true;
    bool m_byCost = false;    // no setting names this device: scenes that are too small for it run on the host
    std::size_t m_index = 0;  // into deviceInfos(), unless on the host
    DeviceInfo m_device;      // the selected device
    std::string m_reason;
};

// Returns whether cost decides between the host and a device: no setting and no variable names one.
bool decidesByCost(const Settings& settings);

// Returns the reason, in words, why the driver files of this machine offer no device to settings that let cost decide.
// Empty if they may offer one. Loads no driver.
std::string whyNoDriver(const Settings& settings);

// Returns the reason for the report after the host took over from a failed device.
std::string hostSince(const DeviceInfo& device, const Error& error);

// Fills error if the requested device is missing; its detail lists the devices found.
DeviceChoice chooseDevice(const Settings& settings, Error& error);

// Reads the crossover, in triangle pairs, from the settings or else from DRAPE_CROSSOVER; negative if neither sets
// it. Returns false, and fills error, if the variable is not a number from 0 on.
bool wantedCrossover(const Settings& settings, double& pairs, Error& error);
}  // namespace drape
