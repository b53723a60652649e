// A binary tree with every second height left out: nodes of two to four children, for studies of the degree.
//
// Order and leaves stay. Nodes lie by depth, the root first, children adjacent as BvhNode says, so that every traversal
// of BvhNodes from a root takes them. Host only; linear.
#pragma once

#include <vector>

#include "tree.h"

namespace drape
{
std::vector<BvhNode> collapseToFour(const Tree& tree);

// New volumes for the inner nodes after the leaves' have changed.
void refitWideNodes(std::vector<BvhNode>& nodes);
}  // namespace drape
