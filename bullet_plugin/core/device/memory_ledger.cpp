#include "memory_ledger.h"

namespace drape
{
std::shared_ptr<const void> MemoryLedger::enter(const std::string& name, std::size_t bytes)
{
    std::size_t* const sum = &(*m_bytes)[name];  // stays where it is
    *sum += bytes;
    const auto leave = [book = m_bytes, sum, bytes](const void*) { *sum -= bytes; };
    return std::shared_ptr<const void>(m_bytes.get(), leave);
}

std::vector<MemoryUse> MemoryLedger::list() const
{
    std::vector<MemoryUse> uses;
    for (const auto& entry : *m_bytes)
    {
        if (entry.second == 0) continue;
        uses.push_back(MemoryUse{entry.first, entry.second});
    }
    return uses;
}
}  // namespace drape
