#include "bullet_plugin/adapter/closing_pass.h"

#include <algorithm>

namespace drape
{
namespace
{
btVector3 weightedPosition(const btSoftBody& body, const StepContact& contact)
{
    btVector3 sum(0, 0, 0);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        sum += body.m_nodes[contact.m_nodes[k]].m_x * contact.m_weights[k];
    return sum;
}

btScalar normalSpeed(const btSoftBody& body, const StepContact& contact)
{
    btScalar sum = 0;
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        sum += body.m_nodes[contact.m_nodes[k]].m_v.dot(contact.m_normal) * contact.m_weights[k];
    return sum;
}

// What a unit multiplier moves the weighted point along the normal.
btScalar mobility(const btSoftBody& body, const StepContact& contact)
{
    btScalar sum = 0;
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
        sum += contact.m_weights[k] * contact.m_weights[k] * movableInverseMass(body.m_nodes[contact.m_nodes[k]]);
    return sum;
}

// Projects one contact; returns how far it was violated, 0 when nothing can or need be done.
btScalar project(btSoftBody& body, StepContact& contact, btScalar velocityScale)
{
    const btScalar gap = contact.m_normal.dot(weightedPosition(body, contact) - contact.m_point) - contact.m_thickness;
    const btScalar violation = contact.m_targetGap - gap;
    const btScalar move = mobility(body, contact);
    if (!(violation > 0) || !(move > 0)) return 0;  // also false for NaN
    const btScalar multiplier = violation / move;
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
    {
        btSoftBody::Node& node = body.m_nodes[contact.m_nodes[k]];
        const btVector3 shift = contact.m_normal * (contact.m_weights[k] * movableInverseMass(node) * multiplier);
        node.m_x += shift;
        node.m_v += shift * velocityScale;
    }
    contact.m_pushed += multiplier;
    return violation;
}

// Takes away the outward speed along the normal that the contact did not have before.
void limitSpeed(btSoftBody& body, const StepContact& contact)
{
    if (!(contact.m_pushed > 0)) return;
    const btScalar excess = normalSpeed(body, contact) - std::max(contact.m_speedBefore, btScalar(0));
    if (!(excess > 0)) return;
    const btScalar multiplier = excess / mobility(body, contact);
    for (int k = 0; k < 3 && contact.m_nodes[k] >= 0; ++k)
    {
        btSoftBody::Node& node = body.m_nodes[contact.m_nodes[k]];
        node.m_v -= contact.m_normal * (contact.m_weights[k] * movableInverseMass(node) * multiplier);
    }
}
}  // namespace

btScalar closeContacts(btSoftBody& body, std::vector<StepContact>& contacts, const MotionLimit& limit)
{
    if (!(body.m_sst.sdt > 0)) return 0;
    limit.apply(body);
    if (contacts.empty()) return 0;
    btScalar tolerance = contacts.front().m_thickness;
    for (StepContact& contact : contacts)
    {
        contact.m_speedBefore = normalSpeed(body, contact);
        contact.m_pushed = 0;
        tolerance = std::min(tolerance, contact.m_thickness);
    }
    tolerance *= kClosingTolerance;

    const btScalar velocityScale = body.m_sst.isdt * (1 - body.m_cfg.kDP);
    btScalar worst = 0;
    for (int round = 0; round < kClosingRounds; ++round)
    {
        worst = 0;
        if (round > 0) limit.apply(body);
        // Nodes last: of all contacts theirs hold exactly when a round ends, so what does not converge is left to the
        // faces and edges, which a node outside the obstacle keeps from passing in a later round or step.
        for (std::size_t i = contacts.size(); i-- > 0;)
            worst = std::max(worst, project(body, contacts[i], velocityScale));
        if (worst <= tolerance) break;
    }
    for (const StepContact& contact : contacts)
        limitSpeed(body, contact);
    return worst;
}
}  // namespace drape
