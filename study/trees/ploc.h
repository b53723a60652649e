// Trees of quality: nearest clusters merged round by round. See kernels/lib/ploc.h. About twice the work of a radix
// tree a round, and some thirty rounds; a traversal of the tree visits fewer nodes.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/bound_kernel.h"
#include "study/kernels/lib/ploc.h"
#include "study/kernels/ploc_bindings.h"
#include "study/trees/morton_codes.h"
#include "study/trees/tree.h"

namespace drape
{
// Order and links; volumes are a refit's work. codeBits: 30 or 63. radius: neighbours looked at on either side, ≥ 1.
Tree buildPlocOnHost(const std::vector<Triangle>& triangles, const float* positions, std::uint32_t codeBits,
                     std::uint32_t radius);

class PlocStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Waits once in some rounds. count ≥ 1; the tree has room.
    void build(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count, cl_uint codeBits,
               cl_uint radius, WorkShape shape, DeviceTree& tree);

private:
    void reserve(Device& device, cl_uint count);
    void enqueueRound(Device& device, cl_uint round, cl_uint most, cl_uint radius, bool groups, cl_uint leafCount);

    MortonOrderStage m_order;
    Kernel m_leaves, m_nearest, m_count, m_place;
    BoundKernel<kernels::plocMerge> m_merge;
    Buffer<cl_uint> m_mortonOrder, m_high, m_low;
    Buffer<Box> m_boxes, m_boxesOut;
    Buffer<cl_uint> m_numbers, m_numbersOut, m_nearestOf, m_blockCounts, m_sizes, m_rounds;
    Buffer<Cluster> m_clusters;
    Buffer<ClusterPlace> m_places;
};
}  // namespace drape
