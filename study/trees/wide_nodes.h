// A binary tree with heights left out: nodes of two to four children, and leaves in bundles, for studies of the shape.
//
// Order and leaves stay. Nodes lie by depth, the root first, children adjacent as BvhNode says, so that every traversal
// of BvhNodes from a root takes them. Linear.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "kernels/queries/queries_bindings.h"
#include "study/trees/tree.h"

namespace drape
{
// degree: 2, or 4 for every second height left out. bundle: a node over at most so many leaves has them all as its
// children.
std::vector<BvhNode> reshape(const Tree& tree, std::uint32_t degree, std::uint32_t bundle = 1);

// The nodes of each depth, the deepest first.
std::vector<BvhHeight> depthsOf(const std::vector<BvhNode>& nodes);

// Gives such nodes the volumes of their triangles. positions: m, x y z per vertex. order: triangle per leaf.
void refitWideOnHost(std::vector<BvhNode>& nodes, const std::vector<std::uint32_t>& order,
                     const std::vector<Triangle>& triangles, const float* positions);

// Refits on a device: a launch for the leaves and one per depth.
class WideRefitStage
{
public:
    void create(Device& device, const ProgramLoader& load);
    // depths: of the nodes. Returns after enqueueing.
    void enqueue(Device& device, const std::vector<BvhHeight>& depths, Buffer<BvhNode>& nodes, Buffer<cl_uint>& order,
                 Buffer<Triangle>& triangles, Buffer<float>& positions);

private:
    Kernel m_leaves;
    BoundKernel<kernels::refitLevel> m_level;
};
}  // namespace drape
