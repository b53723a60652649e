// A cloth cut into parts of neighbouring nodes, so that what is done to the nodes of one part can be done beside what
// is done to those of another.
//
// The parts are the leaves of a complete binary tree of groups, numbered as a heap: group 1 is the whole cloth, the
// children of group g are 2 g and 2 g + 1, and the last leafCount() groups are the leaves. A face or an edge belongs to
// the smallest group that holds all of its nodes. What belongs to groups none of which holds the other shares no node.
// So working from the leaves to the root, groups of one height at once, is one order of work, whoever does it.
//
// Cost: O(n log n) once a topology. Source: recursive coordinate bisection (Berger and Bokhari 1987).
#pragma once

#include <cstddef>
#include <vector>

#include "LinearMath/btVector3.h"

namespace drape
{
class ClothParts
{
public:
    // Of a part. Sharing a cloth of a thousand nodes saves 0.1 ms of a step on two cores, and at rest it slips a little
    // more often: on the bunny faster than 9 mm/s in 4 of 36 falls with parts of 256 to 1,024 nodes, in none of 12
    // whole.
    static constexpr std::size_t kMostNodes = 2048;

    // places: of all nodes, m; where they lie at rest, or at any other time: it decides how well the parts are cut, and
    // with them the order of work. What is no number counts as 0.
    void cut(std::vector<btVector3> places);

    std::size_t nodeCount() const { return m_leafOf.size(); }
    std::size_t leafCount() const { return m_firsts.size() - 1; }
    std::size_t groupCount() const { return 2 * leafCount(); }  // with a group 0 that has nothing
    std::size_t firstLeaf() const { return leafCount(); }

    // Nodes leaf by leaf; those of the leaf i are from firstNode(i) to firstNode(i + 1).
    const std::vector<int>& order() const { return m_order; }
    std::size_t firstNode(std::size_t leaf) const { return m_firsts[leaf]; }

    // Of a feature with these nodes, -1 where it has fewer than three.
    std::size_t groupOf(const int nodes[3]) const
    {
        std::size_t group = m_leafOf[static_cast<std::size_t>(nodes[0])];
        for (int k = 1; k < 3 && nodes[k] >= 0; ++k)
        {
            // Of a group and one of the same height or lower: up until they are one.
            std::size_t other = m_leafOf[static_cast<std::size_t>(nodes[k])];
            while (group != other)
            {
                if (other > group)
                    other /= 2;
                else
                    group /= 2;
            }
        }
        return group;
    }

private:
    std::vector<std::size_t> m_leafOf;  // by node, the group
    std::vector<int> m_order;
    std::vector<std::size_t> m_firsts{0, 0};
};
}  // namespace drape
