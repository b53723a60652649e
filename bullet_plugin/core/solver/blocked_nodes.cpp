#include "blocked_nodes.h"

namespace drape
{
namespace
{
// Minimum weight of a node in a contact by which it lies on an obstacle.
constexpr float kLeastWeight = 0.2f;

// Least cosine of the angle between a push and the direction into the obstacle.
constexpr float kLeastCosine = 0.7f;
}  // namespace

BlockedNodes::BlockedNodes(const ClothContacts& contacts)
{
    if (contacts.m_features.empty()) return;
    m_normals.assign(contacts.m_nodes.count(), vec3(0, 0, 0));
    const float near = (1 + kNearBy) * contacts.m_mostThickness;
    for (const FeatureContacts& feature : contacts.m_features)
        for (std::uint32_t i = 0; i < feature.m_count; ++i)
        {
            const Contact& contact = feature.m_contacts[i];
            if (contact.m_gap0 > near) continue;
            for (int k = 0; k < 3 && feature.nodes()[k] >= 0; ++k)
            {
                Vec3& sum = m_normals[std::size_t(feature.nodes()[k])];
                if (contact.m_weights[k] > kLeastWeight) sum = vec3Add(sum, vec3Load(contact.m_normal, 0));
            }
        }
}

bool BlockedNodes::isBlocked(int node, Vec3 normal) const
{
    if (m_normals.empty()) return false;
    const Vec3 sum = m_normals[std::size_t(node)];
    return vec3Dot(sum, normal) < -kLeastCosine * vec3Length(sum);
}
}  // namespace drape
