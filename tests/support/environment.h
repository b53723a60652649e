// Environment variables and folders for the length of a test.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#ifdef _WIN32
#include <process.h>
#endif

namespace drape::test
{
// Sets an environment variable, or removes it (null).
inline void setVariable(const char* name, const char* value)
{
#ifdef _WIN32
    _putenv_s(name, value ? value : "");
#else
    value ? setenv(name, value, 1) : unsetenv(name);
#endif
}

// Sets a variable, or takes it away (null), and puts it back.
class ScopedVariable
{
public:
    ScopedVariable(const char* name, const char* value) : m_name(name)
    {
        const char* previous = std::getenv(name);
        m_had = previous != nullptr;
        if (previous) m_previous = previous;
        setVariable(name, value);
    }
    ~ScopedVariable() { setVariable(m_name, m_had ? m_previous.c_str() : nullptr); }
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
        if (!make()) ADD_FAILURE() << "no folder " << m_path;
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
    bool make()
    {
#ifdef _WIN32
        static int count = 0;
        m_path += std::to_string(_getpid()) + "_" + std::to_string(count++);
        std::error_code ignored;
        return std::filesystem::create_directory(m_path, ignored);
#else
        return mkdtemp(m_path.data()) != nullptr;
#endif
    }

    std::string m_path;
};
}  // namespace drape::test
