// Seeded random numbers for scenes: the same seed gives the same numbers on every machine.
#pragma once

#include <cstdint>

namespace drape
{
// xorshift32 (Marsaglia 2003, triple 13-17-5) after a multiplicative mix, so that small seeds differ at once.
class Random
{
public:
    explicit Random(std::uint32_t number) : m_state((number * 2654435761u) ^ 0x5bd1e995u) { m_state += m_state == 0; }
    double unit()
    {
        m_state ^= m_state << 13;
        m_state ^= m_state >> 17;
        m_state ^= m_state << 5;
        return m_state * (1.0 / 4294967296.0);
    }
    double within(double low, double high) { return low + (high - low) * unit(); }

private:
    std::uint32_t m_state;
};
}  // namespace drape
