#include "bullet_plugin/adapter/impact_cut.h"

#include <algorithm>

namespace drape
{
namespace
{
// Distance before the surface at which a path ends, as a share of the thickness: near enough for every contact there,
// far enough from the other side.
constexpr btScalar kStandOff = btScalar(0.5);

// Motion of the contact's cloth point along the present paths.
btVector3 motionOf(const btSoftBody& body, const StepContact& contact)
{
    btVector3 sum(0, 0, 0);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
    {
        const btSoftBody::Node& node = body.m_nodes[contact.m_nodes[k]];
        sum += (node.m_x - node.m_q) * contact.m_weights[k];
    }
    return sum;
}

// Share of the path that is left, 1 when the contact cuts nothing.
btScalar shareLeft(const btSoftBody& body, const StepContact& contact, btScalar beyond)
{
    if (!(contact.m_time < 1) || !(motionOf(body, contact).length() * (1 - contact.m_time) > beyond)) return 1;
    const btScalar distance = contact.m_startGap + contact.m_thickness;  // at the step's start
    const btScalar standOff = kStandOff * contact.m_thickness;
    return distance > standOff ? contact.m_time * (1 - standOff / distance) : btScalar(0);
}
}  // namespace

bool cutAtImpacts(btSoftBody& body, const std::vector<StepContact>& contacts, btScalar beyond, Cut cut)
{
    std::vector<btScalar> left(static_cast<std::size_t>(body.m_nodes.size()), btScalar(1));
    btScalar least = 1;
    for (const StepContact& contact : contacts)
    {
        const btScalar share = shareLeft(body, contact, beyond * contact.m_thickness);
        least = std::min(least, share);
        for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        {
            btScalar& own = left[static_cast<std::size_t>(contact.m_nodes[k])];
            own = std::min(own, share);
        }
    }
    if (!(least < 1)) return false;
    const btScalar velocityScale = body.m_sst.isdt * (1 - body.m_cfg.kDP);
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btScalar share = cut == Cut::WholeBody ? least : left[static_cast<std::size_t>(i)];
        btSoftBody::Node& node = body.m_nodes[i];
        if (!(share < 1) || !(movableInverseMass(node) > 0)) continue;
        const btVector3 shift = (node.m_x - node.m_q) * (share - 1);
        node.m_x += shift;
        node.m_v += shift * velocityScale;
    }
    return true;
}
}  // namespace drape
