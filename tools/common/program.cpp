#include "tools/common/program.h"

#include <iostream>
#include <new>

#include "scenes/atomic_file.h"
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
    return path.empty() || path == "-" || canWriteFile(path, error);
}
}  // namespace drape
