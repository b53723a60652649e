#include "morton_order.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "kernels/lib/triangle_order.h"

namespace drape
{
namespace
{
// As in kernels/morton_order.cl.
constexpr std::size_t kSortGroup = 64;
constexpr std::size_t kSortShare = 8;
constexpr cl_uint kDigitBits = 4;
constexpr cl_uint kCodeBits = 32;  // 30 used; an even number of passes ends in the first buffers
constexpr std::size_t kGroup = 64;
}  // namespace

std::vector<std::uint32_t> mortonOrderOnHost(const std::vector<Triangle>& triangles, const float* positions)
{
    const float infinity = std::numeric_limits<float>::infinity();
    Vec3 low = vec3(infinity, infinity, infinity), high = vec3(-infinity, -infinity, -infinity);
    for (const Triangle& triangle : triangles)
    {
        const Vec3 p = triangleCentroid(&triangle, positions);
        if (!vec3IsFinite(p)) continue;
        low = vec3(drapeMin(low.x, p.x), drapeMin(low.y, p.y), drapeMin(low.z, p.z));
        high = vec3(drapeMax(high.x, p.x), drapeMax(high.y, p.y), drapeMax(high.z, p.z));
    }
    std::vector<std::uint32_t> codes(triangles.size()), order(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
    {
        codes[i] = mortonCode(triangleCentroid(&triangles[i], positions), low, high);
    }
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
    return order;
}

void MortonOrderStage::create(Device& device, const cl::Program& program)
{
    m_bounds.create(device, program, "mortonBounds");
    m_codes.create(device, program, "mortonCodes");
    m_count.create(device, program, "sortCount");
    m_scan.create(device, program, "sortScan");
    m_scatter.create(device, program, "sortScatter");
}

void MortonOrderStage::sort(Device& device, cl_uint count)
{
    const std::size_t groups = (count + kSortGroup * kSortShare - 1) / (kSortGroup * kSortShare);
    const cl_uint counts = cl_uint(groups << kDigitBits);
    m_groupCounts.reserve(device, counts);
    for (cl_uint shift = 0; shift < kCodeBits; shift += kDigitBits)
    {
        m_count.launch(device, groups * kSortGroup, kSortGroup, m_codesA.handle(), count, shift,
                       m_groupCounts.handle());
        m_scan.launch(device, kSortGroup, kSortGroup, m_groupCounts.handle(), counts);
        m_scatter.launch(device, groups * kSortGroup, kSortGroup, m_codesA.handle(), m_numbersA.handle(), count, shift,
                         m_groupCounts.handle(), m_codesB.handle(), m_numbersB.handle());
        std::swap(m_codesA, m_codesB);
        std::swap(m_numbersA, m_numbersB);
    }
}

std::vector<std::uint32_t> MortonOrderStage::order(Device& device, const std::vector<Triangle>& triangles,
                                                   const float* positions, std::size_t vertexCount)
{
    const cl_uint count = cl_uint(triangles.size());
    std::vector<std::uint32_t> order(count);
    if (count == 0) return order;
    for (Buffer<cl_uint>* buffer : {&m_codesA, &m_codesB, &m_numbersA, &m_numbersB})
        buffer->reserve(device, count);
    m_triangleBuffer.assign(device, triangles);
    m_positionBuffer.reserve(device, 3 * vertexCount);
    m_positionBuffer.write(device, positions, 3 * vertexCount);
    const cl_uint unset[6] = {~0u, ~0u, ~0u, 0u, 0u, 0u};
    m_boundsBuffer.reserve(device, 6);
    m_boundsBuffer.write(device, unset, 6);
    const std::size_t width = std::min<std::size_t>(count, 64 * device.computeUnits());
    m_bounds.launch(device, width, kGroup, m_triangleBuffer.handle(), m_positionBuffer.handle(), count,
                    m_boundsBuffer.handle());
    m_codes.launch(device, count, kGroup, m_triangleBuffer.handle(), m_positionBuffer.handle(), count,
                   m_boundsBuffer.handle(), m_codesA.handle(), m_numbersA.handle());
    sort(device, count);
    m_numbersA.read(device, order.data(), count);
    device.wait();
    if (device.failed()) order.clear();
    return order;
}
}  // namespace drape
