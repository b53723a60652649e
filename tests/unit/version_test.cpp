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

// The preprocessor compares versions.
#if DRAPE_VERSION_NUMBER < DRAPE_MAKE_VERSION(0, 2, 0) || DRAPE_VERSION_NUMBER >= DRAPE_MAKE_VERSION(999, 0, 0)
#error "DRAPE_VERSION_NUMBER does not compare"
#endif

TEST(Version, NumbersCompareAsVersionsDo)
{
    EXPECT_LT(DRAPE_MAKE_VERSION(0, 9, 9), DRAPE_MAKE_VERSION(0, 10, 0));
    EXPECT_LT(DRAPE_MAKE_VERSION(0, 999, 999), DRAPE_MAKE_VERSION(1, 0, 0));
    EXPECT_LT(DRAPE_MAKE_VERSION(1, 2, 3), DRAPE_MAKE_VERSION(1, 2, 4));
}

TEST(Version, LibraryAndHeaderAgree)
{
    EXPECT_STREQ(libraryVersion(), DRAPE_VERSION_STRING);
    EXPECT_EQ(libraryVersionNumber(), DRAPE_VERSION_NUMBER);
}
}  // namespace
}  // namespace drape::test
