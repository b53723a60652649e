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

// The final destination of the bytes.
struct Target
{
    fs::path m_path;           // no link, of a file
    struct stat m_status;      // status of the existing file
    int m_code = 0;            // why there is nothing: ENOENT, or worse
    bool m_isInPlace = false;  // written where it is

    bool isThere() const { return m_code == 0; }
    bool canBeMade() const { return m_code == ENOENT; }
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

// Resolves links in the existing part of the path.
fs::path inRealFolder(const fs::path& path)
{
    std::error_code code;
    const fs::path folder = fs::canonical(path.has_parent_path() ? path.parent_path() : fs::path("."), code);
    return code ? path : folder / path.filename();
}

// Returns a link's target, whether it exists or not. A process's descriptor need not link to a path; it is left
// unchanged.
fs::path followed(const fs::path& link)
{
    std::error_code code;
    fs::path path = inRealFolder(link);
    while (fs::is_symlink(path, code) && path.string().rfind("/proc/", 0) != 0)
        path = inRealFolder(path.parent_path() / fs::read_symlink(path, code));  // an absolute one replaces it
    return path;
}

Target targetOf(const std::string& path)
{
    Target target;
    if (::stat(path.c_str(), &target.m_status) != 0) target.m_code = errno;
    target.m_path = path;
    if (!target.isThere() && !target.canBeMade()) return target;  // links that go round in a circle among others
    target.m_path = followed(path);
    std::error_code code;
    target.m_isInPlace = target.isThere() && (!S_ISREG(target.m_status.st_mode) || fs::is_symlink(target.m_path, code));
    return target;
}

// Returns 0 or the error's number.
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
    const Target target = targetOf(path);
    if (!target.isThere() && !target.canBeMade()) return fail(path, target.m_code, error);
    if (target.isThere() && S_ISDIR(target.m_status.st_mode)) return fail(path, "is a folder", error);
    if (target.isThere() && ::access(target.m_path.c_str(), W_OK) != 0) return fail(path, errno, error);
    if (target.m_isInPlace) return true;
    std::error_code code;
    const fs::path folder = target.m_path.has_parent_path() ? target.m_path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, code)) return fail(path, "no folder " + folder.string(), error);
    return ::access(folder.c_str(), W_OK) == 0 || fail(path, errno, error);
}

bool areOneFile(const std::string& one, const std::string& other)
{
    const Target a = targetOf(one), b = targetOf(other);
    if (a.isThere() != b.isThere()) return false;
    if (a.isThere())
        return a.m_status.st_dev == b.m_status.st_dev && a.m_status.st_ino == b.m_status.st_ino &&
               !S_ISCHR(a.m_status.st_mode);
    std::error_code code;
    const auto placeOf = [&code](const Target& target)
    { return fs::weakly_canonical(fs::absolute(target.m_path, code), code); };
    return placeOf(a) == placeOf(b);
}

bool writeFileAtomically(const std::string& path, const std::string& bytes, std::string& error)
{
    const Target target = targetOf(path);
    if (target.m_isInPlace)
    {
        const int code = writeTo(target.m_path, bytes);
        return code == 0 || fail(path, code, error);
    }
    if (!target.isThere() && !target.canBeMade()) return fail(path, target.m_code, error);
    if (target.isThere() && ::access(target.m_path.c_str(), W_OK) != 0) return fail(path, errno, error);
    const std::string temporary = target.m_path.string() + ".part" + std::to_string(::getpid());
    int code = writeTo(temporary, bytes);
    if (code == 0 && target.isThere() && ::chmod(temporary.c_str(), target.m_status.st_mode & 07777) != 0) code = errno;
    if (code == 0 && std::rename(temporary.c_str(), target.m_path.c_str()) != 0) code = errno;
    if (code == 0) return true;
    std::remove(temporary.c_str());
    return fail(path, code, error);
}
}  // namespace drape
