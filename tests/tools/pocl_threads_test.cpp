// What programs tell PoCL about its threads.
#include "tools/common/pocl_threads.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include <sched.h>
#include <unistd.h>

namespace drape::test
{
namespace
{
constexpr char kVariable[] = "POCL_AFFINITY";

// Puts back what the test finds.
class PoclThreads : public testing::Test
{
protected:
    void SetUp() override
    {
        ASSERT_EQ(::sched_getaffinity(0, sizeof m_cores, &m_cores), 0);
        const char* value = std::getenv(kVariable);
        m_set = value != nullptr;
        if (m_set) m_value = value;
        ::unsetenv(kVariable);
    }

    void TearDown() override
    {
        ::sched_setaffinity(0, sizeof m_cores, &m_cores);
        ::unsetenv(kVariable);
        if (m_set) ::setenv(kVariable, m_value.c_str(), 1);
    }

    cpu_set_t m_cores;
    bool m_set = false;
    std::string m_value;
};
}  // namespace

TEST_F(PoclThreads, keepToTheirCoresWhereAllAreThisProcesss)
{
    if (CPU_COUNT(&m_cores) != ::sysconf(_SC_NPROCESSORS_CONF)) GTEST_SKIP() << "some cores are not this process's";
    keepPoclThreadsApart();
    EXPECT_STREQ(std::getenv(kVariable), "1");
}

// PoCL ends the program when it may not put a thread on a core.
TEST_F(PoclThreads, areLeftAloneWhereACoreIsMissing)
{
    if (::sysconf(_SC_NPROCESSORS_CONF) < 2) GTEST_SKIP() << "there is one core";
    cpu_set_t one;
    CPU_ZERO(&one);
    int core = 0;
    while (!CPU_ISSET(core, &m_cores))
        ++core;
    CPU_SET(core, &one);
    ASSERT_EQ(::sched_setaffinity(0, sizeof one, &one), 0);
    keepPoclThreadsApart();
    EXPECT_EQ(std::getenv(kVariable), nullptr);
}

TEST_F(PoclThreads, areLeftAloneWhereTheirNumberIsSet)
{
    ::setenv("POCL_MAX_PTHREAD_COUNT", "64", 1);
    keepPoclThreadsApart();
    ::unsetenv("POCL_MAX_PTHREAD_COUNT");
    EXPECT_EQ(std::getenv(kVariable), nullptr);
}

TEST_F(PoclThreads, areTheUsersToDecide)
{
    ::setenv(kVariable, "0", 1);
    keepPoclThreadsApart();
    EXPECT_STREQ(std::getenv(kVariable), "0");
}
}  // namespace drape::test
