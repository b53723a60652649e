// Radix trees over triangles in Morton order: the fastest builder. See kernels/lib/radix_tree.h.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/program.h"
#include "study/trees/morton_codes.h"
#include "study/trees/tree.h"

namespace drape
{
// Order and links; volumes are a refit's work. codeBits: 30 or 63. balanced: codes decide the order alone, and nodes
// split where the leaves' numbers do, which makes a tree of the least height.
Tree buildRadixTreeOnHost(const std::vector<Triangle>& triangles, const float* positions, std::uint32_t codeBits,
                          bool balanced);

class RadixTreeStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Order and links of a tree over count triangles: Morton order and one launch. Returns after enqueueing.
    void enqueue(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count, cl_uint codeBits,
                 bool balanced, WorkShape shape, DeviceTree& tree);

private:
    MortonOrderStage m_order;
    Kernel m_links;
    Buffer<cl_uint> m_high, m_low;
};
}  // namespace drape
