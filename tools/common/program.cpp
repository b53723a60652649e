#include "tools/common/program.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>

#include <unistd.h>

#include "tools/common/pocl_threads.h"

namespace drape
{
int fail(const std::string& program, int exitCode, const std::string& reason)
{
    std::cerr << program << ": " << reason << std::endl;
    return exitCode;
}

int runGuarded(const std::string& program, const std::function<int()>& work)
{
    keepPoclThreadsApart();
    try
    {
        return work();
    }
    catch (const std::bad_alloc&)
    {
        return fail(program, kExitFailed, "out of memory");
    }
    catch (const std::exception& exception)
    {
        return fail(program, kExitFailed, exception.what());
    }
}

bool flushOutput(std::string& error)
{
    std::cout.flush();
    if (!std::cout && error.empty()) error = "standard output: cannot write";
    return error.empty();
}

bool couldWrite(const std::string& path, std::string& error)
{
    namespace fs = std::filesystem;
    if (path.empty() || path == "-") return true;
    std::error_code code;
    const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    if (fs::is_directory(path, code))
        error = path + ": cannot write: is a folder";
    else if (!fs::is_directory(folder, code))
        error = path + ": cannot write: no folder " + folder.string();
    else if (::access(folder.c_str(), W_OK) != 0)
        error = path + ": cannot write: " + std::strerror(errno);
    return error.empty();
}
}  // namespace drape
