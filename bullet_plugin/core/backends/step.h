// Input and output of a step, common to the host and device back ends.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/scene/mesh_pool.h"
#include "bullet_plugin/core/pipeline/pipeline.h"
#include "bullet_plugin/core/cloth_cloth/self_step.h"
#include "kernels/lib/pair_contact.h"
#include "ordinary_work.h"
#include "drape/settings.h"

namespace drape
{
// The joined cloth nodes, x y z each, m, at a step's start and at its end. They are adjacent, so that one transfer can
// upload both. Contents are lost when they grow.
class ClothNodes
{
public:
    float* start() { return m_floats.data(); }
    float* end() { return m_floats.data() + m_room; }
    const float* start() const { return m_floats.data(); }
    const float* end() const { return m_floats.data() + m_room; }
    // Floats of each.
    std::size_t room() const { return m_room; }
    // device may be null.
    void reserve(Device* device, std::size_t floats)
    {
        if (m_room >= floats && m_room > 0) return;
        constexpr std::size_t kStep = 1024;  // few distinct sizes, so that small additions need no new memory
        m_room = std::max((floats + kStep - 1) / kStep, std::size_t(1)) * kStep;
        m_floats.reserve(device, 2 * m_room);
    }

private:
    Staging<float> m_floats;
    std::size_t m_room = 0;
};

// Meshes of both sides and, per side, the data of the joined arrays.
struct Scene
{
    MeshPool m_cloths;
    MeshPool m_obstacles;
    ClothNodes m_clothNodes;
    bool m_anySelf = false;                  // true if a cloth collides with itself
    std::vector<float> m_clothRest;          // m, joined, at rest; empty without m_anySelf
    std::vector<float> m_obstaclePositions;  // m, joined, as given
    std::vector<NormalCone> m_vertexCones;   // joined, as the positions
    std::vector<NormalCone> m_edgeCones;
    std::uint32_t m_obstacleMotion = 0;   // counts up when an obstacle gets new positions
    std::vector<ObstaclePlace> m_places;  // per obstacle slot
    std::uint32_t m_obstaclePlacing = 0;  // counts up when a place changes
    bool m_anyPosed = false;              // false: all positions are the world's; stays while there are obstacles

    std::size_t slotCount() const
    {
        return m_cloths.vertexCount() + m_cloths.triangles().size() + m_cloths.edges().size();
    }
    // Counts the slots, and as many behind them for contacts of cloths with themselves if there can be any.
    std::size_t allSlotCount() const { return m_anySelf ? 2 * slotCount() : slotCount(); }
};

// The cloths as kernels see them.
inline ClothView clothView(const Scene& scene, const Settings& settings)
{
    const MeshPool& cloths = scene.m_cloths;
    return clothView(scene.m_clothNodes.start(), scene.m_clothNodes.end(), cloths.triangles().data(),
                     cloths.edges().data(), std::uint32_t(cloths.vertexCount()),
                     std::uint32_t(cloths.triangles().size()), std::uint32_t(settings.m_mode), nullptr);
}

// Most candidates and contacts that a step can have: their numbers stay countable in 32 bits.
constexpr std::size_t kMostCandidates = std::size_t(1) << 28;

// Maximum lengths of a step's lists.
struct StepLimits
{
    explicit StepLimits(const Settings& settings)
        : m_candidates(std::min(settings.m_candidateLimit, kMostCandidates)),
          m_contacts(std::min(settings.m_contactLimit, kMostCandidates))
    {
    }
    std::size_t m_candidates;
    std::size_t m_contacts;
};

// The pairs of one step.
struct StepPairs
{
    std::vector<float> m_thickness;         // m, cloth slots × obstacle slots, -1 without a pair
    std::vector<float> m_clothRadius;       // m, per cloth slot: the largest reach of its pairs, -1 without one
    std::vector<ObstacleMotion> m_motions;  // motions of the moving obstacles with a pair, in the order of slots
    std::vector<TestLimits> m_ordinary;     // per cloth slot: what its pairs need in ordinary motion
    TestLimits m_limits;                    // the step's limits, over patches
    SelfReach m_self;
    bool m_anyPair = false;  // cloth and obstacle
    bool m_anySelf = false;  // cloth and itself
    bool m_any = false;      // either

    // Returns the number of obstacle slots when the pairs were collected.
    std::size_t obstacleSlots() const { return m_thickness.size() / m_clothRadius.size(); }
    float thickness(std::size_t cloth, std::size_t obstacle) const
    {
        return m_thickness[cloth * obstacleSlots() + obstacle];
    }
    // Removes a cloth from the step.
    void leaveOut(std::size_t cloth)
    {
        const std::size_t obstacles = obstacleSlots();
        std::fill_n(m_thickness.begin() + std::ptrdiff_t(cloth * obstacles), obstacles, -1.0f);
        m_clothRadius[cloth] = -1.0f;
        m_anyPair =
            std::any_of(m_clothRadius.begin(), m_clothRadius.end(), [](float radius) { return radius >= 0.0f; });
        m_self.leaveOut(cloth);
        m_anySelf = m_self.any();
        m_any = m_anyPair || m_anySelf;
    }
};

struct StepResult
{
    std::vector<Contact> m_contacts;  // the host's contacts
    ContactList m_deviceContacts;     // the device back end's memory, until its next step
    // More candidates or contacts than the limits allow; only m_contactDemand of the result is valid then.
    bool m_overLimit = false;
    bool m_overTests = false;           // these are the limits of StepPairs
    std::uint64_t m_contactDemand = 0;  // number of contacts if they exceeded the limit; 0 if candidates did
    std::size_t m_candidates = 0;
    std::size_t m_sweptTests = 0;
    std::size_t m_selfCandidates = 0;
    std::size_t m_selfSweptTests = 0;
    std::size_t m_invalidNodes = 0;
    std::size_t m_retries = 0;
    double m_refitMs = 0, m_broadMs = 0, m_narrowMs = 0;  // on the host back end

    // Resets the result; the memory of the host's contacts is kept.
    void clear()
    {
        std::vector<Contact> contacts = std::move(m_contacts);
        contacts.clear();
        *this = StepResult();
        m_contacts = std::move(contacts);
    }

    // Returns contacts with obstacles, then those of cloths with themselves.
    ContactList allContacts() const
    {
        return m_contacts.empty() ? m_deviceContacts : ContactList{m_contacts.data(), m_contacts.size()};
    }
    ContactList contacts() const
    {
        const ContactList all = allContacts();
        return {all.m_first, std::size_t(firstSelf(all) - all.begin())};
    }
    ContactList selfContacts() const
    {
        const ContactList all = allContacts();
        const Contact* first = firstSelf(all);
        return {first, std::size_t(all.end() - first)};
    }

private:
    static const Contact* firstSelf(ContactList all)
    {
        return std::partition_point(all.begin(), all.end(),
                                    [](const Contact& contact) { return contact.m_kind < DRAPE_SELF_NODE_FACE; });
    }
};
}  // namespace drape
