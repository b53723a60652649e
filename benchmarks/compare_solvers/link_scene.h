// Scenes of compare_solvers: one soft body without an obstacle. Lengths in metres, times in seconds.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

namespace drape::bench
{
struct LinkScene
{
    std::string m_name;
    // Makes the body with `nodes` nodes a side, or along a rope. Its links have their rest lengths.
    std::function<std::unique_ptr<btSoftBody>(btSoftBodyWorldInfo& info, int nodes)> m_make;
    // Moves pins before the step that ends at `time`; empty if there is nothing to move.
    std::function<void(btSoftBody& body, int nodes, double time)> m_drive;
    bool m_isClosed;   // neither wind nor moving pins add energy
    int m_quickNodes;  // nodes a side with --quick
    int m_nodes;       // nodes a side otherwise
};

// Returns hanging, tablecloth, trampoline, rope, flag and cape.
const std::vector<LinkScene>& linkScenes();
}  // namespace drape::bench
