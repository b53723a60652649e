// A step of cloths with themselves, common to the host and devices; kernels/lib/cloth_cloth/self_contact.h defines
// contacts.
//
// Input: the cloths' nodes at the step's start, its end and at rest, and the thickness per cloth. Output: contacts in
// canonical order behind those with obstacles. Guarantee: no pair that gives a contact is missed; all back ends find
// the same contacts, bit for bit. They also list the same candidates, unless the last bit of a bound decides about a
// box or a patch, far beyond the contacts' reach.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_plugin/core/scene/mesh_pool.h"
#include "kernels/lib/cloth_cloth/self_contact.h"

namespace drape
{
// Values per cloth slot, m.
struct SelfReach
{
    std::vector<float> m_thickness;  // negative: the cloth is not tested against itself in the step
    std::vector<float> m_radius;     // half of the contacts' reach, rounded up; negative: as above

    bool any() const;
    void leaveOut(std::size_t cloth);
};

// Returns the radius, m, that grows features' volumes for contacts that reach to `reach`.
float selfGrowth(float reach);

// Data of a step of the cloths on the host.
struct SelfStep
{
    const MeshPool& m_cloths;
    SelfView m_view;
    const SelfReach& m_reach;
    const std::vector<float>& m_obstacleRadius;  // m, reach of the obstacle search, which counts invalid nodes; or -1
    float m_smoothShare = 0;  // pairs of patches that keep this share of their distance at rest are left out; 0: none

    // Positions where volumes over the step begin: those of the end in a discrete step.
    const float* start() const;
};

// Maximum lengths of a step's lists. Beyond them there are no contacts, and counts are too low.
struct SelfStepLimits
{
    std::uint64_t m_candidates = UINT64_MAX;
    std::uint64_t m_contacts = UINT64_MAX;
};

struct SelfCounts
{
    std::uint64_t m_candidates = 0;
    std::uint64_t m_contacts = 0;
    std::uint64_t m_swept = 0;         // candidates that the continuous test decided
    std::uint64_t m_invalidNodes = 0;  // invalid nodes of cloths that the obstacle search skips
    std::size_t m_retries = 0;         // for lists that were too short
    std::size_t m_smoothPairs = 0;     // pairs of patches that were left out
};
}  // namespace drape
