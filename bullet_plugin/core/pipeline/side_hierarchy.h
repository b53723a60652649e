// One side's hierarchy: who builds it, and when.
//
// Meshes that come and go leave pairs of neighbours in the order in which triangles came, which costs nothing; the
// builder that the settings name builds before the first step that walks the hierarchy. Trees of meshes are kept, so
// that one that comes costs its own alone.
#pragma once

#include <map>

#include "bullet_plugin/core/bvh/joined_tree.h"
#include "bullet_plugin/core/mesh/mesh_pool.h"

namespace drape
{
class SideHierarchy
{
public:
    // After the pool's meshes came or went.
    void begin(const MeshPool& pool, BvhLayout& layout);
    // Another leaf order and layout where the last ones are not by that builder. methods: none with TreeBuilder::Auto.
    // Returns whether anything changed; it counts as a change of the pool.
    bool build(const TreeMethods& methods, MeshPool& pool, BvhLayout& layout);
    // Takes what buildJoined() has made of the pool's meshes.
    void use(const TreeMethods& methods, JoinedTree tree, MeshPool& pool, BvhLayout& layout);

private:
    const MeshTree& treeOf(const TreeMethods& methods, const PooledMesh& mesh);

    std::map<MeshId, MeshTree> m_trees;  // by m_builder
    TreeBuilder m_builder = TreeBuilder::Auto;
    TreeBuilder m_used = TreeBuilder::Auto;  // by which the layout is; Auto: as triangles came
};

// Every mesh's tree by the methods' builder, joined. triangles, positions: the pool's, joined; firstTriangles: of every
// mesh. No state: for another thread.
JoinedTree buildJoined(const TreeMethods& methods, const std::vector<Triangle>& triangles,
                       const std::vector<std::uint32_t>& firstTriangles, const float* positions);
}  // namespace drape
