// Fits the tree of a soft body's nodes (btSoftBody::m_ndbvt) to where the nodes are.
//
// Bullet does this in every prediction. Drape's prediction leaves the tree alone: most steps read it nowhere. A tree
// that is left alone stays whole, so that whatever of Bullet's inserts, removes or updates leaves may do so at any
// time. docs/design_notes/node_trees.md lists the readers, and who brings the tree up to date for each.
#pragma once

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_plugin/core/threads/thread_team.h"

namespace drape
{
// Who keeps a body's node tree, and its state.
enum class NodeTree : unsigned char
{
    Bullets,  // Bullet updates it in its own prediction
    Current,  // Drape keeps it, and it has the nodes' positions
    Behind    // Drape keeps it, and its volumes are older than the nodes' positions
};

// Gives the leaves that do not contain their nodes' boxes the volumes that Bullet's prediction gives them, and fits the
// inner nodes. Keeps the shape of the tree, where Bullet removes and inserts leaves: traversals meet the nodes in the
// same order however often the tree is updated. The body was predicted before. Allocates no memory. Cost: linear in the
// nodes. threads: null for the caller alone.
void updateNodeTree(btSoftBody& body, ThreadTeam* threads);
}  // namespace drape
