// Messages on a machine without an OpenCL device state facts about the machine, not guesses.
#include "bullet_plugin/core/device/missing_device.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "drape/settings.h"
#include "tests/support/environment.h"
#include "tests/support/own_process.h"

namespace drape::test
{
namespace
{
Settings openClSettings()
{
    Settings settings;
    settings.m_backend = Backend::OpenCl;
    return settings;
}

void expectReason(const std::string& wanted, const std::string& unwanted)
{
    const std::string why = whyNoDevice(openClSettings());
    EXPECT_NE(why.find(wanted), std::string::npos) << why;
    EXPECT_EQ(why.find(unwanted), std::string::npos) << why;
}
}  // namespace

TEST(MissingDevice, NoDescriptorsIsNotTheCache)
{
    if (!isDeviceExpected()) GTEST_SKIP() << "the loader is told to find no driver";
    inOwnProcess(
        []
        {
            const int next = open("/dev/null", O_RDONLY);
            const rlimit few = {rlim_t(next) + 1, rlim_t(next) + 1};
            ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
            expectReason("can open 0 files more", "cache");
        });
}

TEST(MissingDevice, NoDriverIsNotTheCache)
{
    inOwnProcess(
        []
        {
            const ScopedVariable vendors("OCL_ICD_VENDORS", "/nonexistent");
            // Some vendors' loaders do not read the variable.
            if (listDevices().empty()) expectReason("finds no driver in OCL_ICD_VENDORS, /nonexistent", "cache folder");
        });
}

TEST(MissingDevice, ACacheThatCannotBeWrittenIsNamed)
{
    inOwnProcess(
        []
        {
            const ScopedVariable own("POCL_CACHE_DIR", nullptr), cache("XDG_CACHE_HOME", "/dev/null/cache");
            const std::string why = whyNoDevice(openClSettings());
            // There is nothing to report on a machine with other devices, or without PoCL.
            if (why.find(kPoclPlatform) != std::string::npos)
            {
                EXPECT_NE(why.find("cannot be written: /dev/null/cache/pocl"), std::string::npos) << why;
            }
        });
}

TEST(MissingDevice, AFolderThatIsYetToBeMadeCanBeWritten)
{
    const TemporaryFolder folder;
    EXPECT_TRUE(canBeWritten(folder.path()));
    EXPECT_TRUE(canBeWritten(folder.path() + "/a/b"));
    EXPECT_FALSE(canBeWritten("/dev/null"));
    EXPECT_FALSE(canBeWritten("/dev/null/a"));
}

TEST(MissingDevice, DescriptorsAreGivenBack)
{
    const int before = descriptorsLeft();
    EXPECT_EQ(before, kEnoughDescriptors);
    EXPECT_EQ(descriptorsLeft(), before);
}
}  // namespace drape::test
