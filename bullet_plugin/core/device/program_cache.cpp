#include "program_cache.h"

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace drape
{
namespace
{
// FNV-1a, 64 bit.
std::uint64_t hashBytes(const void* bytes, std::size_t count, std::uint64_t hash = 14695981039346656037ull)
{
    for (std::size_t i = 0; i < count; ++i)
    {
        hash = (hash ^ static_cast<const unsigned char*>(bytes)[i]) * 1099511628211ull;
    }
    return hash;
}

std::string hex(std::uint64_t value)
{
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4)
        text += "0123456789abcdef"[(value >> shift) & 15];
    return text;
}

std::string userFolder()
{
    const char* xdg = std::getenv("XDG_CACHE_HOME");
    if (xdg && *xdg) return std::string(xdg) + "/drape";
    const char* home = std::getenv("HOME");
    return home && *home ? std::string(home) + "/.cache/drape" : std::string();
}

// In front of the binary: what it is, how long and its hash, so that a damaged file is recognised.
struct Header
{
    char m_magic[8];
    std::uint64_t m_size;
    std::uint64_t m_hash;
};
constexpr char kMagic[8] = {'d', 'r', 'a', 'p', 'e', 'k', '0', '1'};
}  // namespace

ProgramCache::ProgramCache(const std::string& folder) : m_folder(folder.empty() ? userFolder() : folder)
{
    if (m_folder == "none") m_folder.clear();
}

std::string ProgramCache::key(const std::string& source, const std::string& options, const DeviceInfo& device) const
{
    const std::string text =
        source + '\1' + options + '\1' + device.m_platform + '\1' + device.m_name + '\1' + device.m_driver;
    return hex(hashBytes(text.data(), text.size())) + hex(hashBytes(text.data(), text.size(), text.size()));
}

bool ProgramCache::load(const std::string& key, std::vector<unsigned char>& binary) const
{
    if (m_folder.empty()) return false;
    std::ifstream file(m_folder + "/" + key, std::ios::binary);
    Header header;
    if (!file.read(reinterpret_cast<char*>(&header), sizeof header)) return false;
    constexpr std::uint64_t kLargest = 1ull << 30;
    if (std::memcmp(header.m_magic, kMagic, sizeof kMagic) != 0 || header.m_size > kLargest) return false;
    binary.resize(header.m_size);
    if (!file.read(reinterpret_cast<char*>(binary.data()), static_cast<std::streamsize>(binary.size()))) return false;
    return hashBytes(binary.data(), binary.size()) == header.m_hash;
}

void ProgramCache::store(const std::string& key, const std::vector<unsigned char>& binary) const
{
    if (m_folder.empty()) return;
    std::error_code ignored;
    std::filesystem::create_directories(m_folder, ignored);
    const std::string target = m_folder + "/" + key;
    const std::string temporary = target + "." + std::to_string(getpid());
    Header header;
    std::memcpy(header.m_magic, kMagic, sizeof kMagic);
    header.m_size = binary.size();
    header.m_hash = hashBytes(binary.data(), binary.size());
    std::ofstream file(temporary, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    file.write(reinterpret_cast<const char*>(binary.data()), static_cast<std::streamsize>(binary.size()));
    file.close();
    if (file)
    {
        std::filesystem::rename(temporary, target, ignored);
    }
    else
    {
        std::filesystem::remove(temporary, ignored);
    }
}
}  // namespace drape
