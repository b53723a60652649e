#include "cache_file.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace drape
{
std::string cacheFolder(const std::string& setting)
{
    if (setting == "none") return std::string();
    if (!setting.empty()) return setting;
    const char* xdg = std::getenv("XDG_CACHE_HOME");
    if (xdg && *xdg) return std::string(xdg) + "/drape";
    const char* home = std::getenv("HOME");
    return home && *home ? std::string(home) + "/.cache/drape" : std::string();
}

bool readCacheFile(const std::string& folder, const std::string& name, std::size_t mostBytes, std::string& bytes)
{
    if (folder.empty()) return false;
    std::error_code error;
    const std::string path = folder + "/" + name;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error || size > mostBytes) return false;
    std::ifstream file(path, std::ios::binary);
    bytes.resize(size);
    return bool(file.read(bytes.data(), static_cast<std::streamsize>(size)));
}

void writeCacheFile(const std::string& folder, const std::string& name, const std::string& bytes)
{
    if (folder.empty()) return;
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    const std::string target = folder + "/" + name;
    const std::string temporary = target + "." + std::to_string(getpid());
    std::ofstream file(temporary, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (file)
        std::filesystem::rename(temporary, target, ignored);
    else
        std::filesystem::remove(temporary, ignored);
}

std::uint64_t cacheHash(const void* bytes, std::size_t count, std::uint64_t hash)
{
    for (std::size_t i = 0; i < count; ++i)
        hash = (hash ^ static_cast<const unsigned char*>(bytes)[i]) * 1099511628211ull;
    return hash;
}

std::string hexText(std::uint64_t value)
{
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4)
        text += "0123456789abcdef"[(value >> shift) & 15];
    return text;
}
}  // namespace drape
