#include "bullet_plugin/core/device/cache_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <exception>
#include <filesystem>
#include <utility>

namespace drape
{
namespace
{
// An open file or folder, closed at the end.
class Descriptor
{
public:
    explicit Descriptor(int descriptor) : m_descriptor(descriptor) {}
    Descriptor(Descriptor&& other) noexcept : m_descriptor(other.m_descriptor) { other.m_descriptor = -1; }
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor()
    {
        if (m_descriptor >= 0) close(m_descriptor);
    }
    explicit operator bool() const { return m_descriptor >= 0; }
    int get() const { return m_descriptor; }

private:
    int m_descriptor;
};

// Returns whether the file or folder belongs to the user and nobody else can write it.
bool isOwn(const struct stat& found)
{
    return found.st_uid == geteuid() && !(found.st_mode & (S_IWGRP | S_IWOTH));
}

// Opens the folder if it is the user's own. Removes others' permission to write, which a folder made under a lax umask
// has. A folder with the sticky bit is meant to be shared and is not used.
Descriptor openFolder(const std::string& folder)
{
    Descriptor opened(folder.empty() ? -1 : open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    struct stat found;
    if (!opened || fstat(opened.get(), &found) != 0) return Descriptor(-1);
    if (isOwn(found)) return opened;
    const bool mayBeMended = found.st_uid == geteuid() && !(found.st_mode & S_ISVTX);
    const mode_t own = found.st_mode & 07777 & ~mode_t(S_IWGRP | S_IWOTH);
    return mayBeMended && fchmod(opened.get(), own) == 0 ? std::move(opened) : Descriptor(-1);
}

void makeFolder(const std::string& folder)
{
    std::error_code ignored;
    std::filesystem::create_directories(std::filesystem::path(folder).parent_path(), ignored);
    mkdir(folder.c_str(), S_IRWXU);
}

bool readAll(int file, std::string& bytes)
{
    for (std::size_t done = 0; done < bytes.size();)
    {
        const ssize_t count = read(file, &bytes[done], bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        done += static_cast<std::size_t>(count);
    }
    return true;
}

bool writeAll(int file, const std::string& bytes)
{
    for (std::size_t done = 0; done < bytes.size();)
    {
        const ssize_t count = write(file, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        done += static_cast<std::size_t>(count);
    }
    return true;
}

// Creates a new file for the process beside the target file. Sets `temporary` to its name.
Descriptor createTemporary(int folder, const std::string& name, std::string& temporary)
{
    constexpr int kMostLeftBehind = 10;  // by processes that were ended while they wrote
    for (int i = 0; i < kMostLeftBehind; ++i)
    {
        temporary = name + "." + std::to_string(getpid()) + "." + std::to_string(i);
        Descriptor file(
            openat(folder, temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR));
        if (file || errno != EEXIST) return file;
    }
    return Descriptor(-1);
}
}  // namespace

bool readCacheFile(const std::string& folder, const std::string& name, std::size_t mostBytes, std::string& bytes)
{
    const Descriptor opened = openFolder(folder);
    if (!opened) return false;
    const Descriptor file(openat(opened.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat found;
    if (!file || fstat(file.get(), &found) != 0 || !S_ISREG(found.st_mode) || !isOwn(found)) return false;
    if (static_cast<std::uintmax_t>(found.st_size) > mostBytes) return false;
    try
    {
        bytes.resize(static_cast<std::size_t>(found.st_size));
    }
    catch (const std::exception&)
    {
        return false;  // no memory
    }
    return readAll(file.get(), bytes);
}

void writeCacheFile(const std::string& folder, const std::string& name, const std::string& bytes)
{
    if (folder.empty()) return;
    makeFolder(folder);
    const Descriptor opened = openFolder(folder);
    if (!opened) return;
    std::string temporary;
    const Descriptor file = createTemporary(opened.get(), name, temporary);
    if (!file) return;
    const bool written = writeAll(file.get(), bytes);
    if (!written || renameat(opened.get(), temporary.c_str(), opened.get(), name.c_str()) != 0)
        unlinkat(opened.get(), temporary.c_str(), 0);
}
}  // namespace drape
