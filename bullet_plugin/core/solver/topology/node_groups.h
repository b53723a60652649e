// Nodes that were joined into groups: a forest in which each node names a parent, and a root itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace drape
{
class NodeGroups
{
public:
    static constexpr std::uint32_t kNone = UINT32_MAX;

    // Leaves all nodes without a group.
    void clear(std::size_t count) { m_parents.assign(count, kNone); }
    // Joins the groups of two nodes. A node may be joined with itself.
    void join(std::uint32_t a, std::uint32_t b)
    {
        if (m_parents[a] == kNone) m_parents[a] = a;
        if (m_parents[b] == kNone) m_parents[b] = b;
        const std::uint32_t root = rootOf(a);
        m_parents[rootOf(b)] = root;
    }
    // Names all groups, after the last join().
    void nameGroups()
    {
        for (std::uint32_t& node : m_parents)
            if (node != kNone) node = rootOf(node);
    }
    // Returns the name of a node's group, a node of it; kNone if it is in none. Valid after nameGroups().
    std::uint32_t groupOf(std::size_t node) const { return m_parents[node]; }

private:
    std::uint32_t rootOf(std::uint32_t node)
    {
        while (m_parents[node] != node)
            node = m_parents[node] = m_parents[m_parents[node]];
        return node;
    }

    std::vector<std::uint32_t> m_parents;
};
}  // namespace drape
