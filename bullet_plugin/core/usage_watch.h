// When memory that is kept from step to step is worth giving back.
//
// Arrays keep their room, because a scene needs about as much in one step as in the one before. Where it has needed no
// more than a quarter of its most for kWindow steps, ten seconds at 60 a second, the room is given back once. So memory
// is bounded by what the last ten seconds needed, and a scene that stays as it is never pays. Cost: a comparison a
// step.
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
    static constexpr std::size_t kLeast = 1 << 12;  // elements that are kept in any case

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
