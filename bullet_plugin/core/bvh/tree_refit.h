// Refit of trees of any shape: new volumes, topology unchanged. Volumes are exact minima and maxima of the padded
// leaves, so the host, every device and every method give the same bits.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/program.h"
#include "drape/methods.h"
#include "tree.h"

namespace drape
{
// start, end: m, x y z per vertex (may be the same). meshRadius: m per mesh slot, negative to leave a mesh out. Adds
// NaN and infinite vertices to invalidNodes. Linear.
void refitTreeOnHost(Tree& tree, const std::vector<Triangle>& triangles, const float* start, const float* end,
                     const std::vector<float>& meshRadius, std::size_t& invalidNodes);

// What the leaves' volumes are made from, on the device.
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

    // Lists the splits that the last launch of enqueue() climbs. Once per topology; returns after enqueueing.
    void listTops(Device& device, DeviceTree& tree, WorkShape shape);
    // Two launches up to 4,096 leaves, else three; one where subtrees suffice. Returns after enqueueing.
    void enqueue(Device& device, DeviceTree& tree, LeafBuffers leaves, WorkShape shape);

    // The splits of heightsOf() on the device.
    struct Heights
    {
        Buffer<cl_uint> m_splits;
        std::vector<BvhHeight> m_ranges;
    };
    void uploadHeights(Device& device, const TreeHeights& heights, Heights& uploaded) const;  // waits
    // A launch per height. Returns after enqueueing.
    void enqueueByHeight(Device& device, DeviceTree& tree, LeafBuffers leaves, Heights& heights);

private:
    Kernel m_subtreesSerial, m_grovesSerial, m_topsSerial, m_subtreesGroups, m_grovesGroups, m_topsGroup;
    Kernel m_countTops, m_listTopsSerial, m_listTopsGroups, m_leaves, m_level;
    Buffer<cl_uint> m_topCounts;
};
}  // namespace drape
