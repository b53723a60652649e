#include "mesh_io/read_file.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace drape
{
namespace
{
constexpr std::size_t kBlockBytes = std::size_t(1) << 20;

#ifdef _WIN32
constexpr int kOpenFlags = O_RDONLY | O_BINARY;
using ReadCount = int;
using ReadSize = unsigned;
bool isPipe(unsigned mode)
{
    return (mode & S_IFMT) == S_IFIFO;
}
bool isSocket(unsigned)
{
    return false;
}
#else
// Without O_NONBLOCK a named pipe would wait for a writer.
constexpr int kOpenFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK;
using ReadCount = ssize_t;
using ReadSize = std::size_t;
bool isPipe(mode_t mode)
{
    return S_ISFIFO(mode);
}
bool isSocket(mode_t mode)
{
    return S_ISSOCK(mode);
}
#endif

class OpenFile
{
public:
    explicit OpenFile(const std::string& path) : m_file(::open(path.c_str(), kOpenFlags)) {}
    ~OpenFile()
    {
        if (m_file >= 0) ::close(m_file);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    int get() const { return m_file; }

private:
    int m_file;
};

// Returns the name of the kind of a file that is not a regular file; null for a regular file.
template <class Mode>
const char* kindOf(Mode mode)
{
    if ((mode & S_IFMT) == S_IFREG) return nullptr;
    if ((mode & S_IFMT) == S_IFDIR) return "folder";
    if (isPipe(mode)) return "pipe";
    if (isSocket(mode)) return "socket";
    return "device";
}

std::string errorText()
{
    return errno == ENOENT ? "no such file" : std::string("cannot be read: ") + std::strerror(errno);
}
}  // namespace

std::string readWholeFile(const std::string& path, const std::string& what, std::string& bytes)
{
    bytes.clear();
    struct stat status = {};
    // The kind is checked before opening, since opening a device or a socket can fail or have effects.
    if (::stat(path.c_str(), &status) != 0) return errorText();
    if (const char* kind = kindOf(status.st_mode)) return std::string("is a ") + kind + ", not a " + what;
    const OpenFile file(path);
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0) return errorText();
    if (const char* kind = kindOf(status.st_mode)) return std::string("is a ") + kind + ", not a " + what;
    // The size is a first guess: files of /proc say 0, and a file may grow.
    std::size_t length = 0;
    bytes.resize(static_cast<std::size_t>(status.st_size) + 1);
    for (;;)
    {
        const ReadCount count = ::read(file.get(), &bytes[length], static_cast<ReadSize>(bytes.size() - length));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errorText();
        if (count == 0) break;
        length += static_cast<std::size_t>(count);
        if (length == bytes.size()) bytes.resize(length + kBlockBytes);
    }
    bytes.resize(length);
    return bytes.empty() ? "is empty, not a " + what : "";
}
}  // namespace drape
