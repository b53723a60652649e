// A side's hierarchy out of its meshes' own: pairs of neighbours, height by height, above one tree a mesh.
//
// Why not one tree over all triangles: meshes come, go and move on their own. So one that comes costs its own tree
// alone, and one that goes away takes its volumes with it; triangles of two meshes that once lay beside each other
// never share a node below their meshes'. Links and orders alone; volumes are a refit's work. Linear.
#pragma once

#include <cstdint>
#include <vector>

#include "bvh_layout.h"
#include "drape/methods.h"
#include "kernels/shared/mesh.h"

namespace drape
{
struct MeshTree
{
    std::vector<BvhChildren> m_links;    // of every node, as BvhNode has them, the root first
    std::vector<std::uint32_t> m_order;  // triangle per leaf
};

// One mesh's, by the methods' builder. Triangles refer to vertices of `positions` (m, x y z each).
MeshTree buildMeshTree(const TreeMethods& methods, const std::vector<Triangle>& triangles, const float* positions);

// The trees of meshes whose triangles follow each other. Those without triangles are left out.
struct JoinedTree
{
    BvhLayout m_layout;
    std::vector<std::uint32_t> m_order;  // joined triangle per leaf
};
JoinedTree joinTrees(const std::vector<const MeshTree*>& meshes);
}  // namespace drape
