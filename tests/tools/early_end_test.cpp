// Runs of cloth_drop that end before their last step: what is done is written, and nothing says that it went well.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bullet_plugin/core/pipeline/pipeline.h"
#include "tools/cloth_drop/interruption.h"
#include "tests/tools/tool.h"

namespace drape::test
{
namespace
{
class EarlyEnd : public ToolTest
{
protected:
    std::vector<std::string> longRun(const std::string& backend = "host") const
    {
        return {"--obstacle",      "sphere",     "--cloth",   "9x9",           "--backend", backend,
                "--steps",         "1000000",    "--frames",  frames(),        "--csv",     path("csv"),
                "--json",          path("json"), "--picture", path("picture"), "--quiet",   "--validate-hash",
                "0123456789abcdef"};
    }
    std::string frames() const { return path("frames"); }

    // Expects as many rows as the summary says, and at least `least`.
    void expectSteps(int least) const
    {
        const auto summary = nlohmann::json::parse(readAll(path("json")));
        const int steps = summary.at("steps");
        EXPECT_GE(steps, least);
        EXPECT_EQ(summary.at("capped_at_step"), steps);
        EXPECT_FALSE(std::string(summary.at("trouble")).empty());
        const std::string csv = readAll(path("csv"));
        EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), steps + 1);
        EXPECT_FALSE(std::filesystem::exists(path("picture")));
    }
};

class Interruption : public testing::Test
{
protected:
    // Each test has a new process: other tests leave threads and handlers behind.
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};
}  // namespace

// An OpenCL driver may have handlers of its own.
TEST_F(EarlyEnd, ASignalKeepsTheStepsDone)
{
    std::vector<std::pair<std::string, int>> cases = {{"host", SIGINT}, {"host", SIGTERM}, {"host", SIGHUP}};
    if (!listDevices().empty()) cases.emplace_back("opencl", SIGINT);
    for (const auto& [backend, signal] : cases)
    {
        SCOPED_TRACE(backend + " " + std::to_string(signal));
        std::filesystem::remove_all(frames());
        const pid_t process = start(longRun(backend));
        ASSERT_TRUE(waitUntil([this] { return std::filesystem::exists(frames() + "/cloth_0003.ply"); }));
        ASSERT_EQ(::kill(process, signal), 0);
        const ToolRun run = end(process);
        EXPECT_EQ(run.m_exitCode, 1);
        EXPECT_NE(run.m_err.find("ended by a signal"), std::string::npos) << run.m_err;
        expectSteps(3);
    }
}

TEST_F(EarlyEnd, AFrameThatCannotBeWrittenKeepsTheStepsDone)
{
    std::filesystem::create_directories(frames() + "/cloth_0003.ply");
    const ToolRun run = this->run(longRun());
    EXPECT_EQ(run.m_exitCode, 1);
    EXPECT_NE(run.m_err.find("cloth_0003.ply: cannot write"), std::string::npos) << run.m_err;
    expectSteps(3);
}

// The results are written before the picture, which is given up.
TEST_F(EarlyEnd, ASignalWhileThePictureIsDrawnKeepsTheResults)
{
    const pid_t process = start({"--obstacle", "sphere", "--cloth", "9x9", "--backend", "host", "--steps", "12",
                                 "--csv", path("csv"), "--json", path("json"), "--picture", path("picture.png")});
    ASSERT_TRUE(waitUntil([this] { return readAll(path("stderr.txt")).find("picture: 10 %") != std::string::npos; }));
    EXPECT_TRUE(nlohmann::json::accept(readAll(path("json")))) << "written before the picture";
    ASSERT_EQ(::kill(process, SIGINT), 0);
    const ToolRun run = end(process);
    EXPECT_EQ(run.m_exitCode, 1);
    EXPECT_NE(run.m_err.find("ended by a signal: Interrupt; no picture"), std::string::npos) << run.m_err;
    EXPECT_EQ(run.m_err.find("picture: 100 %"), std::string::npos) << "drawn to its end all the same";
    EXPECT_FALSE(std::filesystem::exists(path("picture.png")));
    const auto summary = nlohmann::json::parse(readAll(path("json")));
    EXPECT_EQ(summary.at("steps"), 12);
    EXPECT_FALSE(summary.contains("capped_at_step"));
    const std::string csv = readAll(path("csv"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 13);
    EXPECT_NE(run.m_out.find("hash"), std::string::npos) << "the table";
}

TEST_F(Interruption, TheFirstSignalIsNotedAndTheSecondEndsTheProgram)
{
    const auto listen = []
    {
        listenToSignals();
        ::raise(SIGINT);
        if (interruption().empty()) ::_exit(2);
        ::raise(SIGTERM);
        ::_exit(0);
    };
    EXPECT_EXIT(listen(), testing::KilledBySignal(SIGTERM), "");
}

TEST_F(Interruption, LeavesIgnoredSignalsIgnored)
{
    const auto listen = []
    {
        ::signal(SIGHUP, SIG_IGN);
        listenToSignals();
        ::raise(SIGHUP);
        ::_exit(interruption().empty() ? 0 : 2);
    };
    EXPECT_EXIT(listen(), testing::ExitedWithCode(0), "");
}

TEST_F(Interruption, SignalsHaveTheirDefaultAfterwards)
{
    const auto listen = []
    {
        listenToSignals();
        stopListening();
        ::raise(SIGINT);
        ::_exit(0);
    };
    EXPECT_EXIT(listen(), testing::KilledBySignal(SIGINT), "");
}
}  // namespace drape::test
