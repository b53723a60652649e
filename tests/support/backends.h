// The back ends that tests run on: the host and every OpenCL device of this machine.
//
// A machine without an OpenCL device fails the tests that need one, unless DRAPE_TEST_NO_DEVICE=1 says that none is
// expected: then they are skipped. Kernels are cached where XDG_CACHE_HOME says.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "bullet_plugin/core/device/device.h"
#include "bullet_plugin/core/pipeline/pipeline.h"

namespace drape::test
{
struct BackendCase
{
    std::string m_name;      // host, opencl, opencl1 …
    Settings m_settings;     // ask for exactly this back end
    int m_device = -1;       // index into listDevices(); -1: the host, or no device
    bool m_missing = false;  // an OpenCL device was expected and is not there
};

std::vector<BackendCase> openClBackends();  // at least one; perhaps missing
std::vector<BackendCase> allBackends();     // the host first

// Returns settings with which cloth is solved on the host alone, or on an OpenCL device if one is expected.
Settings settingsFor(SolverPlace place);

// Names the cases of INSTANTIATE_TEST_SUITE_P.
std::string backendName(const testing::TestParamInfo<BackendCase>& info);
void PrintTo(const BackendCase& backend, std::ostream* stream);

// Call this in SetUp(). Fails or skips the test if the back end is missing.
void requireBackend(const BackendCase& backend);

// A fixture whose parameter is a back end that is there.
class BackendTest : public testing::TestWithParam<BackendCase>
{
protected:
    void SetUp() override;
};

// A BackendTest with the device of an OpenCL back end open.
class DeviceTest : public BackendTest
{
protected:
    void SetUp() override;

    std::unique_ptr<Device> m_device;
};

// Returns null, with a failure recorded, if it cannot be made.
std::unique_ptr<Pipeline> makePipeline(const Settings& settings);
// Opens the device of an OpenCL back end. Returns null, with a failure recorded, if it cannot be opened. `profiled`:
// see Device::open().
std::unique_ptr<Device> openDevice(const BackendCase& backend, bool profiled = false);
}  // namespace drape::test
