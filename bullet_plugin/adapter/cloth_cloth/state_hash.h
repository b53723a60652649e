// A number that changes with what was added to it, to notice that something has changed since the last step.
#pragma once

#include <cstdint>

namespace drape
{
// FNV-1a over words.
class StateHash
{
public:
    StateHash& add(std::uint64_t value)
    {
        m_value = (m_value ^ value) * 0x100000001b3ull;
        return *this;
    }
    StateHash& add(const void* address) { return add(std::uint64_t(reinterpret_cast<std::uintptr_t>(address))); }
    std::uint64_t value() const { return m_value; }

private:
    std::uint64_t m_value = 0xcbf29ce484222325ull;
};
}  // namespace drape
