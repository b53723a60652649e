// Narrow phase on the host with a CPU's kernels (cpu_kernels.h), on a team's threads: turns a list of tests into
// unsorted contacts, and these into contacts in canonical order.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/ordering/canonical_order.h"
#include "bullet_plugin/core/cpu/cpu_kernels.h"
#include "bullet_plugin/core/scene/growing_arrays.h"
#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
class HostHitFinder
{
public:
    struct Limits
    {
        std::size_t m_hits;
        std::size_t m_swept;  // tests that the continuous test decides
    };

    // Lists the contacts of features.m_tests, unsorted, and counts them; beyond a limit the list is not complete.
    // find, findSwept: kernels of either kind of contacts; swept: their counter. Returns how often the list was too
    // short and grew.
    template <class Features>
    std::size_t find(HitKernel<Features> find, HitKernel<Features> findSwept, std::uint32_t StepCounters::*swept,
                     const Features& features, std::size_t slots, Limits limits, ThreadTeam& threads,
                     StepCounters& counters)
    {
        if (m_hits.empty()) m_hits.resize(kFirstHits);
        if (m_swept.size() < features.m_count) resizeGrowing(m_swept, features.m_count);
        const auto fill = [&]() -> std::size_t
        {
            m_slotCount.assign(slots, 0);
            counters.m_contactsFound = counters.*swept = 0;
            const HostHits list = {m_hits.data(), std::uint32_t(m_hits.size()), m_slotCount.data()};
            const auto run = [&](HitKernel<Features> kernel, std::size_t items, bool worth)
            {
                runShared(
                    threads, worth, items,
                    [&](std::size_t item)
                    { kernel(std::uint32_t(item), std::uint32_t(items), features, list, m_swept.data(), &counters); });
            };
            run(find, (features.m_count + kTestsOfItem - 1) / kTestsOfItem, features.m_count >= kLeastShared);
            const std::uint32_t left = counters.*swept;
            if (left > limits.m_swept) return 0;
            if (left > 0) run(findSwept, kSweptItems, left >= kLeastSweptShared);
            return counters.m_contactsFound;
        };
        return fillGrowing(m_hits, limits.m_hits, fill);
    }

    // Appends the `count` unsorted contacts, which are all that were found, to the existing ones.
    void order(std::size_t count, std::vector<Contact>& contacts, ThreadTeam& threads)
    {
        orderHits(m_hits.data(), count, m_slotCount, contacts, threads);
    }

    // Releases the memory of the results.
    void giveBackRoom()
    {
        m_hits = std::vector<Contact>();
        m_slotCount = std::vector<std::uint32_t>();
        m_swept = std::vector<std::uint32_t>();
    }

private:
    static constexpr std::size_t kFirstHits = 1 << 10;
    static constexpr std::size_t kTestsOfItem = 128;  // a run of them (item_runs.h)
    static constexpr std::size_t kSweptItems = 32;
    // Minimum tests for waking threads; that many take a fifth of a millisecond.
    static constexpr std::size_t kLeastShared = 1 << 10;
    static constexpr std::size_t kLeastSweptShared = 1 << 6;

    std::vector<Contact> m_hits;
    std::vector<std::uint32_t> m_slotCount;  // number of contacts by slot
    std::vector<std::uint32_t> m_swept;      // tests that the continuous test decides
};
}  // namespace drape
