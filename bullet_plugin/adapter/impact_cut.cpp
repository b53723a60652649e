#include "bullet_plugin/adapter/impact_cut.h"

#include <algorithm>

namespace drape
{
namespace
{
// Distance before the surface at which a path ends, as a share of the thickness. It is near enough for every contact
// there and far enough from the other side.
constexpr btScalar kStandOff = btScalar(0.5);

// Returns the share of the path to keep: 1 when nothing was met or the cloth's point moves away.
btScalar shareLeft(const StepContact& contact)
{
    if (!(contact.m_time < 1) || contact.m_endGap >= contact.m_startGap) return 1;
    const btScalar distance = contact.m_startGap + contact.m_thickness;  // at the step's start
    const btScalar standOff = kStandOff * contact.m_thickness;
    return distance > standOff ? contact.m_time * (1 - standOff / distance) : btScalar(0);
}

// The kept share of a node's path, relative to the obstacle of its first impact.
struct Left
{
    btScalar m_share = 1;
    const btTransform* m_carry = nullptr;
    const btVector3* m_carriedStarts = nullptr;

    void take(const Left& other)
    {
        if (other.m_share < m_share) *this = other;
    }
};

void shorten(btSoftBody& body, const NodePaths& paths, int index, const Left& left, btScalar velocityScale)
{
    btSoftBody::Node& node = body.m_nodes[index];
    const btVector3 start =
        carriedStart(left.m_carry, left.m_carriedStarts, index, paths.m_start[static_cast<std::size_t>(index)]);
    const btVector3 shift = (node.m_x - start) * (left.m_share - 1);
    node.m_x += shift;
    node.m_v += shift * velocityScale;
}
}  // namespace

bool anyCuts(const std::vector<StepContact>& contacts)
{
    return std::any_of(contacts.begin(), contacts.end(),
                       [](const StepContact& contact) { return shareLeft(contact) < 1; });
}

bool cutAtImpacts(btSoftBody& body, const NodePaths& paths, const std::vector<StepContact>& contacts, Cut cut)
{
    if (contacts.empty()) return false;
    std::vector<Left> left(static_cast<std::size_t>(body.m_nodes.size()));
    Left least;
    for (const StepContact& contact : contacts)
    {
        const Left own{shareLeft(contact), contact.m_carry, contact.m_carriedStarts};
        least.take(own);
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
            left[static_cast<std::size_t>(contact.m_nodes[k])].take(own);
    }
    if (!(least.m_share < 1)) return false;
    const btScalar velocityScale = body.m_sst.isdt * (1 - body.m_cfg.kDP);
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const Left& own = cut == Cut::WholeBody ? least : left[static_cast<std::size_t>(i)];
        if (own.m_share < 1 && movableInverseMass(body.m_nodes[i]) > 0) shorten(body, paths, i, own, velocityScale);
    }
    return true;
}
}  // namespace drape
