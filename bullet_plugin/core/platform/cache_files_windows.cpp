// Reads and writes files in the user's own folder for caches, which Windows lets no other user write.
#include "bullet_plugin/core/device/cache_file.h"

#include <exception>
#include <fstream>

#include "file_access.h"

namespace drape
{
namespace fs = std::filesystem;

bool readCacheFile(const std::string& folder, const std::string& name, std::size_t mostBytes, std::string& bytes)
{
    std::error_code code;
    const fs::path path = fs::path(folder) / name;
    if (folder.empty() || !fs::is_regular_file(fs::symlink_status(path, code))) return false;
    const std::uintmax_t size = fs::file_size(path, code);
    if (code || size > mostBytes) return false;
    try
    {
        bytes.resize(static_cast<std::size_t>(size));
    }
    catch (const std::exception&)
    {
        return false;  // no memory
    }
    std::ifstream file(path, std::ios::binary);
    return bool(file.read(&bytes[0], static_cast<std::streamsize>(bytes.size())));
}

void writeCacheFile(const std::string& folder, const std::string& name, const std::string& bytes)
{
    std::error_code code;
    if (folder.empty()) return;
    fs::create_directories(folder, code);
    const fs::path path = fs::path(folder) / name;
    const fs::path temporary = fs::path(folder) / (name + "." + std::to_string(processNumber()));
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (file) fs::rename(temporary, path, code);
    if (!file || code) fs::remove(temporary, code);
}
}  // namespace drape
