#include "device_cloth_search.h"

#include <algorithm>

#include "step_limits.h"

namespace drape
{
namespace
{
// First guesses; they grow to the scenes' needs.
constexpr std::size_t kFirstContacts = 1 << 13, kFirstPairs = 1 << 13;
constexpr cl_uint kMinusOne = 0xbf800000u;  // -1.0f
}  // namespace

DeviceClothSearch::DeviceClothSearch(const SearchDevice& device)
    : m_device(device.m_device), m_programs(device.m_programs)
{
    m_self.create(*m_device, m_programs->loader());
    m_ordering.create(*m_device, m_programs->loader());
    m_counters.reserve(*m_device, 1);
    m_nextCounters.reserve(*m_device, 1);
    m_noObstacles.reserve(*m_device, 1);
    m_noObstacles.fill(*m_device, kMinusOne, 1);
    m_unsorted.reserve(*m_device, kFirstContacts);
    m_ordering.reserve(*m_device, kFirstContacts);
    m_countersRead.reserve(m_device.get(), 1);
    m_contactsRead.reserve(m_device.get(), DRAPE_CONTACT_HEAD + kFirstContacts);
    m_pairsRead.reserve(m_device.get(), kFirstPairs);
    m_device->wait();
}

DeviceClothSearch::~DeviceClothSearch()
{
    wait();
}

void DeviceClothSearch::wait()
{
    m_device->wait();
}

SelfContactStage::Input DeviceClothSearch::input() const
{
    return {m_cloths.cloths(), m_noObstacles, kClothSearchMode, m_reachScale, std::size_t(m_limit)};
}

// Uploads what the search needs.
void DeviceClothSearch::begin(const Scene& scene, const SelfReach& reach, float reachScale, std::uint64_t limit)
{
    m_reachScale = reachScale;
    m_limit = std::min<std::uint64_t>(limit, kMostCandidates);
    if (!m_cloths.knows(scene))
    {
        m_cloths.update(*m_device, scene);
        m_unsorted.resizeFeatures(*m_device, scene.allFeatureCount());
        m_ordering.resizeFeatures(*m_device, scene.allFeatureCount());
        m_self.setTopology(*m_device, scene.m_cloths, scene.m_clothRest);
    }
    m_self.setReach(*m_device, reach);
    m_cloths.writeNodes(*m_device, scene, 0, scene.m_cloths.vertexCount());
}

void DeviceClothSearch::enqueueContacts()
{
    m_counters.fill(*m_device, 0, 1);
    m_self.enqueueCull(*m_device, input(), m_counters);
    m_self.enqueueContacts(*m_device, input(), m_unsorted, m_counters);
    m_ordering.enqueue(*m_device, m_unsorted, {m_counters, m_nextCounters});
    m_ordering.contacts().read(*m_device, m_contactsRead.data(), DRAPE_CONTACT_HEAD + m_contactsAsked);
    m_counters.read(*m_device, m_countersRead.data(), 1);
    m_device->flush();
}

void DeviceClothSearch::enqueuePairs()
{
    m_counters.fill(*m_device, 0, 1);
    m_self.enqueueCull(*m_device, input(), m_counters);
    m_counters.read(*m_device, m_countersRead.data(), 1);
    m_self.tests().m_tests.read(*m_device, m_pairsRead.data(), m_pairsAsked);
    m_device->flush();
}

// Returns whether a list was too short and has room now.
bool DeviceClothSearch::grow()
{
    const StepCounters& counters = *m_countersRead.data();
    const std::size_t contacts = m_unsorted.capacity(), pairs = m_self.pairs().capacity();
    const std::size_t tests = m_self.tests().capacity();
    bool again = false;
    if (counters.m_contactsFound > contacts)
    {
        m_unsorted.reserve(*m_device, withHeadroom(counters.m_contactsFound));
        m_ordering.reserve(*m_device, withHeadroom(counters.m_contactsFound));
        again = true;
    }
    if (counters.m_selfPairs > pairs)
    {
        m_self.reservePairs(*m_device, withHeadroom(counters.m_selfPairs));
        again = true;
    }
    if (counters.m_selfTests > tests)
    {
        m_self.tests().reserve(*m_device, withHeadroom(counters.m_selfTests));
        again = true;
    }
    return again;
}

template <class Enqueue>
bool DeviceClothSearch::complete(const Enqueue& enqueue)
{
    for (;;)
    {
        m_device->wait();
        if (m_device->failed()) return false;
        const StepCounters& counters = *m_countersRead.data();
        const std::uint64_t most = m_device->maxAllocationBytes() / sizeof(Contact) / 2;
        if (std::max(counters.m_selfPairs, counters.m_selfTests) > std::min(m_limit, most)) return false;
        if (counters.m_contactsFound > std::min(m_mostContacts, most)) return false;
        if (!grow()) return true;
        enqueue();
    }
}

bool DeviceClothSearch::findContacts(const Scene& scene, const SelfReach& reach, float reachScale, std::uint64_t limit,
                                     std::uint64_t most, std::vector<Contact>& contacts)
{
    contacts.clear();
    m_mostContacts = most;
    if (m_device->failed()) return false;
    begin(scene, reach, reachScale, limit);
    enqueueContacts();
    if (!complete([this] { enqueueContacts(); })) return false;
    const std::size_t count = m_countersRead.data()->m_contactsStored;
    if (count > m_contactsAsked)
    {
        m_contactsRead.reserve(m_device.get(), DRAPE_CONTACT_HEAD + withHeadroom(count));
        m_ordering.contacts().read(*m_device, m_contactsRead.data(), DRAPE_CONTACT_HEAD + count);
        m_device->wait();
        if (m_device->failed()) return false;
    }
    const Contact* const first = m_contactsRead.data() + DRAPE_CONTACT_HEAD;
    contacts.assign(first, first + count);
    m_contactsAsked =
        std::min({count + count / 16 + 256, m_contactsRead.capacity() - DRAPE_CONTACT_HEAD, m_unsorted.capacity()});
    return true;
}

void DeviceClothSearch::submitPairs(const Scene& scene, const SelfReach& reach, std::uint64_t limit)
{
    if (m_device->failed()) return;
    begin(scene, reach, 1, limit);
    enqueuePairs();
}

bool DeviceClothSearch::finishPairs(std::vector<FeatureTest>& pairs)
{
    pairs.clear();
    if (!complete([this] { enqueuePairs(); })) return false;
    const std::size_t count = m_countersRead.data()->m_selfTests;
    if (count > m_pairsAsked)
    {
        m_pairsRead.reserve(m_device.get(), withHeadroom(count));
        m_self.tests().m_tests.read(*m_device, m_pairsRead.data(), count);
        m_device->wait();
        if (m_device->failed()) return false;
    }
    pairs.assign(m_pairsRead.data(), m_pairsRead.data() + count);
    m_pairsAsked = std::min({count + count / 16 + 256, m_pairsRead.capacity(), m_self.tests().capacity()});
    return true;
}
}  // namespace drape
