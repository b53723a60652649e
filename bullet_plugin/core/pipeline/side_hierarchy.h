// One side's hierarchy: who builds it, and when.
//
// Meshes that come and go leave pairs of neighbours in the order in which triangles came, laid out when somebody asks
// for it; the builder that the settings name builds before the first step that walks the hierarchy. (A step that a
// device hands back to the host half-way walks what is there.) Trees of meshes are kept, so that one that comes costs
// its own and joining. The order goes mesh by mesh.
#pragma once

#include <map>
#include <memory>

#include "bullet_plugin/core/bvh/joined_tree.h"
#include "bullet_plugin/core/mesh/mesh_pool.h"

namespace drape
{
// Every mesh's tree, by slot.
struct RebuiltTrees
{
    TreeBuilder m_builder = TreeBuilder::Auto;
    std::vector<MeshTree> m_trees;
};
// triangles, positions (m): the pool's, joined; firstTriangles: of every mesh. No state: for another thread.
RebuiltTrees buildMeshTrees(const TreeMethods& methods, const std::vector<Triangle>& triangles,
                            const std::vector<std::uint32_t>& firstTriangles, const float* positions);

class SideHierarchy
{
public:
    // After the pool's meshes came or went.
    void begin(const MeshPool& pool);
    // Makes the layout that of the pool's order where it is not.
    void layOut(const MeshPool& pool, BvhLayout& layout);
    // Another leaf order and layout where the last ones are not by that builder. methods: none with TreeBuilder::Auto.
    // Returns whether anything changed; it counts as a change of the pool.
    bool build(const TreeMethods& methods, MeshPool& pool, BvhLayout& layout);
    // Takes what buildMeshTrees() has made of the pool's meshes, in place of the trees that are kept.
    void use(RebuiltTrees rebuilt, MeshPool& pool, BvhLayout& layout);

private:
    // Returns whether it was not there.
    bool buildTree(const TreeMethods& methods, const PooledMesh& mesh);
    // fresh: by slot, whether the mesh's tree is another one than its leaf order is by.
    void join(MeshPool& pool, const std::vector<bool>& fresh, BvhLayout& layout);

    // By m_builder; of every mesh of the pool when they are joined.
    std::map<MeshId, std::shared_ptr<const MeshTree>> m_trees;
    TreeBuilder m_builder = TreeBuilder::Auto;
    TreeBuilder m_used = TreeBuilder::Auto;  // by which the layout is; Auto: pairs of neighbours
    bool m_laidOut = false;                  // the layout is the order's
};

}  // namespace drape
