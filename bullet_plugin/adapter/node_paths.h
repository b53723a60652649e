// Where a body's nodes go in a step before Bullet solves: straight from the start to the predicted end. Metres, world
// frame.
#pragma once

#include <vector>

#include "BulletSoftBody/btSoftBody.h"

namespace drape
{
struct NodePaths
{
    std::vector<btVector3> m_start, m_end;  // by node

    void record(const btSoftBody& body)
    {
        const std::size_t count = static_cast<std::size_t>(body.m_nodes.size());
        m_start.resize(count);
        m_end.resize(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            m_start[i] = body.m_nodes[static_cast<int>(i)].m_q;
            m_end[i] = body.m_nodes[static_cast<int>(i)].m_x;
        }
    }
};
}  // namespace drape
