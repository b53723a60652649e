// The order of triangles as leaves with their Morton codes, of 30 bits as the product's (morton_order.h) or of 63. Host
// and device give the same. O(n log n) on the host, four linear passes on the device (eight for 63-bit codes).
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "kernels/shared/mesh.h"
#include "study/trees/radix_sort.h"

namespace drape
{
// Triangles in order, and their codes: one word of 30 bits, or the upper 31 and the lower 32 of 63.
struct MortonOrder
{
    std::vector<std::uint32_t> m_order;
    std::vector<std::uint32_t> m_high;
    std::vector<std::uint32_t> m_low;  // empty for 30 bits
};

// positions: m, x y z per vertex that triangles refer to. NaN centroids sort by a code of zero. codeBits: 30 or 63.
MortonOrder sortByMorton(const std::vector<Triangle>& triangles, const float* positions, std::uint32_t codeBits);

class MortonOrderStage
{
public:
    void create(Device& device, const ProgramLoader& load);

    // Leaves the triangles' numbers in order and the sorted codes; low is used for 63 bits only. Returns after
    // enqueueing.
    void enqueue(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count, cl_uint codeBits,
                 WorkShape shape, Buffer<cl_uint>& order, Buffer<cl_uint>& high, Buffer<cl_uint>& low);

private:
    Kernel m_bounds, m_codes;
    RadixSortStage m_sort;
    Buffer<cl_uint> m_boundsBuffer{"sorting"}, m_unsortedHigh{"sorting"}, m_unsortedLow{"sorting"};
};
}  // namespace drape
