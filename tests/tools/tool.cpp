#include "tests/tools/tool.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace drape::test
{
std::string readAll(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

bool waitUntil(const std::function<bool()>& isSo)
{
    for (int look = 0; look < 6000; ++look)
    {
        if (isSo()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

std::string littleEndian(std::uint32_t value)
{
    std::string bytes;
    for (int i = 0; i < 4; ++i)
        bytes += char(value >> (8 * i) & 0xffu);
    return bytes;
}

void ToolTest::SetUp()
{
    const char* program = std::getenv(programVariable());
    ASSERT_TRUE(program != nullptr) << programVariable() << " must name the program";
    m_program = program;
}

ToolRun ToolTest::run(const std::vector<std::string>& arguments) const
{
    return end(start(arguments));
}

void ToolTest::expectFullOutputTold(const std::vector<std::string>& arguments) const
{
    const ToolRun run = end(start(arguments, "/dev/full"));
    EXPECT_EQ(run.m_exitCode, 1);
    EXPECT_NE(run.m_err.find("standard output: cannot write\n"), std::string::npos) << run.m_err;
    EXPECT_EQ(run.m_err.find('\n'), run.m_err.size() - 1) << "one line: " << run.m_err;
}

pid_t ToolTest::start(const std::vector<std::string>& arguments, const std::string& out) const
{
    std::vector<std::string> words = {m_program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(&word[0]);
    pointers.push_back(nullptr);
    const std::string err = path("stderr.txt");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t process = 0;
    EXPECT_EQ(posix_spawn(&process, m_program.c_str(), &actions, nullptr, pointers.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    return process;
}

ToolRun ToolTest::end(pid_t process) const
{
    int status = 0;
    ToolRun result;
    if (process > 0 && ::waitpid(process, &status, 0) == process && WIFEXITED(status))
        result.m_exitCode = WEXITSTATUS(status);
    result.m_out = readAll(path("stdout.txt"));
    result.m_err = readAll(path("stderr.txt"));
    return result;
}

ToolRun ToolTest::runSmall(const std::vector<std::string>& more) const
{
    std::vector<std::string> arguments = {"--obstacle", "sphere",  "--cloth",       "9x9", "--steps",
                                          "10",         "--quiet", "--drop-height", "0.01"};
    const auto given = [&more](const char* option)
    {
        for (const std::string& argument : more)
            if (argument == option) return true;
        return false;
    };
    for (std::size_t i = 0; i < arguments.size();)  // an option may come only once
    {
        const std::size_t length = arguments[i] == "--quiet" ? 1 : 2;
        if (given(arguments[i].c_str()))
            arguments.erase(arguments.begin() + std::ptrdiff_t(i), arguments.begin() + std::ptrdiff_t(i + length));
        else
            i += length;
    }
    if (!given("--backend") && !given("--device")) arguments.insert(arguments.end(), {"--backend", "host"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
}

std::string ToolTest::summaryOf(const std::vector<std::string>& more) const
{
    std::vector<std::string> arguments = more;
    arguments.insert(arguments.end(), {"--json", "-"});
    const ToolRun result = runSmall(arguments);
    EXPECT_EQ(result.m_exitCode, 0) << result.m_err;
    return result.m_out;
}

std::string ToolTest::write(const std::string& name, const std::string& text) const
{
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
}

void ToolTest::expectRefused(const ToolRun& run, const std::vector<std::string>& words)
{
    EXPECT_EQ(run.m_exitCode, 2) << run.m_err;
    EXPECT_EQ(run.m_out, "");
    ASSERT_FALSE(run.m_err.empty());
    EXPECT_EQ(run.m_err.find('\n'), run.m_err.size() - 1) << "one line: " << run.m_err;
    for (const std::string& word : words)
        EXPECT_NE(run.m_err.find(word), std::string::npos) << "'" << word << "' is not in: " << run.m_err;
}
}  // namespace drape::test
