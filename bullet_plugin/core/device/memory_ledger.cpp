#include "memory_ledger.h"

namespace drape
{
std::shared_ptr<const void> MemoryLedger::enter(const std::string& name, std::size_t bytes)
{
    (*m_bytes)[name] += bytes;
    const auto leave = [book = m_bytes, name, bytes](const void*) { (*book)[name] -= bytes; };
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
