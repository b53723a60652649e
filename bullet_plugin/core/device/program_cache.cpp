#include "program_cache.h"

#include <cstdint>
#include <cstring>

#include "cache_file.h"

namespace drape
{
namespace
{
// Precedes the binary: its kind, length and hash, so that a damaged file is recognised.
struct Header
{
    char m_magic[8];
    std::uint64_t m_size;
    std::uint64_t m_hash;
};
constexpr char kMagic[8] = {'d', 'r', 'a', 'p', 'e', 'k', '0', '1'};
constexpr std::size_t kLargest = std::size_t(1) << 30;
}  // namespace

ProgramCache::ProgramCache(const std::string& folder) : m_folder(cacheFolder(folder)) {}

std::string ProgramCache::key(const std::string& source, const std::string& options, const DeviceInfo& device) const
{
    const std::string text =
        source + '\1' + options + '\1' + device.m_platform + '\1' + device.m_name + '\1' + device.m_driver;
    return hexText(cacheHash(text.data(), text.size())) + hexText(cacheHash(text.data(), text.size(), text.size()));
}

bool ProgramCache::load(const std::string& key, std::vector<unsigned char>& binary) const
{
    std::string file;
    if (!readCacheFile(m_folder, key, kLargest, file)) return false;
    Header header;
    if (file.size() < sizeof header) return false;
    std::memcpy(&header, file.data(), sizeof header);
    if (std::memcmp(header.m_magic, kMagic, sizeof kMagic) != 0) return false;
    if (header.m_size > file.size() - sizeof header) return false;
    const char* const content = file.data() + sizeof header;
    binary.assign(content, content + header.m_size);
    return cacheHash(binary.data(), binary.size()) == header.m_hash;
}

void ProgramCache::store(const std::string& key, const std::vector<unsigned char>& binary) const
{
    Header header;
    std::memcpy(header.m_magic, kMagic, sizeof kMagic);
    header.m_size = binary.size();
    header.m_hash = cacheHash(binary.data(), binary.size());
    std::string file(reinterpret_cast<const char*>(&header), sizeof header);
    file.append(reinterpret_cast<const char*>(binary.data()), binary.size());
    writeCacheFile(m_folder, key, file);
}
}  // namespace drape
