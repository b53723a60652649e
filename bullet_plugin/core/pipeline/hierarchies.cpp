// The hierarchies of both sides: who builds them, and when the cloths' is built anew.
#include "bullet_plugin/core/bvh/tree_builder.h"
#include "implementation.h"

namespace drape
{
void Pipeline::Implementation::buildHierarchy(MeshPool& pool, const float* positions, BvhLayout& layout) const
{
    const TreeMethods methods = resolveBuilder(m_settings.m_methods.m_tree, m_report.m_onHost);
    const bool walked = m_report.m_onHost || !goesOverPatches(m_settings);
    // Meshes come sorted by codes of 30 bits.
    const bool asTheyCame = methods.m_builder == TreeBuilder::Balanced && methods.m_mortonBits == 30;
    if (asTheyCame || !walked)
        layout = makeBvhLayout(std::uint32_t(pool.order().size()));
    else
        useHierarchy(buildTreeOnHost(methods, pool.triangles(), positions, pool.meshCount()), pool, layout);
}

void Pipeline::Implementation::useHierarchy(const Tree& tree, MeshPool& pool, BvhLayout& layout) const
{
    // Pairs of neighbours in order is what a layout is by itself.
    const TreeMethods methods = resolveBuilder(m_settings.m_methods.m_tree, m_report.m_onHost);
    const bool balanced = methods.m_builder == TreeBuilder::Balanced;
    layout = balanced ? makeBvhLayout(tree.leafCount()) : makeBvhLayout(tree.m_nodes, 0);
    pool.reorder(tree.m_order);
}

void Pipeline::Implementation::takeRebuilt()
{
    Tree tree;
    if (!m_treeWatch.take(tree)) return;
    useHierarchy(tree, m_scene.m_cloths, m_scene.m_clothLayout);
    m_clothRevision = m_scene.m_cloths.revision();
    ++m_statistics.m_rebuilds;
}

void Pipeline::Implementation::watchTree()
{
    if (!m_stepPairs.m_measureTree || m_statistics.m_skipped) return;
    const MeshPool& cloths = m_scene.m_cloths;
    if (!m_treeWatch.isDecayed(m_result.m_treeCost, m_settings.m_methods.m_rebuildDecay)) return;
    const float* end = m_scene.m_clothEnd.data();
    m_treeWatch.rebuild(resolveBuilder(m_settings.m_methods.m_tree, m_report.m_onHost), cloths.triangles(),
                        std::vector<float>(end, end + 3 * cloths.vertexCount()), cloths.meshCount());
}
}  // namespace drape
