#include "bullet_plugin/adapter/contact_rounds.h"

#include <algorithm>

#include "kernels/shared/contact.h"

namespace drape
{
ContactRounds::ContactRounds(btSoftBody& body, const std::vector<StepContact>& contacts) : m_body(body)
{
    std::vector<int> movedOfNode(static_cast<std::size_t>(body.m_nodes.size()), -1);
    m_rows.reserve(contacts.size());
    for (const StepContact& contact : contacts)
    {
        addRow(contact, movedOfNode);
        if (contact.m_kind == DRAPE_NODE_FACE) m_nodeRows = m_rows.size();
        m_leastThickness = std::min(m_leastThickness, contact.m_thickness);
    }
}

void ContactRounds::addRow(const StepContact& contact, std::vector<int>& movedOfNode)
{
    Row row = Row();
    for (; row.m_count < 3 && contact.m_nodes[row.m_count] >= 0; ++row.m_count)
    {
        const int node = contact.m_nodes[row.m_count];
        int& moved = movedOfNode[static_cast<std::size_t>(node)];
        if (moved < 0)
        {
            moved = static_cast<int>(m_moved.size());
            const btSoftBody::Node& from = m_body.m_nodes[node];
            m_moved.push_back(Moved{from.m_x, from.m_q, movableInverseMass(from), node});
        }
        const btScalar weight = contact.m_weights[row.m_count];
        row.m_moved[row.m_count] = moved;
        row.m_weights[row.m_count] = weight;
        row.m_mobility += weight * weight * m_moved[static_cast<std::size_t>(moved)].m_inverseMass;
    }
    if (!(row.m_mobility > 0)) return;
    row.m_normal = contact.m_normal;
    row.m_level = contact.m_normal.dot(contact.m_point) + contact.m_thickness + contact.m_targetGap;
    row.m_friction = contact.m_friction;
    row.m_held.setZero();
    row.m_carried = carriedBy(row, contact.m_carry);
    row.m_speedLimit = contact.m_startGap < 0
                           ? std::max(btScalar(0), (contact.m_endGap - contact.m_startGap) * m_body.m_sst.isdt) +
                                 row.m_normal.dot(row.m_carried) * m_body.m_sst.isdt
                           : SIMD_INFINITY;
    m_rows.push_back(row);
}

btVector3 ContactRounds::carriedBy(const Row& row, const btTransform* carry) const
{
    btVector3 start(0, 0, 0);
    if (!carry) return start;
    for (int k = 0; k < row.m_count; ++k)
        start += m_moved[static_cast<std::size_t>(row.m_moved[k])].m_start * row.m_weights[k];
    return *carry * start - start;
}

void ContactRounds::restart()
{
    for (Row& row : m_rows)
    {
        row.m_multiplier = 0;
        row.m_held.setZero();
    }
}

btVector3 ContactRounds::pointOf(const Row& row) const
{
    btVector3 sum(0, 0, 0);
    for (int k = 0; k < row.m_count; ++k)
        sum += m_moved[static_cast<std::size_t>(row.m_moved[k])].m_x * row.m_weights[k];
    return sum;
}

void ContactRounds::shift(const Row& row, const btVector3& impulse)
{
    for (int k = 0; k < row.m_count; ++k)
    {
        Moved& moved = m_moved[static_cast<std::size_t>(row.m_moved[k])];
        moved.m_x += impulse * (row.m_weights[k] * moved.m_inverseMass);
    }
}

// Returns how far the contact was violated, 0 when it was not.
btScalar ContactRounds::project(Row& row)
{
    const btScalar violation = row.m_level - row.m_normal.dot(pointOf(row));
    if (!(violation > 0) && !(row.m_multiplier > 0)) return 0;  // also for NaN
    const btScalar pushed = std::max(btScalar(0), row.m_multiplier + violation / row.m_mobility);
    shift(row, row.m_normal * (pushed - row.m_multiplier));
    row.m_multiplier = pushed;
    row.m_pushed = true;
    holdBack(row);
    return std::max(btScalar(0), violation);
}

// Friction: takes the contact's motion along the surface back, within the cone.
void ContactRounds::holdBack(Row& row)
{
    btVector3 sliding = pointOf(row) - row.m_carried;
    for (int k = 0; k < row.m_count; ++k)
        sliding -= m_moved[static_cast<std::size_t>(row.m_moved[k])].m_start * row.m_weights[k];
    sliding -= row.m_normal * row.m_normal.dot(sliding);
    btVector3 held = row.m_held - sliding / row.m_mobility;
    const btScalar most = row.m_friction * row.m_multiplier;
    const btScalar wanted2 = held.length2();
    if (wanted2 > most * most) held *= most / btSqrt(wanted2);
    shift(row, held - row.m_held);
    row.m_held = held;
}

btScalar ContactRounds::runRows(std::size_t count)
{
    for (Moved& moved : m_moved)
        moved.m_x = m_body.m_nodes[moved.m_node].m_x;
    btScalar worst = 0;
    for (std::size_t i = 0; i < count; ++i)
        worst = std::max(worst, project(m_rows[i]));
    const btScalar velocityScale = m_body.m_sst.isdt * (1 - m_body.m_cfg.kDP);
    for (const Moved& moved : m_moved)
    {
        btSoftBody::Node& node = m_body.m_nodes[moved.m_node];
        node.m_v += (moved.m_x - node.m_x) * velocityScale;
        node.m_x = moved.m_x;
    }
    return worst;
}

void ContactRounds::limitSpeed(const Row& row)
{
    btScalar speed = 0;
    for (int k = 0; k < row.m_count; ++k)
        speed += m_body.m_nodes[m_moved[static_cast<std::size_t>(row.m_moved[k])].m_node].m_v.dot(row.m_normal) *
                 row.m_weights[k];
    const btScalar excess = speed - row.m_speedLimit;
    if (!(excess > 0)) return;
    for (int k = 0; k < row.m_count; ++k)
    {
        const Moved& moved = m_moved[static_cast<std::size_t>(row.m_moved[k])];
        m_body.m_nodes[moved.m_node].m_v -=
            row.m_normal * (row.m_weights[k] * moved.m_inverseMass * excess / row.m_mobility);
    }
}

void ContactRounds::limitSpeeds()
{
    for (const Row& row : m_rows)
        if (row.m_pushed) limitSpeed(row);
}
}  // namespace drape
