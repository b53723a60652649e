// The order of a mesh's triangles as leaves: by the Morton code of the centroid, equal codes by number. Host and device
// give the same order. O(n log n) on the host, eight linear passes on the device.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/device/buffer.h"
#include "bullet_plugin/core/device/program.h"
#include "kernels/shared/mesh.h"

namespace drape
{
// positions: m, x y z per vertex that triangles refer to. NaN centroids sort by a code of zero.
std::vector<std::uint32_t> mortonOrderOnHost(const std::vector<Triangle>& triangles, const float* positions);

class MortonOrderStage
{
public:
    void create(Device& device, const cl::Program& program);

    // Waits for the device: meshes come and go rarely. Empty when the device failed.
    std::vector<std::uint32_t> order(Device& device, const std::vector<Triangle>& triangles, const float* positions,
                                     std::size_t vertexCount);

private:
    void sort(Device& device, cl_uint count);

    Kernel m_bounds, m_codes, m_count, m_scan, m_scatter;
    Buffer<Triangle> m_triangleBuffer;
    Buffer<float> m_positionBuffer;
    Buffer<cl_uint> m_boundsBuffer, m_groupCounts, m_codesA, m_codesB, m_numbersA, m_numbersB;
};
}  // namespace drape
