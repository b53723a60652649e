#include "joined_tree.h"

#include <algorithm>

#include "bullet_plugin/core/mesh/reserve_room.h"
#include "tree_builder.h"

namespace drape
{
namespace
{
void appendBlock(const std::shared_ptr<const MeshTree>& mesh, BvhLayout& layout)
{
    const std::uint32_t node = std::uint32_t(layout.m_links.size()), leaf = std::uint32_t(layout.m_leafNodes.size());
    layout.m_blocks.push_back(BvhBlock{mesh, node, leaf});
    layout.m_leafNodes.resize(leaf + mesh->m_order.size());
    for (const BvhChildren& own : mesh->m_links)
    {
        const bool isLeaf = own.m_count == 0;
        if (isLeaf) layout.m_leafNodes[leaf + own.m_first] = std::uint32_t(layout.m_links.size());
        layout.m_links.push_back(BvhChildren{own.m_first + (isLeaf ? leaf : node), own.m_count});
    }
}

// A node over each mesh's root, so that these lie side by side, and pairs of neighbours above.
void appendTop(BvhLayout& layout)
{
    const std::uint32_t top = std::uint32_t(layout.m_links.size());
    std::uint32_t end = top;  // of the block's nodes
    std::vector<BvhChildren> roots;
    for (std::size_t block = layout.m_blocks.size(); block-- > 0; end = layout.m_blocks[block].m_firstNode)
        if (layout.m_blocks[block].m_firstNode < end) roots.push_back(BvhChildren{end - 1, 1});
    layout.m_links.insert(layout.m_links.end(), roots.rbegin(), roots.rend());
    const BvhLayout above = makeBvhLayout(std::uint32_t(roots.size()));
    const std::vector<BvhChildren> links = linksOf(makeBvhNodes(above));
    for (std::size_t node = roots.size(); node < links.size(); ++node)
        layout.m_links.push_back(BvhChildren{links[node].m_first + top, links[node].m_count});
    for (const BvhHeight& height : above.m_heights)
        layout.m_heights.push_back(BvhHeight{height.m_first + top, height.m_count});
}
}  // namespace

MeshTree buildMeshTree(const TreeMethods& methods, const std::vector<Triangle>& triangles, const float* positions)
{
    Tree tree = linkTreeOnHost(methods, triangles, positions);
    MeshTree mesh;
    mesh.m_links = makeBvhLayout(linksOf(tree.m_nodes), 0).m_links;
    mesh.m_order = std::move(tree.m_order);
    return mesh;
}

void joinTrees(const std::vector<std::shared_ptr<const MeshTree>>& meshes, BvhLayout& layout)
{
    if (!layout.joined()) layout = BvhLayout();
    std::size_t kept = 0, leaves = 0, nodes = 0;
    while (kept < std::min(meshes.size(), layout.m_blocks.size()) && layout.m_blocks[kept].m_tree == meshes[kept])
        ++kept;
    for (const std::shared_ptr<const MeshTree>& mesh : meshes)
    {
        leaves += mesh->m_order.size();
        nodes += mesh->m_links.size() + 2;  // and those above
    }
    const std::uint32_t node = layout.blockNode(kept), leaf = layout.blockLeaf(kept);
    layout.m_links.resize(node);
    layout.m_leafNodes.resize(leaf);
    layout.m_blocks.resize(kept);
    layout.m_heights.clear();
    reserveRoom(layout.m_links, nodes + 1);
    reserveRoom(layout.m_leafNodes, leaves);
    for (std::size_t i = kept; i < meshes.size(); ++i)
        appendBlock(meshes[i], layout);
    appendTop(layout);
}
}  // namespace drape
