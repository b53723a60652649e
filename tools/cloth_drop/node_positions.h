// Copies a soft body's node positions to x y z floats; returns the filled array.
#pragma once

#include <vector>

#include <BulletSoftBody/btSoftBody.h>

namespace drape
{
inline const std::vector<float>& copyPositions(const btSoftBody& body, std::vector<float>& positions)
{
    positions.resize(3 * static_cast<std::size_t>(body.m_nodes.size()));
    for (int i = 0; i < body.m_nodes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            positions[3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(axis)] =
                static_cast<float>(body.m_nodes[i].m_x[axis]);
    return positions;
}
}  // namespace drape
