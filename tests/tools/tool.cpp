#include "tests/tools/tool.h"

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace drape::test
{
namespace
{
std::string quoted(const std::string& text)
{
    std::string out = "'";
    for (char c : text)
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}
}  // namespace

std::string readAll(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

void ToolTest::SetUp()
{
    const char* program = std::getenv(programVariable());
    ASSERT_TRUE(program != nullptr) << programVariable() << " must name the program";
    m_program = program;
}

ToolRun ToolTest::run(const std::vector<std::string>& arguments) const
{
    std::string command = quoted(m_program);
    for (const std::string& argument : arguments)
        command += " " + quoted(argument);
    command += " >" + quoted(path("stdout.txt")) + " 2>" + quoted(path("stderr.txt"));
    const int status = std::system(command.c_str());
    ToolRun result;
    if (status != -1 && WIFEXITED(status)) result.m_exitCode = WEXITSTATUS(status);
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
