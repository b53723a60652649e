#include "bullet_plugin/adapter/motion/node_tree.h"

#include <atomic>
#include <cstddef>

#include "bullet_plugin/adapter/solver/body_jobs.h"

namespace drape
{
namespace
{
// Returns whether the leaf changed.
bool fitLeaf(btSoftBody::Node& node, const btSoftBody::SolverState& state)
{
    if (!node.m_leaf) return false;
    btDbvtVolume volume = btDbvtVolume::FromCR(node.m_x, state.radmrg);
    if (node.m_leaf->volume.Contain(volume)) return false;
    volume.Expand(btVector3(state.updmrg, state.updmrg, state.updmrg));
    volume.SignedExpand(node.m_v * state.velmrg);
    node.m_leaf->volume = volume;
    return true;
}

btDbvtNode* firstLeafOf(btDbvtNode* node)
{
    while (node->isinternal())
        node = node->childs[0];
    return node;
}

// Fits the volumes of inner nodes to the leaves, from the leaves up.
void refit(btDbvt& tree)
{
    if (!tree.m_root) return;
    btDbvtNode* node = firstLeafOf(tree.m_root);
    while (btDbvtNode* const parent = node == tree.m_root ? nullptr : node->parent)
    {
        if (node == parent->childs[0])
        {
            node = firstLeafOf(parent->childs[1]);
            continue;
        }
        Merge(parent->childs[0]->volume, parent->childs[1]->volume, parent->volume);
        node = parent;
    }
}
}  // namespace

void updateNodeTree(btSoftBody& body, ThreadTeam* threads)
{
    std::atomic<bool> leavesChanged{false};
    const auto fit = [&](std::size_t first, std::size_t last)
    {
        bool changed = false;
        for (std::size_t i = first; i < last; ++i)
            changed = fitLeaf(body.m_nodes[static_cast<int>(i)], body.m_sst) || changed;
        if (changed) leavesChanged = true;
    };
    forRanges(static_cast<std::size_t>(body.m_nodes.size()), threads, fit);
    if (leavesChanged) refit(body.m_ndbvt);
}
}  // namespace drape
