// A body's nodes in a step before Bullet solves: where each goes, straight from the start to the predicted end. Metres,
// world frame.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/step_contact.h"

namespace drape
{
struct NodePaths
{
    std::vector<btVector3> m_start, m_end;  // by node
    std::vector<btScalar> m_inverseMass;    // likewise, 0 where contacts may not move it

    void resize(std::size_t count)
    {
        m_start.resize(count);
        m_end.resize(count);
        m_inverseMass.resize(count);
    }
    void record(std::size_t at, const btSoftBody::Node& node)
    {
        m_start[at] = node.m_q;
        m_end[at] = node.m_x;
        m_inverseMass[at] = movableInverseMass(node);
    }
};
}  // namespace drape
