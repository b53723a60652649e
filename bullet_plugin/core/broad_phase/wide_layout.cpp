#include "wide_layout.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "kernels/lib/tree_layout.h"

namespace drape
{
namespace
{
// A step of the traversal leaves seven more than it took: so many heights fit into its stack.
constexpr std::uint32_t kMaxHeights = (DRAPE_WIDE_STACK_DEPTH - 1) / (DRAPE_WIDE - 1);
constexpr std::uint32_t kBinaryHeights = 3;  // that a wide one takes the place of
static_assert(DRAPE_WIDE == 1 << kBinaryHeights, "a node's slots hold what is so many heights below");
static_assert(kBinaryHeights * kMaxHeights >= DRAPE_TREE_HEIGHT + 27,
              "a mesh's tree under those of pairs of 2^27 meshes");

// The nodes that stand side by side below a node: its children, then in turn those that open while there is room.
std::vector<std::uint32_t> slotsBelow(const std::vector<BvhNode>& nodes, std::uint32_t node)
{
    std::vector<std::uint32_t> slots = {node};
    for (bool opened = true; opened;)
    {
        opened = false;
        std::vector<std::uint32_t> next;
        for (std::size_t i = 0; i < slots.size(); ++i)
        {
            const BvhNode& slot = nodes[slots[i]];
            const std::size_t taken = next.size() + (slots.size() - i - 1);
            if (slot.m_count == 0 || taken + slot.m_count > DRAPE_WIDE)
            {
                next.push_back(slots[i]);
                continue;
            }
            opened = true;
            for (std::uint32_t child = 0; child < slot.m_count; ++child)
                next.push_back(slot.m_first + child);
        }
        slots = next;
    }
    return slots;
}

WideNode emptyWideNode()
{
    WideNode node;
    const float infinity = std::numeric_limits<float>::infinity();
    for (int direction = 0; direction < DRAPE_DOP_DIRECTIONS; ++direction)
    {
        std::fill(node.m_low[direction], node.m_low[direction] + DRAPE_WIDE, infinity);
        std::fill(node.m_high[direction], node.m_high[direction] + DRAPE_WIDE, -infinity);
    }
    std::fill(node.m_child, node.m_child + DRAPE_WIDE, DRAPE_WIDE_NONE);
    return node;
}
}  // namespace

WideLayout makeWideLayout(const Hierarchy& hierarchy)
{
    WideLayout layout;
    if (hierarchy.empty()) return layout;
    struct Made
    {
        std::uint32_t m_node, m_height;
    };
    std::vector<Made> made = {{hierarchy.m_root, 1}};
    for (std::size_t i = 0; i < made.size(); ++i)
    {
        const Made wide = made[i];
        assert(wide.m_height <= kMaxHeights);
        layout.m_nodes.push_back(emptyWideNode());
        layout.m_sources.resize(layout.m_sources.size() + DRAPE_WIDE, DRAPE_WIDE_NONE);
        const std::vector<std::uint32_t> slots = slotsBelow(hierarchy.m_nodes, wide.m_node);
        for (std::size_t slot = 0; slot < slots.size(); ++slot)
        {
            const BvhNode& node = hierarchy.m_nodes[slots[slot]];
            layout.m_sources[i * DRAPE_WIDE + slot] = slots[slot];
            const bool leaf = node.m_count == 0;
            layout.m_nodes[i].m_child[slot] =
                leaf ? DRAPE_WIDE_LEAF | hierarchy.m_order[node.m_first] : std::uint32_t(made.size());
            if (!leaf) made.push_back({slots[slot], wide.m_height + 1});
        }
    }
    return layout;
}

void gatherWideOnHost(const std::vector<BvhNode>& nodes, WideLayout& layout)
{
    for (std::size_t i = 0; i < layout.m_sources.size(); ++i)
    {
        if (layout.m_sources[i] == DRAPE_WIDE_NONE) continue;
        const BvhNode& node = nodes[layout.m_sources[i]];
        WideNode& wide = layout.m_nodes[i / DRAPE_WIDE];
        for (int direction = 0; direction < DRAPE_DOP_DIRECTIONS; ++direction)
        {
            wide.m_low[direction][i % DRAPE_WIDE] = node.m_low[direction];
            wide.m_high[direction][i % DRAPE_WIDE] = node.m_high[direction];
        }
    }
}
}  // namespace drape
