// A side's hierarchy out of its meshes' own: one tree a mesh, and above them pairs of neighbours, height by height.
//
// Why not one tree over all triangles: meshes come, go and move on their own. So one that comes costs its own tree
// alone, and one that goes away takes its volumes with it; triangles of two meshes that once lay beside each other
// never share a node below their meshes'. Links and orders alone; volumes are a refit's work.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bvh_layout.h"
#include "drape/methods.h"
#include "kernels/shared/mesh.h"

namespace drape
{
struct MeshTree
{
    std::vector<BvhChildren> m_links;    // of every node, as BvhNode has them, in a layout's order
    std::vector<std::uint32_t> m_order;  // triangle per leaf
};

// One mesh's, by the methods' builder. Triangles refer to vertices of `positions` (m, x y z each).
MeshTree buildMeshTree(const TreeMethods& methods, const std::vector<Triangle>& triangles, const float* positions);

// Makes the layout that of the meshes' trees, whose triangles follow each other, in a block each. A block that it has
// already, as those before it, stays as it is: so the cost is that of the others and of the nodes above the meshes. A
// mesh without triangles has a block without nodes.
void joinTrees(const std::vector<std::shared_ptr<const MeshTree>>& meshes, BvhLayout& layout);
}  // namespace drape
