// A binary tree with heights left out: nodes of two to four children, and leaves in bundles, for studies of the shape.
//
// Order and leaves stay. Nodes lie by depth, the root first, children adjacent as BvhNode says, so that every traversal
// of BvhNodes from a root takes them; makeBvhLayout() of them is what a refit on either side takes. Host only; linear.
#pragma once

#include <vector>

#include "tree.h"

namespace drape
{
// degree: 2, or 4 for every second height left out. bundle: a node over at most so many leaves has them all as its
// children.
std::vector<BvhNode> reshape(const Tree& tree, std::uint32_t degree, std::uint32_t bundle = 1);
}  // namespace drape
