// The environment variables that programs set for PoCL's threads.
#include "tools/common/pocl_threads.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <string>

#include <sched.h>
#include <unistd.h>

namespace drape::test
{
namespace
{
constexpr char kAffinity[] = "POCL_AFFINITY";
constexpr const char* kNumbers[] = {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT", "POCL_MAX_COMPUTE_UNITS"};

// Removes the variables, and restores them afterwards.
class PoclThreads : public testing::Test
{
protected:
    void SetUp() override
    {
        hide(kAffinity);
        for (const char* name : kNumbers)
            hide(name);
        ASSERT_EQ(::sched_getaffinity(0, sizeof m_cores, &m_cores), 0);
    }

    void TearDown() override
    {
        if (CPU_COUNT(&m_cores) > 0) ::sched_setaffinity(0, sizeof m_cores, &m_cores);
        ::unsetenv(kAffinity);
        for (const auto& variable : m_variables)
            ::setenv(variable.first.c_str(), variable.second.c_str(), 1);
    }

    // Returns "" if the variable is not set.
    static std::string affinity()
    {
        const char* value = std::getenv(kAffinity);
        return value ? value : "";
    }

    static std::string wanted(const cpu_set_t& cores)
    {
        return CPU_COUNT(&cores) == ::sysconf(_SC_NPROCESSORS_CONF) ? "1" : "";
    }

    cpu_set_t m_cores = {};

private:
    void hide(const char* name)
    {
        if (const char* value = std::getenv(name)) m_variables[name] = value;
        ::unsetenv(name);
    }

    std::map<std::string, std::string> m_variables;
};
}  // namespace

TEST_F(PoclThreads, KeepToTheirCoresIfTheProcessHasAllCores)
{
    keepPoclThreadsApart();
    EXPECT_EQ(affinity(), wanted(m_cores));
}

// PoCL ends the program if it may not put a thread on a core.
TEST_F(PoclThreads, AreLeftAloneIfACoreIsMissing)
{
    cpu_set_t one;
    CPU_ZERO(&one);
    int core = 0;
    while (!CPU_ISSET(core, &m_cores))
        ++core;
    CPU_SET(core, &one);
    ASSERT_EQ(::sched_setaffinity(0, sizeof one, &one), 0);
    keepPoclThreadsApart();
    EXPECT_EQ(affinity(), wanted(one));
}

TEST_F(PoclThreads, AreLeftAloneIfTheirNumberIsSet)
{
    for (const char* name : kNumbers)
    {
        SCOPED_TRACE(name);
        ::setenv(name, "64", 1);
        keepPoclThreadsApart();
        ::unsetenv(name);
        EXPECT_EQ(affinity(), "");
    }
}

TEST_F(PoclThreads, FollowTheUsersVariable)
{
    ::setenv(kAffinity, "0", 1);
    keepPoclThreadsApart();
    EXPECT_EQ(affinity(), "0");
}
}  // namespace drape::test
