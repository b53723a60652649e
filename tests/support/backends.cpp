#include "tests/support/backends.h"

#include <ostream>

#include "tests/support/environment.h"

namespace drape::test
{
std::vector<BackendCase> openClBackends()
{
    std::vector<BackendCase> cases;
    const std::vector<DeviceInfo> devices = listDevices();
    for (std::size_t i = 0; i < devices.size(); ++i)
    {
        BackendCase backend;
        backend.m_name = i == 0 ? "opencl" : "opencl" + std::to_string(i);
        backend.m_settings.m_backend = Backend::OpenCl;
        backend.m_settings.m_device = devices[i].m_name;
        backend.m_device = int(i);
        cases.push_back(backend);
    }
    if (cases.empty())
    {
        BackendCase missing;
        missing.m_name = "opencl";
        missing.m_missing = true;
        cases.push_back(missing);
    }
    return cases;
}

std::vector<BackendCase> allBackends()
{
    BackendCase host;
    host.m_name = "host";
    host.m_settings.m_backend = Backend::Host;
    std::vector<BackendCase> cases = {host};
    for (const BackendCase& backend : openClBackends())
        cases.push_back(backend);
    return cases;
}

Settings settingsFor(SolverPlace place)
{
    Settings settings;
    settings.m_solverPlace = place;
    settings.m_backend = place == SolverPlace::Device && isDeviceExpected() ? Backend::OpenCl : Backend::Host;
    return settings;
}

std::string backendName(const testing::TestParamInfo<BackendCase>& info)
{
    return info.param.m_name;
}

void PrintTo(const BackendCase& backend, std::ostream* stream)
{
    *stream << backend.m_name;
}

void requireBackend(const BackendCase& backend)
{
    if (!backend.m_missing) return;
    if (!isDeviceExpected()) GTEST_SKIP() << "no OpenCL device, as DRAPE_TEST_NO_DEVICE says";
    GTEST_FAIL() << "no OpenCL device was found (Debian: pocl-opencl-icd); DRAPE_TEST_NO_DEVICE=1 skips this test";
}

void BackendTest::SetUp()
{
    requireBackend(GetParam());
}

void DeviceTest::SetUp()
{
    BackendTest::SetUp();
    if (HasFatalFailure() || IsSkipped()) return;
    m_device = openDevice(GetParam());
    ASSERT_TRUE(m_device);
}

std::unique_ptr<Pipeline> makePipeline(const Settings& settings)
{
    Error error;
    std::unique_ptr<Pipeline> pipeline = Pipeline::create(settings, error);
    if (!pipeline) ADD_FAILURE() << error.text();
    if (pipeline) pipeline->endStart();
    return pipeline;
}

std::unique_ptr<Device> openDevice(const BackendCase& backend, bool profiled)
{
    Error error;
    std::unique_ptr<Device> device = Device::open(std::size_t(backend.m_device), error, profiled);
    if (!device) ADD_FAILURE() << error.text();
    return device;
}
}  // namespace drape::test
