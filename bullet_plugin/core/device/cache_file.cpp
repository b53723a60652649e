#include "cache_file.h"

#include "bullet_plugin/core/platform/platform.h"

namespace drape
{
std::string cacheFolder(const std::string& setting)
{
    if (setting == "none") return std::string();
    if (!setting.empty()) return setting;
    const std::string folder = userCacheFolder();
    return folder.empty() ? folder : folder + "/drape";
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
