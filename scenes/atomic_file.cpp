#include "scenes/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <unistd.h>

namespace drape
{
bool writeFileAtomically(const std::string& path, const std::string& bytes, std::string& error)
{
    const std::string temporary = path + ".part" + std::to_string(::getpid());
    const auto fail = [&](int code)
    {
        error = path + ": cannot write: " + std::strerror(code);
        std::remove(temporary.c_str());
        return false;
    };
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (file == nullptr)
    {
        error = path + ": cannot write: " + std::strerror(errno);
        return false;
    }
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
    const int code = errno;
    if (std::fclose(file) != 0) return fail(errno);
    if (!written) return fail(code);
    if (std::rename(temporary.c_str(), path.c_str()) != 0) return fail(errno);
    return true;
}
}  // namespace drape
