// Cuts a cloth into parts of neighbouring nodes, so that several threads can work on parts side by side.
//
// The parts are the leaves of a complete binary tree of groups, numbered as a heap. Group 1 is the whole cloth, the
// children of group g are 2 g and 2 g + 1, and the last leafCount() groups are the leaves. A face or an edge belongs
// to the smallest group that contains all of its nodes. Two groups of which neither contains the other share no node.
// Working from the leaves to the root, all groups of one height at once, is therefore one order of work with any
// number of threads.
//
// Cost: O(n log n) per topology. Source: recursive coordinate bisection (Berger and Bokhari 1987).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_plugin/core/threads/thread_team.h"
#include "kernels/shared/types.h"

namespace drape
{
class ClothParts
{
public:
    // Maximum nodes of a part. A GPU's work-group keeps 20 bytes for each in its local memory, mostly 48 KiB. Sharing a
    // cloth of a thousand nodes saves 0.1 ms of a step on two cores, but the cloth slips a little more often at rest.
    // On the bunny it moved faster than 9 mm/s in 4 of 36 falls with parts of 256 to 1,024 nodes, and in none of 12
    // falls as a whole.
    static constexpr std::size_t kMostNodes = 2048;

    // positions: of all nodes, m, at rest or at any other time. They determine how well the parts are cut and
    // the order of work. A position that is not a number counts as 0.
    // mostNodes: of a part. threads: null for the caller alone.
    void cut(std::vector<Vec3> positions, std::size_t mostNodes = kMostNodes, ThreadTeam* threads = nullptr);

    // Differs after cut() from that of any other cut.
    std::uint64_t revision() const { return m_revision; }
    std::size_t nodeCount() const { return m_leafOf.size(); }
    std::size_t leafCount() const { return m_firsts.size() - 1; }
    std::size_t groupCount() const { return 2 * leafCount(); }  // includes the unused group 0
    std::size_t firstLeaf() const { return leafCount(); }

    // Nodes leaf by leaf: leaf i has those from firstNode(i) to firstNode(i + 1).
    const std::vector<int>& order() const { return m_order; }
    std::size_t firstNode(std::size_t leaf) const { return m_firsts[leaf]; }

    // Returns the group of a feature. nodes: -1 beyond the feature's last node.
    std::size_t groupOf(const int nodes[3]) const
    {
        std::size_t group = leafOf(nodes[0]);
        for (int k = 1; k < 3 && nodes[k] >= 0; ++k)
            group = commonGroup(group, leafOf(nodes[k]));
        return group;
    }
    // Returns the group of the leaf that has the node.
    std::size_t leafOf(int node) const { return m_leafOf[static_cast<std::size_t>(node)]; }
    // Returns the smallest group that contains both.
    static std::size_t commonGroup(std::size_t group, std::size_t other)
    {
        // Climbs from both to their common ancestor; one is at the other's height or lower.
        while (group != other)
        {
            if (other > group)
                other /= 2;
            else
                group /= 2;
        }
        return group;
    }

private:
    std::uint64_t m_revision = 0;
    std::vector<std::size_t> m_leafOf;  // by node, its leaf group
    std::vector<int> m_order;
    std::vector<std::size_t> m_firsts{0, 0};
};
}  // namespace drape
