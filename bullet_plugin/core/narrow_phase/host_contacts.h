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
class HostContactFinder
{
public:
    struct Limits
    {
        std::size_t m_contacts;
        std::size_t m_swept;  // tests that the continuous test decides
    };

    // Lists the contacts of input.m_tests, unsorted, and counts them; beyond a limit the list is not complete.
    // findContacts, findSwept: kernels of either kind of contacts; swept: their counter. Returns how often the list was
    // too short and grew.
    template <class Input>
    std::size_t find(FeatureKernel<Input> findContacts, FeatureKernel<Input> findSwept,
                     std::uint32_t StepCounters::*swept, const Input& input, std::size_t features, Limits limits,
                     ThreadTeam& threads, StepCounters& counters)
    {
        if (m_contacts.empty()) m_contacts.resize(kFirstContacts);
        if (m_swept.size() < input.m_count) resizeGrowing(m_swept, input.m_count);
        const auto fill = [&]() -> std::size_t
        {
            m_featureCounts.assign(features, 0);
            counters.m_contactsFound = counters.*swept = 0;
            const ContactSink sink = {m_contacts.data(), std::uint32_t(m_contacts.size()),
                                      nullptr,           m_featureCounts.data(),
                                      nullptr,           &counters.m_contactsFound};
            const auto run = [&](FeatureKernel<Input> kernel, std::size_t items, bool worth)
            {
                runShared(threads, worth, items,
                          [&](std::size_t item) {
                              kernel(std::uint32_t(item), std::uint32_t(items), input, sink, m_swept.data(), &counters);
                          });
            };
            run(findContacts, (input.m_count + kTestsOfItem - 1) / kTestsOfItem, input.m_count >= kLeastShared);
            const std::uint32_t left = counters.*swept;
            if (left > limits.m_swept) return 0;
            if (left > 0) run(findSwept, kSweptItems, left >= kLeastSweptShared);
            return counters.m_contactsFound;
        };
        return fillGrowing(m_contacts, limits.m_contacts, fill);
    }

    // Appends the `count` unsorted contacts, which are all that were found, to the existing ones.
    void order(std::size_t count, std::vector<Contact>& contacts, ThreadTeam& threads)
    {
        orderContacts(m_contacts.data(), count, m_featureCounts, contacts, threads);
    }

    // Releases the memory of the results.
    void giveBackRoom()
    {
        m_contacts = std::vector<Contact>();
        m_featureCounts = std::vector<std::uint32_t>();
        m_swept = std::vector<std::uint32_t>();
    }

private:
    static constexpr std::size_t kFirstContacts = 1 << 10;
    static constexpr std::size_t kTestsOfItem = 128;  // a run of them (item_runs.h)
    static constexpr std::size_t kSweptItems = 32;
    // Minimum tests for waking threads; that many take a fifth of a millisecond.
    static constexpr std::size_t kLeastShared = 1 << 10;
    static constexpr std::size_t kLeastSweptShared = 1 << 6;

    std::vector<Contact> m_contacts;
    std::vector<std::uint32_t> m_featureCounts;  // number of contacts by feature
    std::vector<std::uint32_t> m_swept;          // tests that the continuous test decides
};
}  // namespace drape
