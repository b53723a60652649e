// Records the size of a device's buffers by name, for memory reports. Not thread-safe. Costs a map entry per
// allocation.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "drape/report.h"

namespace drape
{
class MemoryLedger
{
public:
    // Records an allocation until the last copy of the returned object is destroyed, which may outlive the ledger.
    std::shared_ptr<const void> enter(const std::string& name, std::size_t bytes);

    // Returns the bytes of each name, in alphabetical order, without names of size 0.
    std::vector<MemoryUse> list() const;

private:
    using Bytes = std::map<std::string, std::size_t>;
    std::shared_ptr<Bytes> m_bytes = std::make_shared<Bytes>();
};
}  // namespace drape
