// The process of a run of Bullet's own collision never outlives its parent.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/tools/tool.h"

namespace drape::test
{
namespace
{
using CappedChild = ToolTest;

std::string processFile(pid_t process, const std::string& name)
{
    return "/proc/" + std::to_string(process) + "/" + name;
}

// Returns 0 if there is no child yet.
pid_t childOf(pid_t process)
{
    pid_t child = 0;
    std::ifstream(processFile(process, "task/" + std::to_string(process) + "/children")) >> child;
    return child;
}

// Returns true if the process has become the program.
bool streams(pid_t process)
{
    return readAll(processFile(process, "cmdline")).find("--stream-steps") != std::string::npos;
}

// Returns true if the process is gone, or ended without its exit code being read.
bool hasEnded(pid_t process)
{
    const std::string status = readAll(processFile(process, "status"));
    return status.empty() || status.find("State:\tZ") != std::string::npos;
}
}  // namespace

// The child is stopped first, as if in an endless step. A running child may notice by itself that nobody reads.
TEST_F(CappedChild, EndsWithItsParent)
{
    for (const int signal : {SIGTERM, SIGKILL})
    {
        SCOPED_TRACE(signal);
        const pid_t parent = start(
            {"--obstacle", "stairs", "--backend", "bullet", "--time-limit", "600", "--steps", "1000000", "--quiet"});
        ASSERT_TRUE(waitUntil([parent] { return streams(childOf(parent)); }));
        const pid_t child = childOf(parent);
        ASSERT_EQ(::kill(child, SIGSTOP), 0);
        ASSERT_EQ(::kill(parent, signal), 0);
        EXPECT_NE(end(parent).m_exitCode, 0);
        EXPECT_TRUE(waitUntil([child] { return hasEnded(child); }));
        ::kill(child, SIGKILL);
    }
}

TEST_F(CappedChild, LeavesTheHandlingOfASignalUnchanged)
{
    const pid_t parent = start({"--obstacle", "stairs", "--cloth", "17x17", "--steps", "100", "--backend", "host",
                                "--compare", "--quiet", "--json", path("runs.json")});
    ASSERT_TRUE(waitUntil([parent] { return streams(childOf(parent)); }));
    const pid_t child = childOf(parent);
    ASSERT_EQ(::kill(child, SIGSTOP), 0);
    ASSERT_EQ(::kill(parent, SIGTERM), 0);
    const ToolRun run = end(parent);
    EXPECT_EQ(run.m_exitCode, 1);
    EXPECT_NE(run.m_err.find("signal"), std::string::npos) << run.m_err;
    EXPECT_TRUE(waitUntil([child] { return hasEnded(child); }));
    const auto runs = nlohmann::json::parse(readAll(path("runs.json")));
    EXPECT_EQ(runs.at("drape").at("steps"), 100);
    EXPECT_FALSE(runs.at("drape").contains("trouble"));
    ::kill(child, SIGKILL);
}
}  // namespace drape::test
