#include "supported_nodes.h"

#include <algorithm>

namespace drape
{
namespace
{
// Minimum weight of a node in a contact by which it lies on something, or something lies on it.
constexpr float kLeastWeight = 0.2f;

// Least cosine of the angle between a push and the direction into what holds a node.
constexpr float kLeastCosine = 0.7f;

// Returns whether what holds a node does so against a push along the normal.
bool holds(const NodeSupport& support, Vec3 normal)
{
    return vec3Dot(support.m_normals, normal) < -kLeastCosine * vec3Length(support.m_normals);
}

void addTo(NodeSupport& support, Vec3 normal, float advance, int level)
{
    support.m_normals = vec3Add(support.m_normals, normal);
    support.m_advance = std::max(support.m_advance, advance);
    support.m_level = level;
}
}  // namespace

void SupportedNodes::clear()
{
    m_byCloth.clear();
    m_layers.clear();
}

void SupportedNodes::add(const ClothContacts& cloth, const ContactSource& source)
{
    std::vector<NodeSupport>& supports = m_byCloth[&cloth.m_nodes];
    supports.assign(cloth.m_nodes.count(), NodeSupport());
    const float near = (1 + kNearBy) * cloth.m_mostThickness;
    for (const FeatureContacts& feature : cloth.m_features)
        for (std::uint32_t i = 0; i < feature.m_count; ++i)
        {
            if (feature.m_contacts[i].m_gap0 > near) continue;
            const SolverContact contact = cloth.resolve(source, feature.m_contacts[i]);
            const Vec3 normal = contact.m_plane.m_normal;
            const float recovered = contact.m_gaps.m_target - contact.m_gaps.m_start;
            for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
            {
                if (!(contact.m_plane.m_weights[k] > kLeastWeight)) continue;
                const std::size_t node = std::size_t(contact.m_nodes[k]);
                const Vec3 start = cloth.m_nodes.start(node);
                const Vec3 carried = vec3Sub(contact.m_carry.start(node, start), start);
                addTo(supports[node], normal, vec3Dot(normal, carried) + std::max(0.0f, recovered), 0);
            }
        }
}

NodeSupport* SupportedNodes::find(const SolverNodes* cloth, std::uint32_t node)
{
    const auto found = m_byCloth.find(cloth);
    return found == m_byCloth.end() ? nullptr : &found->second[node];
}

// Lets one feature of a contact lie on the other if that is held. Returns whether a node is held newly.
bool SupportedNodes::spread(const LayerContact& contact, bool fromSecond, int level)
{
    const int first = fromSecond ? contact.m_split : 0, last = fromSecond ? 4 : contact.m_split;
    const Vec3 normal = vec3Scale(contact.m_normal, fromSecond ? 1.0f : -1.0f);
    float advance = 0;
    for (int k = first; k < last; ++k)
    {
        if (!(contact.m_weights[k] > kLeastWeight)) continue;
        const NodeSupport* const support = find(contact.m_cloths[k], contact.m_nodes[k]);
        const bool isHeld = support && support->m_level >= 0 && support->m_level < level;
        if (!isHeld || !holds(*support, vec3Scale(normal, -1))) return false;
        advance = std::max(advance, support->m_advance);
    }
    bool any = false;
    for (int k = 0; k < 4; ++k)
    {
        if ((k >= first && k < last) || !(contact.m_weights[k] > kLeastWeight)) continue;
        NodeSupport* const support = find(contact.m_cloths[k], contact.m_nodes[k]);
        if (!support || (support->m_level >= 0 && support->m_level < level)) continue;
        addTo(*support, normal, advance + contact.m_recover, level);
        any = true;
    }
    return any;
}

void SupportedNodes::spread()
{
    for (const LayerContact& contact : m_layers)
        for (const SolverNodes* cloth : contact.m_cloths)
            if (cloth) m_byCloth[cloth].resize(cloth->count());
    bool any = true;
    for (int level = 1; any; ++level)
    {
        any = false;
        for (const LayerContact& contact : m_layers)
            for (const bool fromSecond : {true, false})
                any = spread(contact, fromSecond, level) || any;
    }
}

const NodeSupport* SupportedNodes::against(const SolverNodes& cloth, int node, Vec3 normal) const
{
    const auto found = m_byCloth.find(&cloth);
    if (found == m_byCloth.end()) return nullptr;
    const NodeSupport& support = found->second[std::size_t(node)];
    return support.m_level >= 0 && holds(support, normal) ? &support : nullptr;
}
}  // namespace drape
