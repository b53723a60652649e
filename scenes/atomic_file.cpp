#include "scenes/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <sys/stat.h>
#include <unistd.h>

namespace drape
{
namespace
{
namespace fs = std::filesystem;

// Where the bytes go in the end.
struct Target
{
    fs::path m_path;         // no link
    bool m_isThere = false;  // else it is new
    bool m_isFile = true;
    mode_t m_mode = 0;  // of what is there
};

bool fail(const std::string& path, const std::string& reason, std::string& error)
{
    error = path + ": cannot write: " + reason;
    return false;
}

bool fail(const std::string& path, int code, std::string& error)
{
    return fail(path, std::strerror(code), error);
}

// A link's end, whether or not anything is there; links that go round in a circle end where they began.
fs::path followed(fs::path path)
{
    constexpr int kMostLinks = 40;  // as Linux has it
    std::error_code code;
    for (int i = 0; i < kMostLinks && fs::is_symlink(path, code); ++i)
    {
        const fs::path next = fs::read_symlink(path, code);
        if (code) break;
        path = path.parent_path() / next;  // an absolute one replaces it
    }
    return path;
}

Target targetOf(const std::string& path)
{
    Target target;
    struct stat status;
    target.m_isThere = ::stat(path.c_str(), &status) == 0;
    if (target.m_isThere)
    {
        target.m_mode = status.st_mode & 07777;
        target.m_isFile = S_ISREG(status.st_mode);
    }
    // What a process's descriptors link to need not be a path.
    target.m_path = target.m_isFile ? followed(path) : fs::path(path);
    return target;
}

// 0 or the error's number.
int writeTo(const std::string& path, const std::string& bytes)
{
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) return errno;
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
    const int code = errno;
    if (std::fclose(file) != 0 && written) return errno;
    return written ? 0 : code;
}
}  // namespace

bool canWriteFile(const std::string& path, std::string& error)
{
    std::error_code code;
    if (fs::is_directory(path, code)) return fail(path, "is a folder", error);
    const Target target = targetOf(path);
    if (target.m_isThere && ::access(target.m_path.c_str(), W_OK) != 0) return fail(path, errno, error);
    if (!target.m_isFile) return true;
    const fs::path folder = target.m_path.has_parent_path() ? target.m_path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, code)) return fail(path, "no folder " + folder.string(), error);
    return ::access(folder.c_str(), W_OK) == 0 || fail(path, errno, error);
}

bool writeFileAtomically(const std::string& path, const std::string& bytes, std::string& error)
{
    const Target target = targetOf(path);
    if (!target.m_isFile)
    {
        const int code = writeTo(target.m_path, bytes);
        return code == 0 || fail(path, code, error);
    }
    if (target.m_isThere && ::access(target.m_path.c_str(), W_OK) != 0) return fail(path, errno, error);
    const std::string temporary = target.m_path.string() + ".part" + std::to_string(::getpid());
    int code = writeTo(temporary, bytes);
    if (code == 0 && target.m_isThere && ::chmod(temporary.c_str(), target.m_mode) != 0) code = errno;
    if (code == 0 && std::rename(temporary.c_str(), target.m_path.c_str()) != 0) code = errno;
    if (code == 0) return true;
    std::remove(temporary.c_str());
    return fail(path, code, error);
}
}  // namespace drape
