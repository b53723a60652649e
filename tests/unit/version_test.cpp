// The version header is the one source of the version.
#include "drape/version.h"

#include <string>

#include <gtest/gtest.h>

namespace drape::test
{
namespace
{
TEST(Version, StringIsMadeOfTheNumbers)
{
    const std::string numbers = std::to_string(DRAPE_VERSION_MAJOR) + "." + std::to_string(DRAPE_VERSION_MINOR) + "." +
                                std::to_string(DRAPE_VERSION_PATCH);
    EXPECT_EQ(numbers, DRAPE_VERSION_STRING);
}

TEST(Version, HeaderAndCMakeAgree)
{
    EXPECT_STREQ(DRAPE_TEST_VERSION, DRAPE_VERSION_STRING);
}
}  // namespace
}  // namespace drape::test
