// Refit of trees of any shape: new volumes, topology unchanged. Volumes are exact minima and maxima of the padded
// leaves, so the host, every device and every method give the same bits.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/program.h"
#include "study/methods.h"
#include "study/trees/tree.h"

namespace drape
{
// start, end: m, x y z per vertex (may be the same). meshRadius: m per mesh slot, negative to leave a mesh out. Adds
// NaN and infinite vertices to invalidNodes. Linear.
void refitTreeOnHost(Tree& tree, const std::vector<Triangle>& triangles, const float* start, const float* end,
                     const std::vector<float>& meshRadius, std::size_t& invalidNodes);

// The input of the leaves' volumes, on the device.
struct LeafBuffers
{
    Buffer<Triangle>& m_triangles;
    Buffer<float>& m_start;
    Buffer<float>& m_end;
    Buffer<float>& m_meshRadius;
    Buffer<StepCounters>& m_counters;  // its invalid nodes are added to
};

class TreeRefitStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Lists the splits that enqueue() goes through by the method and the shape that methods name. Once per topology.
    // Returns after enqueueing with Subtrees; waits with Levels, whose heights the host finds.
    void prepare(Device& device, DeviceTree& tree, const TreeMethods& methods);
    // Takes the methods that the tree was prepared for. Subtrees: two launches up to 2,048 leaves, else three;
    // one where subtrees suffice. Levels: one for the leaves and one per height. Returns after enqueueing.
    void enqueue(Device& device, DeviceTree& tree, LeafBuffers leaves, const TreeMethods& methods);

private:
    void listTops(Device& device, DeviceTree& tree, WorkShape shape);
    void listHeights(Device& device, DeviceTree& tree);
    void enqueueSubtrees(Device& device, DeviceTree& tree, LeafBuffers leaves, WorkShape shape);
    void enqueueLevels(Device& device, DeviceTree& tree, LeafBuffers leaves);

    Kernel m_subtreesSerial, m_grovesSerial, m_topsSerial, m_subtreesGroups, m_grovesGroups, m_topsGroup;
    Kernel m_countTops, m_listTopsSerial, m_listTopsGroups, m_leaves, m_level;
    Buffer<cl_uint> m_topCounts;
};
}  // namespace drape
