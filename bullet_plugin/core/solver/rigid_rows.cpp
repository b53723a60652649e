#include "rigid_rows.h"

#include <algorithm>

namespace drape
{
namespace
{
// Calls call(row) for all rows of both lists.
template <class Call>
void forRows(const std::vector<RigidAnchor>& anchors, const std::vector<RigidContact>& contacts, const Call& call)
{
    std::for_each(anchors.begin(), anchors.end(), call);
    std::for_each(contacts.begin(), contacts.end(), call);
}
}  // namespace

void RigidRows::clear()
{
    m_given = {};
    m_contacts.clear();
    m_anchors.clear();
    m_contactStates.clear();
    m_anchorStates.clear();
}

void RigidRows::add(const RigidContact& contact)
{
    if (empty()) m_given.m_reference = (*m_bodies)[contact.m_body].m_centre;
    m_contacts.push_back(contact);
    m_contactStates.push_back({});
}

void RigidRows::add(const RigidAnchor& anchor)
{
    if (empty()) m_given.m_reference = (*m_bodies)[anchor.m_body].m_centre;
    m_anchors.push_back(anchor);
    m_anchorStates.push_back({});
}

bool RigidRows::bodiesYield() const
{
    bool all = true;
    forRows(m_anchors, m_contacts,
            [&](const auto& row)
            {
                const Vec3 inverseMass = (*m_bodies)[row.m_body].m_inverseMass;
                all = all && inverseMass.x > 0 && inverseMass.y > 0 && inverseMass.z > 0;
            });
    return all;
}

std::size_t RigidRows::movingRows() const
{
    std::size_t rows = 0;
    forRows(m_anchors, m_contacts, [&](const auto& row) { rows += (*m_bodies)[row.m_body].m_moves; });
    return rows;
}

void RigidRows::begin(SolverNodes& nodes, float time, float correctionTime, float passed)
{
    m_substep = {nodes.nodes(), nodes.states(), nodes.paths(),      m_bodies->data(),
                 &m_given,      time,           1 / correctionTime, passed};
    for (RigidRowState& state : m_contactStates)
        rigidBeginRow(&state);
}

void RigidRows::project()
{
    for (std::size_t i = 0; i < m_anchors.size(); ++i)
        rigidProjectAnchor(&m_substep, &m_anchors[i], &m_anchorStates[i]);
    for (std::size_t i = 0; i < m_contacts.size(); ++i)
        rigidProjectContact(&m_substep, &m_contacts[i], &m_contactStates[i]);
}

void RigidRows::end()
{
    for (std::size_t i = 0; i < m_anchors.size(); ++i)
        rigidEndRow(&m_substep, m_anchors[i].m_body, m_anchors[i].m_arm, &m_anchorStates[i]);
    for (std::size_t i = 0; i < m_contacts.size(); ++i)
        rigidEndRow(&m_substep, m_contacts[i].m_body, m_contacts[i].m_arm, &m_contactStates[i]);
}

void RigidRows::takeOver(const RigidGiven& given, const RigidBody* bodies)
{
    m_given = given;
    forRows(m_anchors, m_contacts,
            [&](const auto& row)
            {
                if (bodies[row.m_body].m_moves) (*m_bodies)[row.m_body] = bodies[row.m_body];
            });
}
}  // namespace drape
