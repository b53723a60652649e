// Decides when to release memory that is kept from step to step.
//
// Arrays keep their capacity, because successive steps need about the same. If a scene has needed at most a quarter
// of its maximum for kWindow steps, ten seconds at 60 a second, the memory is released once. Memory is therefore
// bounded by the needs of the last ten seconds, and a steady scene pays nothing. Cost: a comparison per step.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

namespace drape
{
class UsageWatch
{
public:
    static constexpr int kWindow = 600;  // steps
    static constexpr std::size_t kShare = 4;
    static constexpr std::size_t kLeast = 1 << 12;  // elements that are always kept

    // Records the number of elements that a step used; call once a step. Returns whether the memory of earlier steps
    // should be released now.
    bool hasFallen(std::size_t used)
    {
        m_most = std::max(m_most, used);
        m_mostOfWindow = std::max(m_mostOfWindow, used);
        if (++m_step < kWindow) return false;
        const std::size_t most = m_most, ofWindow = std::exchange(m_mostOfWindow, 0);
        m_step = 0;
        if (most < kLeast || ofWindow > most / kShare) return false;
        m_most = ofWindow;
        return true;
    }

private:
    int m_step = 0;
    std::size_t m_most = 0, m_mostOfWindow = 0;
};
}  // namespace drape
