#include "side_hierarchy.h"

#include <cassert>
#include <iterator>
#include <utility>

#include "bullet_plugin/core/bvh/tree_builder.h"
#include "implementation.h"

namespace drape
{
namespace
{
// Meshes' triangles come sorted by codes of 30 bits, and pairs of neighbours in order is what a layout is by itself.
bool isAsTheyCame(const TreeMethods& methods)
{
    return methods.m_builder == TreeBuilder::Balanced && methods.m_mortonBits == 30;
}
}  // namespace

void SideHierarchy::begin(const MeshPool& pool)
{
    m_laidOut = false;
    m_used = TreeBuilder::Auto;
    for (auto kept = m_trees.begin(); kept != m_trees.end();)
        kept = pool.holds(kept->first) ? std::next(kept) : m_trees.erase(kept);
}

void SideHierarchy::layOut(const MeshPool& pool, BvhLayout& layout)
{
    if (!m_laidOut) layout = makeBvhLayout(std::uint32_t(pool.order().size()));
    m_laidOut = true;
}

bool SideHierarchy::buildTree(const TreeMethods& methods, const PooledMesh& mesh)
{
    const std::vector<Triangle>& triangles = mesh.m_topology.m_triangles;
    std::shared_ptr<const MeshTree>& tree = m_trees[mesh.m_id];
    if (tree && tree->m_order.size() == triangles.size()) return false;
    tree = std::make_shared<const MeshTree>(buildMeshTree(methods, triangles, mesh.m_positions.data()));
    return true;
}

bool SideHierarchy::build(const TreeMethods& methods, MeshPool& pool, BvhLayout& layout)
{
    if (m_used == methods.m_builder) return false;
    if (m_trees.empty() && isAsTheyCame(methods))
    {
        layOut(pool, layout);
        return false;
    }
    if (m_builder != methods.m_builder) m_trees.clear();
    m_builder = methods.m_builder;
    std::vector<bool> fresh;
    for (std::size_t slot = 0; slot < pool.meshCount(); ++slot)
        fresh.push_back(buildTree(methods, pool.mesh(slot)));
    join(pool, fresh, layout);
    return true;
}

void SideHierarchy::use(RebuiltTrees rebuilt, MeshPool& pool, BvhLayout& layout)
{
    assert(rebuilt.m_trees.size() == pool.meshCount());
    m_builder = rebuilt.m_builder;
    m_trees.clear();
    for (std::size_t slot = 0; slot < pool.meshCount(); ++slot)
        m_trees[pool.mesh(slot).m_id] = std::make_shared<const MeshTree>(std::move(rebuilt.m_trees[slot]));
    join(pool, std::vector<bool>(pool.meshCount(), true), layout);
}

void SideHierarchy::join(MeshPool& pool, const std::vector<bool>& fresh, BvhLayout& layout)
{
    std::vector<std::shared_ptr<const MeshTree>> trees;
    std::vector<const std::vector<std::uint32_t>*> orders;
    for (std::size_t slot = 0; slot < pool.meshCount(); ++slot)
    {
        trees.push_back(m_trees.at(pool.mesh(slot).m_id));
        orders.push_back(fresh[slot] ? &trees.back()->m_order : nullptr);
    }
    pool.reorder(orders);
    m_used = m_builder;
    m_laidOut = true;
    if (m_used == TreeBuilder::Balanced)
        layout = makeBvhLayout(std::uint32_t(pool.order().size()));
    else
        joinTrees(trees, layout);
}

RebuiltTrees buildMeshTrees(const TreeMethods& methods, const std::vector<Triangle>& triangles,
                            const std::vector<std::uint32_t>& firstTriangles, const float* positions)
{
    RebuiltTrees rebuilt;
    rebuilt.m_builder = methods.m_builder;
    for (std::size_t mesh = 0; mesh < firstTriangles.size(); ++mesh)
    {
        const auto first = triangles.begin() + std::ptrdiff_t(firstTriangles[mesh]);
        const bool last = mesh + 1 == firstTriangles.size();
        const auto end = last ? triangles.end() : triangles.begin() + std::ptrdiff_t(firstTriangles[mesh + 1]);
        rebuilt.m_trees.push_back(buildMeshTree(methods, {first, end}, positions));
    }
    return rebuilt;
}

TreeMethods Pipeline::Implementation::treeMethods() const
{
    return resolveBuilder(m_settings.m_methods.m_tree, m_report.m_onHost);
}

bool Pipeline::Implementation::walksHierarchies() const
{
    return !m_pairs.empty() && !goesOverPatches(m_settings);
}

void Pipeline::Implementation::layOut()
{
    m_clothHierarchy.layOut(m_scene.m_cloths, m_scene.m_clothLayout);
    m_obstacleHierarchy.layOut(m_scene.m_obstacles, m_scene.m_obstacleLayout);
}

void Pipeline::Implementation::buildHierarchies()
{
    if (m_clothHierarchy.build(treeMethods(), m_scene.m_cloths, m_scene.m_clothLayout))
    {
        m_clothRevision = m_scene.m_cloths.revision();
        m_treeWatch.begin();
    }
    if (m_obstacleHierarchy.build(treeMethods(), m_scene.m_obstacles, m_scene.m_obstacleLayout))
        m_obstacleRevision = m_scene.m_obstacles.revision();
}

void Pipeline::Implementation::takeRebuilt()
{
    RebuiltTrees rebuilt;
    if (m_pairs.empty() || !m_treeWatch.take(rebuilt)) return;
    // Of a back end that is no longer in use: dropped.
    if (!walksHierarchies() || rebuilt.m_builder != treeMethods().m_builder) return;
    m_clothHierarchy.use(std::move(rebuilt), m_scene.m_cloths, m_scene.m_clothLayout);
    m_clothRevision = m_scene.m_cloths.revision();
    ++m_statistics.m_rebuilds;
}

void Pipeline::Implementation::watchTree()
{
    if (!m_stepPairs.m_measureTree || m_statistics.m_skipped) return;
    const MeshPool& cloths = m_scene.m_cloths;
    if (!m_treeWatch.isDecayed(m_result.m_treeCost, m_settings.m_methods.m_rebuildDecay)) return;
    std::vector<std::uint32_t> firstTriangles;
    for (const MeshFirsts& firsts : cloths.firsts())
        firstTriangles.push_back(firsts.m_triangle);
    const float* end = m_scene.m_clothNodes.end();
    m_treeWatch.rebuild(treeMethods(), cloths.triangles(), std::move(firstTriangles),
                        std::vector<float>(end, end + 3 * cloths.vertexCount()));
}
}  // namespace drape
