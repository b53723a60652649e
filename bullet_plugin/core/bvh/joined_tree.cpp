#include "joined_tree.h"

#include "tree_builder.h"

namespace drape
{
MeshTree buildMeshTree(const TreeMethods& methods, const std::vector<Triangle>& triangles, const float* positions)
{
    Tree tree = linkTreeOnHost(methods, triangles, positions);
    MeshTree mesh;
    mesh.m_links = linksOf(tree.m_nodes);
    mesh.m_order = std::move(tree.m_order);
    return mesh;
}

JoinedTree joinTrees(const std::vector<const MeshTree*>& meshes)
{
    std::vector<const MeshTree*> filled;
    for (const MeshTree* mesh : meshes)
        if (!mesh->m_order.empty()) filled.push_back(mesh);
    JoinedTree joined;
    // The nodes above, whose leaves are the meshes' roots, then what is below each root.
    std::vector<BvhChildren> links = linksOf(makeBvhNodes(makeBvhLayout(std::uint32_t(filled.size()))));
    const std::uint32_t root = std::uint32_t(links.size()) - 1;
    for (std::size_t i = 0; i < filled.size(); ++i)
    {
        const std::uint32_t first =
            std::uint32_t(joined.m_order.size());                     // leaf and triangle: meshes without any add none
        const std::uint32_t below = std::uint32_t(links.size()) - 1;  // of the mesh's node 1, less 1
        const auto shifted = [&](const BvhChildren& node) {
            return BvhChildren{node.m_first + (node.m_count == 0 ? first : below), node.m_count};
        };
        const std::vector<BvhChildren>& own = filled[i]->m_links;
        links[i] = shifted(own[0]);
        for (std::size_t node = 1; node < own.size(); ++node)
            links.push_back(shifted(own[node]));
        for (const std::uint32_t triangle : filled[i]->m_order)
            joined.m_order.push_back(triangle + first);
    }
    joined.m_layout = makeBvhLayout(links, root);
    return joined;
}
}  // namespace drape
