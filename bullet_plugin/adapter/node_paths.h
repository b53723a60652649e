// The paths of a body's nodes in a step: straight from the start to the predicted end. Metres, world frame.
//
// The start is recorded once a step, before Bullet solves: Bullet's drift iterations overwrite btSoftBody::Node::m_q.
#pragma once

#include <vector>

#include "bullet_plugin/adapter/step_contact.h"

namespace drape
{
struct NodePaths
{
    std::vector<btVector3> m_start, m_end;  // by node
    std::vector<btScalar> m_inverseMass;    // by node; 0 where contacts may not move it

    void resize(std::size_t count)
    {
        m_start.resize(count);
        m_end.resize(count);
        m_inverseMass.resize(count);
    }
    void record(std::size_t at, const btSoftBody::Node& node)
    {
        m_start[at] = node.m_q;
        m_inverseMass[at] = movableInverseMass(node);
        recordEnd(at, node);
    }
    void recordEnd(std::size_t at, const btSoftBody::Node& node) { m_end[at] = node.m_x; }
};
}  // namespace drape
