// Runs work for the groups of a complete binary tree, numbered as a heap: 1 for all, children 2 g and 2 g + 1 for group
// g. A group follows both of its halves, whichever threads run them. Groups of which neither contains the other run in
// any order, so their work must be independent. Cost: some 50 ns per group.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
class GroupClimb
{
public:
    // leafCount: a power of two; there are less than twice as many groups.
    void resize(std::size_t leafCount)
    {
        if (leafCount == m_leafCount && m_halfDone) return;
        m_leafCount = leafCount;
        m_halfDone.reset(new std::atomic<bool>[2 * leafCount]);
        for (std::size_t group = 0; group < 2 * leafCount; ++group)
            m_halfDone[group] = false;
    }
    std::size_t leafCount() const { return m_leafCount; }

    // Calls work(group) once for each group. threads: null for the caller alone.
    template <class Work>
    void run(ThreadTeam* threads, const Work& work)
    {
        const auto climbFrom = [&](std::size_t leaf) { climb(leaf, work); };
        if (threads) return threads->run(m_leafCount, climbFrom);
        for (std::size_t leaf = 0; leaf < m_leafCount; ++leaf)
            climbFrom(leaf);
    }

private:
    template <class Work>
    void climb(std::size_t leaf, const Work& work)
    {
        for (std::size_t group = m_leafCount + leaf;; group /= 2)
        {
            work(group);
            // The second half to finish continues, and sees what the first one wrote.
            if (group == 1 || !m_halfDone[group / 2].exchange(true, std::memory_order_acq_rel)) return;
            m_halfDone[group / 2].store(false, std::memory_order_relaxed);
        }
    }

    std::size_t m_leafCount = 1;
    std::unique_ptr<std::atomic<bool>[]> m_halfDone;  // by group: one of its halves is done in this run
};
}  // namespace drape
