// The searches of a ClothSet on a device: contacts of cloth with cloth, and pairs of features for the guard.
//
// Input: a scene with the set as its only mesh, and its nodes at the step's start and end. Output: as
// SelfContactStage's. Guarantee: the host's contacts, bit for bit; of pairs, all that the host lists, and those of
// patches that lie smoothly (SmoothPairs), which the host leaves out. Cost: one submission and one wait for each
// search. Lists that are too short grow, and the search runs again.
//
// Shares the device and its queue with the pipeline. Errors: in the device.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bullet_plugin/core/cloth_cloth/self_contacts.h"
#include "bullet_plugin/core/device/program_set.h"
#include "bullet_plugin/core/ordering/ordering.h"
#include "cloth_store.h"

namespace drape
{
// The continuous test decides about pairs that may meet, and about no others: it finds the same contacts as for all.
constexpr std::uint32_t kClothSearchMode = DRAPE_AUTOMATIC;

// A device and its programs; null for none.
struct SearchDevice
{
    std::shared_ptr<Device> m_device;
    std::shared_ptr<ProgramSet> m_programs;
};

class DeviceClothSearch
{
public:
    // Builds the kernels, unless the programs are there.
    explicit DeviceClothSearch(const SearchDevice& device);
    // Waits for transfers into memory that is about to be released.
    ~DeviceClothSearch();

    Device* device() const { return m_device.get(); }

    // Waits until no transfer reads the scene.
    void wait();
    // Uploads the next scene anew.
    void forgetScene() { m_cloths.forget(); }

    // Finds the contacts along the paths, in canonical order. reachScale: reach per thickness. limit: of pairs of
    // features. most: of contacts. Returns false, with no contacts, if the device failed or has no room, or if there
    // are more: the host knows fewer pairs, and decides.
    bool findContacts(const Scene& scene, const SelfReach& reach, float reachScale, std::uint64_t limit,
                      std::uint64_t most, std::vector<Contact>& contacts);
    // Begins the search for pairs of features whose paths come within the reach, and ends it. As above; in any order.
    void submitPairs(const Scene& scene, const SelfReach& reach, std::uint64_t limit);
    bool finishPairs(std::vector<FeatureTest>& pairs);

private:
    void begin(const Scene& scene, const SelfReach& reach, float reachScale, std::uint64_t limit);
    void enqueueContacts();
    void enqueuePairs();
    // Waits, and runs the search again while lists were too short. Returns false if it cannot end.
    template <class Enqueue>
    bool complete(const Enqueue& enqueue);
    bool grow();
    SelfContactStage::Input input() const;

    std::shared_ptr<Device> m_device;  // the last to go
    std::shared_ptr<ProgramSet> m_programs;
    ClothStore m_cloths;
    SelfContactStage m_self;
    OrderingStage m_ordering;
    UnsortedContacts m_unsorted;
    Buffer<StepCounters> m_counters{"step counters"}, m_nextCounters{"step counters"};
    Buffer<float> m_noObstacles{"cloth meshes"};
    Staging<StepCounters> m_countersRead;
    Staging<Contact> m_contactsRead;  // behind a head as on the device
    Staging<FeatureTest> m_pairsRead;
    std::size_t m_contactsAsked = 0, m_pairsAsked = 0;  // read before their number is known
    float m_reachScale = 1;
    std::uint64_t m_limit = 0, m_mostContacts = 0;
};
}  // namespace drape
