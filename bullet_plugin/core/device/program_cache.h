// Stores compiled programs on disk, one file each. Every problem (no folder, no space, a damaged or foreign file)
// counts as a missing file; nothing here fails.
#pragma once

#include <string>
#include <vector>

#include "drape/report.h"

namespace drape
{
class ProgramCache
{
public:
    // folder: empty for $XDG_CACHE_HOME/drape or ~/.cache/drape, "none" for no cache.
    explicit ProgramCache(const std::string& folder);

    // Names a program by its source, options, platform, device and driver version.
    std::string key(const std::string& source, const std::string& options, const DeviceInfo& device) const;

    bool load(const std::string& key, std::vector<unsigned char>& binary) const;
    // Writes a temporary file and renames it, so that no reader sees half of it.
    void store(const std::string& key, const std::vector<unsigned char>& binary) const;

private:
    std::string m_folder;  // empty: no cache
};
}  // namespace drape
