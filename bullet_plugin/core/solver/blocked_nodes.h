// Finds nodes of a cloth that lie on obstacles that do not yield. Light cloth between such an obstacle and a heavy body
// would take hundreds of sweeps to hold the body: its nodes count as fixed against that body instead.
//
// Input: a cloth's contacts and its nodes' starts. Cost: linear in the contacts.
#pragma once

#include <vector>

#include "cloth_contacts.h"

namespace drape
{
class BlockedNodes
{
public:
    // Distance beyond the resting one, as a share of the thickness, within which cloth may meet an obstacle in a
    // substep.
    static constexpr float kNearBy = 0.25f;

    explicit BlockedNodes(const ClothContacts& contacts);
    // Returns whether an obstacle is behind the node, seen from where the normal comes from. normal: unit.
    bool isBlocked(int node, Vec3 normal) const;

private:
    std::vector<Vec3> m_normals;  // by node: sum over its contacts; empty without contacts
};
}  // namespace drape
