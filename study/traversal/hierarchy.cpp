#include "study/traversal/hierarchy.h"

#include "study/kernels/lib/traversal.h"

namespace drape
{
std::vector<BvhLink> makeLinks(const Hierarchy& hierarchy)
{
    std::vector<BvhLink> links(hierarchy.m_nodes.size());
    if (links.empty()) return links;
    std::vector<std::uint32_t> below = {hierarchy.m_root};
    links[hierarchy.m_root] = {hierarchy.m_root, 0};
    while (!below.empty())
    {
        const std::uint32_t parent = below.back();
        const BvhNode& node = hierarchy.m_nodes[parent];
        below.pop_back();
        for (std::uint32_t child = node.m_first; child < node.m_first + node.m_count; ++child)
        {
            links[child] = {parent, links[parent].m_depth + 1};
            below.push_back(child);
        }
    }
    return links;
}

StartPairs makeStartPairs(const Hierarchy& cloth, const Hierarchy& obstacle, std::size_t wanted)
{
    const std::vector<BvhLink> clothLinks = makeLinks(cloth), obstacleLinks = makeLinks(obstacle);
    StartPairs start = {{{cloth.m_root, obstacle.m_root}}, 0};
    while (start.m_pairs.size() < wanted)
    {
        std::vector<NodePair> next;
        bool opened = false;
        for (const NodePair& pair : start.m_pairs)
        {
            const BvhNode &a = cloth.m_nodes[pair.m_cloth], &b = obstacle.m_nodes[pair.m_obstacle];
            if (a.m_count == 0 && b.m_count == 0)
            {
                next.push_back(pair);
                continue;
            }
            opened = true;
            const bool openCloth =
                clothOpens(&a, &b, clothLinks[pair.m_cloth].m_depth, obstacleLinks[pair.m_obstacle].m_depth);
            const BvhNode& node = openCloth ? a : b;
            for (std::uint32_t child = node.m_first; child < node.m_first + node.m_count; ++child)
                next.push_back(openCloth ? NodePair{child, pair.m_obstacle} : NodePair{pair.m_cloth, child});
        }
        if (!opened) break;
        start.m_pairs.swap(next);
        ++start.m_depth;
    }
    return start;
}
}  // namespace drape
