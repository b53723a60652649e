#include "bvh_layout.h"

#include <algorithm>
#include <limits>

namespace drape
{
BvhLayout makeBvhLayout(std::uint32_t leafCount)
{
    BvhLayout layout;
    std::uint32_t first = 0;
    for (std::uint32_t count = leafCount; count > 0; count = (count + 1) / 2)
    {
        layout.m_heights.push_back(BvhHeight{first, count});
        first += count;
        if (count == 1) break;
    }
    return layout;
}

std::vector<BvhNode> makeBvhNodes(const BvhLayout& layout)
{
    BvhNode empty = {};
    std::fill(empty.m_low, empty.m_low + DRAPE_DOP_DIRECTIONS, std::numeric_limits<float>::infinity());
    std::fill(empty.m_high, empty.m_high + DRAPE_DOP_DIRECTIONS, -std::numeric_limits<float>::infinity());
    std::vector<BvhNode> nodes(layout.nodeCount(), empty);
    for (std::size_t height = 0; height < layout.m_heights.size(); ++height)
    {
        const BvhHeight& level = layout.m_heights[height];
        for (std::uint32_t i = 0; i < level.m_count; ++i)
        {
            BvhNode& node = nodes[level.m_first + i];
            if (height == 0)
            {
                node.m_first = i;
                node.m_count = 0;
                continue;
            }
            const BvhHeight& below = layout.m_heights[height - 1];
            node.m_first = below.m_first + 2 * i;
            node.m_count = std::min(2u, below.m_count - 2 * i);
        }
    }
    return nodes;
}
}  // namespace drape
