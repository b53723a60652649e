#include "scenes/atomic_file.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "bullet_plugin/core/platform/file_access.h"

namespace drape
{
namespace
{
namespace fs = std::filesystem;

// The final destination of the bytes.
struct Target
{
    fs::path m_path;           // no link, of a file
    fs::file_status m_status;  // status of the existing file
    std::error_code m_code;    // why there is nothing: no such file, or worse
    bool m_isInPlace = false;  // written where it is

    bool isThere() const { return !m_code; }
    bool canBeMade() const { return m_code == std::errc::no_such_file_or_directory; }
};

bool fail(const std::string& path, const std::string& reason, std::string& error)
{
    error = path + ": cannot write: " + reason;
    return false;
}

bool fail(const std::string& path, std::error_code code, std::string& error)
{
    return fail(path, code.message(), error);
}

std::error_code lastError()
{
    return std::error_code(errno, std::generic_category());
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
    while (fs::is_symlink(path, code) && path.generic_string().rfind("/proc/", 0) != 0)
        path = inRealFolder(path.parent_path() / fs::read_symlink(path, code));  // an absolute one replaces it
    return path;
}

Target targetOf(const std::string& path)
{
    Target target;
    target.m_status = fs::status(path, target.m_code);
    target.m_path = path;
    if (!target.isThere() && !target.canBeMade()) return target;  // links that go round in a circle among others
    target.m_path = followed(path);
    std::error_code code;
    target.m_isInPlace =
        target.isThere() && (!fs::is_regular_file(target.m_status) || fs::is_symlink(target.m_path, code));
    return target;
}

std::error_code writeTo(const fs::path& path, const std::string& bytes)
{
    std::FILE* file = std::fopen(path.string().c_str(), "wb");
    if (file == nullptr) return lastError();
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
    const std::error_code code = lastError();
    if (std::fclose(file) != 0 && written) return lastError();
    return written ? std::error_code() : code;
}
}  // namespace

bool canWriteFile(const std::string& path, std::string& error)
{
    const Target target = targetOf(path);
    if (!target.isThere() && !target.canBeMade()) return fail(path, target.m_code, error);
    if (target.isThere() && fs::is_directory(target.m_status)) return fail(path, "is a folder", error);
    const std::error_code reason = target.isThere() ? whyNotWritable(target.m_path) : std::error_code();
    if (reason) return fail(path, reason, error);
    if (target.m_isInPlace) return true;
    std::error_code code;
    const fs::path folder = target.m_path.has_parent_path() ? target.m_path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, code)) return fail(path, "no folder " + folder.string(), error);
    code = whyNotWritable(folder);
    return !code || fail(path, code, error);
}

bool areOneFile(const std::string& one, const std::string& other)
{
    const Target a = targetOf(one), b = targetOf(other);
    if (a.isThere() != b.isThere()) return false;
    if (a.isThere()) return isSameFile(one, other) && !fs::is_character_file(a.m_status);
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
        const std::error_code code = writeTo(target.m_path, bytes);
        return !code || fail(path, code, error);
    }
    if (!target.isThere() && !target.canBeMade()) return fail(path, target.m_code, error);
    std::error_code code = target.isThere() ? whyNotWritable(target.m_path) : std::error_code();
    if (code) return fail(path, code, error);
    fs::path temporary = target.m_path;
    temporary += ".part" + std::to_string(processNumber());
    code = writeTo(temporary, bytes);
    if (!code && target.isThere()) fs::permissions(temporary, target.m_status.permissions(), code);
    if (!code) fs::rename(temporary, target.m_path, code);
    if (!code) return true;
    std::error_code ignored;
    fs::remove(temporary, ignored);
    return fail(path, code, error);
}
}  // namespace drape
