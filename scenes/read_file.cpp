#include "scenes/read_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace drape
{
std::string readWholeFile(const std::string& path, const std::string& what, std::string& bytes)
{
    std::error_code code;
    if (std::filesystem::is_directory(path, code)) return "is a folder, not a " + what;
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) return errno == ENOENT ? "no such file" : std::string("cannot be read: ") + std::strerror(errno);
    bytes.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    if (file.bad()) return std::string("cannot be read: ") + std::strerror(errno);
    return bytes.empty() ? "is empty, not a " + what : "";
}
}  // namespace drape
