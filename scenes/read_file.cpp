#include "scenes/read_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace drape
{
std::string readWholeFile(const std::string& path, const std::string& what, std::string& bytes)
{
    std::error_code code;
    bytes.clear();
    const std::filesystem::file_status status = std::filesystem::status(path, code);
    if (std::filesystem::is_directory(status)) return "is a folder, not a " + what;
    if (std::filesystem::is_character_file(status)) return "is a device, not a " + what;
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) return errno == ENOENT ? "no such file" : std::string("cannot be read: ") + std::strerror(errno);
    std::vector<char> some(std::size_t(1) << 16);
    while (file.read(some.data(), std::streamsize(some.size())) || file.gcount() > 0)
        bytes.append(some.data(), std::size_t(file.gcount()));
    if (file.bad()) return std::string("cannot be read: ") + std::strerror(errno);
    return bytes.empty() ? "is empty, not a " + what : "";
}
}  // namespace drape
