// Runs cloth_drop, or another program, as a user would and keeps what it said.
//
// Input: the environment variable DRAPE_CLOTH_DROP (or what programVariable() says) names the program. Each test gets a
// folder of its own that is gone afterwards.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "tests/support/environment.h"

namespace drape::test
{
struct ToolRun
{
    int m_exitCode = -1;  // −1: it did not end by itself
    std::string m_out, m_err;
};

class ToolTest : public testing::Test
{
protected:
    void SetUp() override;
    // The environment variable that names the program.
    virtual const char* programVariable() const { return "DRAPE_CLOTH_DROP"; }

    ToolRun run(const std::vector<std::string>& arguments) const;
    // Runs a program whose standard output is full, and expects exit code 1 and one line that says so.
    void expectFullOutputTold(const std::vector<std::string>& arguments) const;
    // The two halves of run(), for a program that a test acts on meanwhile: its process, and its end.
    pid_t start(const std::vector<std::string>& arguments) const { return start(arguments, path("stdout.txt")); }
    ToolRun end(pid_t process) const;
    // Runs a 9×9 cloth on the sphere for 10 steps on the host, quiet. Options in `more` follow and win.
    ToolRun runSmall(const std::vector<std::string>& more) const;
    // Returns the summary of such a run as JSON text; fails the test if the run fails.
    std::string summaryOf(const std::vector<std::string>& more) const;

    std::string path(const std::string& name) const { return m_folder.path() + "/" + name; }
    std::string write(const std::string& name, const std::string& text) const;  // returns the path

    // Expects exit code 2 and one line on stderr that contains all of the words.
    static void expectRefused(const ToolRun& run, const std::vector<std::string>& words);

private:
    pid_t start(const std::vector<std::string>& arguments, const std::string& out) const;

    std::string m_program;
    const TemporaryFolder m_folder;
};

std::string readAll(const std::string& path);

// Looks now and then until it is so. False when it is not within a minute.
bool waitUntil(const std::function<bool()>& isSo);

// Returns four bytes, least first.
std::string littleEndian(std::uint32_t value);

// Ends the test as skipped where no OpenCL device is expected (DRAPE_TEST_NO_DEVICE=1), as failed where one is missing.
#define DRAPE_NEED_DEVICE()                                                                        \
    if (listDevices().empty())                                                                     \
    {                                                                                              \
        const char* allowed = std::getenv("DRAPE_TEST_NO_DEVICE");                                 \
        if (allowed && std::string(allowed) == "1") GTEST_SKIP() << "no OpenCL device, as agreed"; \
        GTEST_FAIL() << "no OpenCL device was found";                                              \
    }
}  // namespace drape::test
