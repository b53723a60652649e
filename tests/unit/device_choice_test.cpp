// Resolves device settings and DRAPE_DEVICE, and checks the messages about them.
#include "bullet_plugin/core/device/device_choice.h"

#include <gtest/gtest.h>

#include "tests/support/backends.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
// Sets DRAPE_DEVICE for a scope.
struct DeviceVariable : ScopedVariable
{
    explicit DeviceVariable(const char* value) : ScopedVariable("DRAPE_DEVICE", value) {}
};

Settings named(const std::string& device)
{
    Settings settings;
    settings.m_device = device;
    return settings;
}
}  // namespace

TEST(DeviceChoice, HostByBackendOptionAndVariable)
{
    Error error;
    Settings host;
    host.m_backend = Backend::Host;
    EXPECT_TRUE(chooseDevice(host, error).m_onHost);
    EXPECT_FALSE(chooseDevice(host, error).m_reason.empty());
    EXPECT_TRUE(chooseDevice(named("Host"), error).m_onHost);
    const DeviceVariable variable("host");
    const DeviceChoice choice = chooseDevice(Settings(), error);
    EXPECT_TRUE(choice.m_onHost);
    EXPECT_NE(choice.m_reason.find("DRAPE_DEVICE"), std::string::npos) << choice.m_reason;
    EXPECT_FALSE(error.failed());
}

TEST(DeviceChoice, UnknownNameListsWhatThereIs)
{
    const DeviceVariable none(nullptr);
    Error error;
    chooseDevice(named("no such device"), error);
    ASSERT_TRUE(error.failed());
    EXPECT_NE(error.m_call.find("no such device"), std::string::npos);
    EXPECT_NE(error.m_detail.find("host"), std::string::npos);
    for (const DeviceInfo& info : listDevices())
        EXPECT_NE(error.m_detail.find(info.m_name), std::string::npos);

    Error fromPipeline;
    EXPECT_FALSE(Pipeline::create(named("no such device"), fromPipeline));
    EXPECT_EQ(fromPipeline.text(), error.text());
}

TEST(DeviceChoice, ADeviceByBackendAndTheHostByNameContradict)
{
    Settings settings = named("host");
    settings.m_backend = Backend::OpenCl;
    Error error;
    chooseDevice(settings, error);
    EXPECT_TRUE(error.failed());
    EXPECT_EQ(whyNoDevice(settings).rfind(error.m_call, 0), 0u) << whyNoDevice(settings);
    EXPECT_EQ(whyNoDevice(settings).find('\n'), std::string::npos);
    settings.m_backend = Backend::Auto;
    EXPECT_EQ(whyNoDevice(settings), "");
    settings.m_device.clear();
    settings.m_backend = Backend::OpenCl;
    const DeviceVariable variable("host");
    EXPECT_NE(whyNoDevice(settings).find("DRAPE_DEVICE"), std::string::npos) << whyNoDevice(settings);
}

TEST(DeviceChoice, ACrossoverThatIsNoNumberIsNamedWhereCostDecides)
{
    requireBackend(openClBackends().front());
    if (testing::Test::HasFatalFailure() || testing::Test::IsSkipped()) return;
    const DeviceVariable none(nullptr);
    const ScopedVariable crossover("DRAPE_CROSSOVER", "many");
    Settings settings;
    settings.m_backend = Backend::ByCost;
    Error error;
    ASSERT_TRUE(chooseDevice(settings, error).m_byCost);
    EXPECT_NE(whyNoDevice(settings).find("DRAPE_CROSSOVER is \"many\""), std::string::npos) << whyNoDevice(settings);
    EXPECT_EQ(whyNoDevice(settings).find('\n'), std::string::npos);
    settings.m_crossover = 5;
    EXPECT_EQ(whyNoDevice(settings), "");
    EXPECT_EQ(whyNoDevice(named("host")), "");
}

TEST(DeviceChoice, UnknownVariableIsNamed)
{
    const DeviceVariable variable("no such device");
    Error error;
    chooseDevice(Settings(), error);
    EXPECT_NE(error.m_call.find("DRAPE_DEVICE"), std::string::npos) << error.m_call;
}

class DeviceChoiceTest : public BackendTest
{
};

TEST_P(DeviceChoiceTest, NameIsComparedWithoutCaseAndByPart)
{
    const DeviceVariable none(nullptr);
    const DeviceInfo info = listDevices()[std::size_t(GetParam().m_device)];
    std::string part = info.m_name.substr(0, info.m_name.size() - 1);
    for (char& letter : part)
        letter = char(std::toupper(static_cast<unsigned char>(letter)));
    Error error;
    const DeviceChoice choice = chooseDevice(named(part), error);
    EXPECT_FALSE(error.failed()) << error.text();
    EXPECT_FALSE(choice.m_onHost);
    EXPECT_FALSE(choice.m_byCost);
    EXPECT_EQ(listDevices()[choice.m_index].m_name, info.m_name);
    EXPECT_NE(choice.m_reason.find("name"), std::string::npos) << choice.m_reason;
}

TEST_P(DeviceChoiceTest, OptionWinsOverVariable)
{
    const DeviceVariable variable("no such device");
    Error error;
    EXPECT_FALSE(chooseDevice(GetParam().m_settings, error).m_onHost);
    EXPECT_FALSE(chooseDevice(GetParam().m_settings, error).m_byCost);
    EXPECT_FALSE(error.failed()) << error.text();
}

TEST_P(DeviceChoiceTest, TheAutomaticDeviceIsAGpu)
{
    const DeviceVariable none(nullptr);
    Error error;
    const DeviceChoice choice = chooseDevice(Settings(), error);
    EXPECT_FALSE(error.failed()) << error.text();
    EXPECT_EQ(choice.m_onHost, !listDevices()[0].m_isGpu) << choice.m_reason;
    EXPECT_FALSE(choice.m_reason.empty());
}

TEST_P(DeviceChoiceTest, CostDecidesAboutTheFirst)
{
    const DeviceVariable none(nullptr);
    Error error;
    Settings settings;
    settings.m_backend = Backend::ByCost;
    const DeviceChoice choice = chooseDevice(settings, error);
    EXPECT_FALSE(choice.m_onHost);
    EXPECT_EQ(choice.m_index, 0u);
    EXPECT_FALSE(choice.m_reason.empty());
    EXPECT_TRUE(choice.m_byCost);
}

TEST_P(DeviceChoiceTest, PipelineReportsItsDevice)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
    ASSERT_TRUE(pipeline);
    const DeviceReport& report = pipeline->deviceReport();
    EXPECT_FALSE(report.m_onHost);
    EXPECT_EQ(report.m_device.m_name, listDevices()[std::size_t(GetParam().m_device)].m_name);
    EXPECT_FALSE(report.m_reason.empty());
    EXPECT_GT(report.m_buildMs, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Devices, DeviceChoiceTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
