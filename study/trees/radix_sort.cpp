#include "study/trees/radix_sort.h"

#include <algorithm>

namespace drape
{
namespace
{
// These constants equal those of study/kernels/radix_sort.cl.
constexpr cl_uint kDigits = 256;
constexpr cl_uint kDigitBits = 8;
constexpr std::size_t kGroup = 256;
constexpr cl_uint kTile = 2048;
constexpr std::size_t kGatherGroup = 64;
// Stretches of a serial pass: some per core, so that an unlucky core holds up little, yet long beside their 256 counts.
constexpr std::size_t kStretchesPerUnit = 4;
constexpr cl_uint kLeastStretch = 2048;
}  // namespace

bool runsGroups(const Device& device, WorkShape shape)
{
    return shape == WorkShape::Groups || (shape == WorkShape::Device && device.isGpu());
}

void RadixSortStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program program = load("radix_sort");
    m_countTiles.create(device, program, "radixCountTiles");
    m_countStretches.create(device, program, "radixCountStretches");
    m_scan.create(device, program, "radixScanDigits");
    m_scanSerial.create(device, program, "radixScanDigitsSerial");
    m_scatterTiles.create(device, program, "radixScatterTiles");
    m_scatterStretches.create(device, program, "radixScatterStretches");
    m_gather.create(device, program, "radixGather");
}

void RadixSortStage::passInTiles(Device& device, Buffer<cl_uint>& keys, Buffer<cl_uint>& numbers, cl_uint count,
                                 cl_uint shift)
{
    const cl_uint tiles = (count + kTile - 1) / kTile;
    m_counts.reserve(device, std::size_t(tiles) * kDigits);
    m_countTiles.launch(device, tiles * kGroup, kGroup, keys.handle(), count, shift, m_counts.handle());
    m_scan.launch(device, kDigits * kGroup, kGroup, m_counts.handle(), tiles, m_totals.handle());
    m_scatterTiles.launch(device, tiles * kGroup, kGroup, keys.handle(), numbers.handle(), count, shift,
                          m_counts.handle(), m_totals.handle(), m_otherKeys.handle(), m_otherNumbers.handle());
}

void RadixSortStage::passInStretches(Device& device, Buffer<cl_uint>& keys, Buffer<cl_uint>& numbers, cl_uint count,
                                     cl_uint shift)
{
    const cl_uint wanted = cl_uint(kStretchesPerUnit * device.computeUnits());
    const cl_uint length = std::max(kLeastStretch, (count + wanted - 1) / wanted);
    const cl_uint stretches = (count + length - 1) / length;
    m_counts.reserve(device, std::size_t(stretches) * kDigits);
    m_countStretches.launch(device, stretches, 1, keys.handle(), count, shift, m_counts.handle(), stretches, length);
    m_scanSerial.launch(device, kDigits, kGatherGroup, m_counts.handle(), stretches, m_totals.handle());
    m_scatterStretches.launch(device, stretches, 1, keys.handle(), numbers.handle(), count, shift, m_counts.handle(),
                              m_totals.handle(), m_otherKeys.handle(), m_otherNumbers.handle(), stretches, length);
}

void RadixSortStage::enqueue(Device& device, Buffer<cl_uint>& keys, Buffer<cl_uint>& numbers, cl_uint count,
                             cl_uint bits, WorkShape shape)
{
    m_totals.reserve(device, kDigits);
    m_otherKeys.reserve(device, keys.capacity());
    m_otherNumbers.reserve(device, numbers.capacity());
    for (cl_uint shift = 0; shift < bits && count > 1; shift += kDigitBits)
    {
        if (runsGroups(device, shape))
        {
            passInTiles(device, keys, numbers, count, shift);
        }
        else
        {
            passInStretches(device, keys, numbers, count, shift);
        }
        std::swap(keys, m_otherKeys);
        std::swap(numbers, m_otherNumbers);
    }
}

void RadixSortStage::gather(Device& device, Buffer<cl_uint>& values, Buffer<cl_uint>& numbers, cl_uint count,
                            Buffer<cl_uint>& out)
{
    m_gather.launch(device, count, kGatherGroup, values.handle(), numbers.handle(), count, out.handle());
}
}  // namespace drape
