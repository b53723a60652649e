// Handles the results of a step on the device: grows lists that were too small, enforces limits and reads contacts.
#include <algorithm>
#include <cstring>

#include "device_backend.h"
#include "step_limits.h"
#include "write_counts.h"

namespace drape
{
namespace
{
// Number of steps, after one with crowded features, that sort the contacts of such features. Without the sort such a
// step runs twice.
constexpr int kStepsToOrder = 64;
}  // namespace

void DeviceBackend::readContacts(std::size_t count)
{
    m_ordering.contacts().read(*m_device, m_contactsRead->data(), DRAPE_CONTACT_HEAD + count);
}

StepCounters DeviceBackend::countersRead() const
{
    StepCounters counters;
    static_assert(sizeof(counters) <= DRAPE_CONTACT_HEAD * sizeof(Contact));
    std::memcpy(&counters, m_contactsRead->data(), sizeof(counters));
    return counters;
}

// Records the counts that determine the next launches.
void DeviceBackend::takeCounts(const StepCounters& counters)
{
    m_testsBefore = counters.m_candidates;
    m_contactsBefore = counters.m_contactsFound;
}

bool DeviceBackend::overLimit(const StepPairs& pairs, StepResult& result)
{
    const StepCounters counters = countersRead();
    const StepLimits limits(m_settings);
    const std::size_t mostTests = std::min(limits.m_candidates, pairs.m_limits.m_tests);
    // All contacts are found only if every candidate was in the list.
    const bool ofObstacles =
        counters.m_patchPairs <= m_patchCull.pairs().capacity() && counters.m_candidates <= m_tests.capacity();
    const bool ofSelf =
        counters.m_selfPairs <= m_self.pairs().capacity() && counters.m_selfTests <= m_self.tests().capacity();
    if (counters.m_candidates > mostTests && mostTests < limits.m_candidates)
    {
        result.m_overLimit = result.m_overTests = true;
    }
    else if (std::max({counters.m_candidates, counters.m_patchPairs, counters.m_selfPairs, counters.m_selfTests}) >
             limits.m_candidates)
    {
        result.m_overLimit = true;
    }
    else if (ofObstacles && counters.m_swept > pairs.m_limits.m_swept)
    {
        result.m_overLimit = result.m_overTests = true;
    }
    else if (ofObstacles && ofSelf && counters.m_contactsFound > limits.m_contacts)
    {
        result.m_overLimit = true;
        result.m_contactDemand = counters.m_contactsFound;
    }
    return result.m_overLimit;
}

bool DeviceBackend::grow()
{
    const StepCounters counters = countersRead();
    const std::size_t largest = m_device->maxAllocationBytes();
    bool again = false;
    const auto demand = [&](std::size_t wanted, std::size_t capacity, std::size_t elementBytes, auto reserve)
    {
        if (wanted <= capacity) return;
        again = true;
        const std::size_t most = largest / elementBytes - DRAPE_CONTACT_HEAD;  // contacts have a head before them
        m_limitReached = m_limitReached || wanted > most;
        if (!m_limitReached) reserve(std::min(withHeadroom(wanted), most));
    };
    Device& device = *m_device;
    demand(counters.m_patchPairs, m_patchCull.pairs().capacity(), sizeof(FeatureTest),
           [&](std::size_t count) { m_patchCull.reservePairs(device, count); });
    demand(counters.m_candidates, m_tests.capacity(), sizeof(FeatureTest),
           [&](std::size_t count) { m_tests.reserve(device, count); });
    demand(counters.m_selfPairs, m_self.pairs().capacity(), sizeof(Candidate),
           [&](std::size_t count) { m_self.reservePairs(device, count); });
    demand(counters.m_selfTests, m_self.tests().capacity(), sizeof(FeatureTest),
           [&](std::size_t count) { m_self.tests().reserve(device, count); });
    demand(std::min(std::size_t(counters.m_contactsFound), StepLimits(m_settings).m_contacts), m_unsorted.capacity(),
           sizeof(Contact), [&](std::size_t count) { reserveContacts(count); });
    if (counters.m_crowded > 0)
    {
        again |= m_stepsToOrder == 0;
        m_stepsToOrder = kStepsToOrder;
    }
    else if (m_stepsToOrder > 0)
        --m_stepsToOrder;
    return again;
}

bool DeviceBackend::finish(const Scene& scene, const StepPairs& pairs, StepResult& result, StepStatistics& statistics)
{
    result = StepResult();
    m_device->wait();
    while (!m_device->failed())
    {
        if (overLimit(pairs, result)) return true;
        // Not done, for another kind of launch: no list was too small.
        const bool skipped = m_narrowPhase.skipped(countersRead().m_candidates);
        const bool grown = grow();
        if (!grown && !skipped) break;
        if (m_limitReached) return false;
        if (grown) ++statistics.m_retries;
        result.m_isRepeated = true;
        takeCounts(countersRead());
        enqueueStep(scene, pairs);
        m_device->wait();
    }
    if (m_device->failed()) return false;
    takeCounts(countersRead());
    writeCounts(countersRead(), statistics);
    result.m_countOnDevice = countersRead().m_contactsStored;
    result.m_isOnDevice = m_place == ContactPlace::Device;
    if (!result.m_isOnDevice) readAll(result, m_contactsAsked);
    return !m_device->failed();
}

bool DeviceBackend::bringContacts(StepResult& result)
{
    readAll(result, 0);
    result.m_isOnDevice = false;
    return !m_device->failed();
}

void DeviceBackend::readAll(StepResult& result, std::size_t read)
{
    const std::size_t count = result.m_countOnDevice;
    if (count > read)
    {
        m_contactsRead->reserve(m_device.get(), DRAPE_CONTACT_HEAD + withHeadroom(count));
        readContacts(count);
        m_device->wait();
    }
    result.m_deviceContacts = ContactList{m_contactsRead->data() + DRAPE_CONTACT_HEAD, count};
    m_contactsAsked =
        std::min({count + count / 16 + 256, m_contactsRead->capacity() - DRAPE_CONTACT_HEAD, m_unsorted.capacity()});
}
}  // namespace drape
