// Reads and writes files of Drape's cache folder. Every problem (no folder, no space, no permission, no memory) counts
// as a missing file; nothing here fails. Files and folders that are not the user's own, or that others can write, are
// not used, and links to files are not followed: the cache contains programs that are run.
// core/platform has the two functions for each system.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace drape
{
// Returns the folder that Settings::m_cacheFolder names: empty for $XDG_CACHE_HOME/drape or ~/.cache/drape, "none"
// for no cache (empty).
std::string cacheFolder(const std::string& setting);

// Returns false if there is no folder or no such file, or the file is longer than mostBytes.
bool readCacheFile(const std::string& folder, const std::string& name, std::size_t mostBytes, std::string& bytes);
// Writes a new temporary file and renames it, so that no reader sees half of it. Only the user may read the file.
// Creates a missing folder.
void writeCacheFile(const std::string& folder, const std::string& name, const std::string& bytes);

// FNV-1a, 64 bit.
constexpr std::uint64_t kCacheHashStart = 14695981039346656037ull;
std::uint64_t cacheHash(const void* bytes, std::size_t count, std::uint64_t hash = kCacheHashStart);
// 16 digits.
std::string hexText(std::uint64_t value);
}  // namespace drape
