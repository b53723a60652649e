// Environment variables and folders for the length of a test.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace drape::test
{
// Sets a variable, or takes it away (null), and puts it back.
class ScopedVariable
{
public:
    ScopedVariable(const char* name, const char* value) : m_name(name)
    {
        const char* previous = std::getenv(name);
        m_had = previous != nullptr;
        if (previous) m_previous = previous;
        value ? setenv(name, value, 1) : unsetenv(name);
    }
    ~ScopedVariable() { m_had ? setenv(m_name, m_previous.c_str(), 1) : unsetenv(m_name); }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

private:
    const char* m_name;
    bool m_had;
    std::string m_previous;
};

// Returns true if tests that need an OpenCL device must fail on a machine without one.
inline bool isDeviceExpected()
{
    const char* const none = std::getenv("DRAPE_TEST_NO_DEVICE");
    return !none || std::string(none) != "1";
}

// An empty folder that is removed with its contents.
class TemporaryFolder
{
public:
    TemporaryFolder() : m_path((std::filesystem::temp_directory_path() / "drape_test_XXXXXX").string())
    {
        if (!mkdtemp(m_path.data())) ADD_FAILURE() << "no folder " << m_path;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(m_path, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::string& path() const { return m_path; }

private:
    std::string m_path;
};
}  // namespace drape::test
