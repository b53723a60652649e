#include "study/trees/morton_codes.h"

#include <algorithm>
#include <numeric>

#include "bullet_plugin/core/scene/morton_order.h"
#include "kernels/lib/geometry/triangle_order.h"
#include "study/kernels/lib/morton_wide.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;  // see study/kernels/morton_order.cl
// Groups per compute unit that look for the bounds: enough to hide latency, few enough to merge.
constexpr std::size_t kBoundsGroupsPerUnit = 4, kBoundsGroupsPerUnitGpu = 16;
constexpr cl_uint kShortCodeBits = 30;
constexpr cl_uint kLowBits = 32, kHighBits = 31;  // the words of a 63-bit code
// Least and greatest values before any centroid was seen, see study/kernels/morton_order.cl.
const cl_uint kNoBounds[6] = {~0u, ~0u, ~0u, 0u, 0u, 0u};
}  // namespace

MortonOrder sortByMorton(const std::vector<Triangle>& triangles, const float* positions, std::uint32_t codeBits)
{
    const auto [low, high] = centroidBounds(triangles, positions);
    const std::size_t count = triangles.size();
    const bool wide = codeBits != kShortCodeBits;
    std::vector<std::uint64_t> codes(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        const Vec3 centroid = triangleCentroid(&triangles[i], positions);
        std::uint32_t upper = 0, lower = 0;
        if (wide) mortonCodeWide(centroid, low, high, &upper, &lower);
        codes[i] = wide ? std::uint64_t(upper) << 32 | lower : mortonCode(centroid, low, high);
    }
    MortonOrder sorted;
    sorted.m_order.resize(count);
    std::iota(sorted.m_order.begin(), sorted.m_order.end(), 0u);
    std::stable_sort(sorted.m_order.begin(), sorted.m_order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
    for (std::uint32_t i : sorted.m_order)
    {
        sorted.m_high.push_back(std::uint32_t(wide ? codes[i] >> 32 : codes[i]));
        if (wide) sorted.m_low.push_back(std::uint32_t(codes[i]));
    }
    return sorted;
}

void MortonOrderStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program program = load("morton_order");
    m_bounds.create(device, program, "mortonBounds");
    m_codes.create(device, program, "mortonCodes");
    m_sort.create(device, load);
}

void MortonOrderStage::enqueue(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count,
                               cl_uint codeBits, WorkShape shape, Buffer<cl_uint>& order, Buffer<cl_uint>& high,
                               Buffer<cl_uint>& low)
{
    const bool wide = codeBits != kShortCodeBits;
    order.reserve(device, count);
    high.reserve(device, count);
    low.reserve(device, wide ? count : 1);
    m_boundsBuffer.reserve(device, 6);
    m_boundsBuffer.write(device, kNoBounds, 6);
    const std::size_t groupsPerUnit = device.isGpu() ? kBoundsGroupsPerUnitGpu : kBoundsGroupsPerUnit;
    const std::size_t width = std::min<std::size_t>(count, kGroup * groupsPerUnit * device.computeUnits());
    m_bounds.launch(device, width, kGroup, triangles.handle(), positions.handle(), count, m_boundsBuffer.handle());
    m_codes.launch(device, count, kGroup, triangles.handle(), positions.handle(), count, m_boundsBuffer.handle(),
                   codeBits, high.handle(), low.handle(), order.handle());
    if (!wide)
    {
        m_sort.enqueue(device, high, order, count, kShortCodeBits, shape);
        return;
    }
    // By the lower word, then by the upper: the sort is stable.
    m_unsortedHigh.reserve(device, count);
    m_unsortedLow.copy(device, low, count, count);
    std::swap(high, m_unsortedHigh);
    m_sort.enqueue(device, low, order, count, kLowBits, shape);
    m_sort.gather(device, m_unsortedHigh, order, count, high);
    m_sort.enqueue(device, high, order, count, kHighBits, shape);
    m_sort.gather(device, m_unsortedLow, order, count, low);
}
}  // namespace drape
