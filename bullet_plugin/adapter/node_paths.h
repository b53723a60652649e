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

    void record(const btSoftBody& body)
    {
        const std::size_t count = static_cast<std::size_t>(body.m_nodes.size());
        m_start.resize(count);
        m_end.resize(count);
        m_inverseMass.resize(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            const btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
            m_start[i] = node.m_q;
            m_end[i] = node.m_x;
            m_inverseMass[i] = movableInverseMass(node);
        }
    }
};
}  // namespace drape
