// Wide nodes of a hierarchy: the same tree with up to eight children side by side, for traversals that test them at
// once.
//
// Input: nodes with their links. Output: wide nodes, root first, with children named and volumes empty, and the node
// whose volume each slot takes. A slot's child is opened while there is room for its children, heights nearest to the
// root first, so a binary tree loses two heights of three. 8/7 slots a node that is kept, 76 bytes each.
#pragma once

#include "hierarchy.h"

namespace drape
{
struct WideLayout
{
    std::vector<WideNode> m_nodes;
    std::vector<std::uint32_t> m_sources;  // node per slot; DRAPE_WIDE_NONE without one
};

WideLayout makeWideLayout(const Hierarchy& hierarchy);

// Copies the volumes of the nodes that were refitted.
void gatherWideOnHost(const std::vector<BvhNode>& nodes, WideLayout& layout);
}  // namespace drape
