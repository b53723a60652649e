#include "arena.h"

#include <algorithm>
#include <utility>

namespace drape
{
namespace
{
// Arrays begin at multiples of a cache line of any device, which are multiples of every vector, too.
constexpr std::size_t kAlignment = 256;
// Positions are words of 32 bits.
constexpr std::size_t kMostBytes = (std::size_t(1) << 32) * sizeof(cl_uint);
}  // namespace

std::size_t ArenaMemory::add(std::string name, std::size_t elementBytes)
{
    Array array;
    array.m_name = std::move(name);
    array.m_elementBytes = elementBytes;
    m_arrays.push_back(array);
    return m_arrays.size() - 1;
}

void ArenaMemory::demand(std::size_t array, std::size_t count, std::size_t kept)
{
    m_arrays[array].m_wanted = std::max(count, std::size_t(1));
    m_arrays[array].m_kept = std::min(kept, m_arrays[array].m_capacity);
    m_arrays[array].m_demanded = true;
}

bool ArenaMemory::fits() const
{
    return m_bytes > 0 && std::all_of(m_arrays.begin(), m_arrays.end(),
                                      [](const Array& array) { return array.m_wanted <= array.m_capacity; });
}

std::size_t ArenaMemory::place(std::vector<Array>& arrays, bool spare) const
{
    std::size_t bytes = 0;
    for (Array& array : arrays)
    {
        if (array.m_wanted > array.m_capacity)
            array.m_capacity = array.m_wanted + (spare && array.m_kept > 0 ? array.m_wanted / 4 : 0);
        array.m_capacity = std::max(array.m_capacity, std::size_t(1));
        array.m_first = bytes;
        bytes += (array.m_capacity * array.m_elementBytes + kAlignment - 1) / kAlignment * kAlignment;
    }
    return bytes;
}

void ArenaMemory::make(Device& device)
{
    if (fits() || device.failed())
    {
        for (Array& array : m_arrays)
        {
            array.m_wanted = 0;
            array.m_demanded = false;
        }
        return;
    }
    for (Array& array : m_arrays)
        if (!std::exchange(array.m_demanded, false)) array.m_kept = array.m_capacity;
    std::vector<Array> arrays = m_arrays;
    const std::size_t most = std::min(device.maxAllocationBytes(), kMostBytes);
    std::size_t bytes = place(arrays, true);
    if (bytes > most)
    {
        arrays = m_arrays;
        bytes = place(arrays, false);
    }
    const bool keeps =
        std::any_of(m_arrays.begin(), m_arrays.end(), [](const Array& array) { return array.m_kept > 0; });
    cl::Buffer before = std::exchange(m_buffer, cl::Buffer());
    if (!keeps) before = cl::Buffer();  // before the new one is made, so that both need not fit
    cl_int code = bytes > kMostBytes ? CL_INVALID_BUFFER_SIZE : CL_SUCCESS;
    if (code == CL_SUCCESS) m_buffer = cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes, nullptr, &code);
    device.countBuffer();
    if (!device.check(code, "clCreateBuffer", std::to_string(bytes) + " bytes")) return release();
    for (std::size_t i = 0; i < arrays.size(); ++i)
    {
        Array &from = m_arrays[i], &to = arrays[i];
        if (from.m_kept > 0)
            device.check(device.queue().enqueueCopyBuffer(before, m_buffer, from.m_first, to.m_first,
                                                          from.m_kept * from.m_elementBytes),
                         "clEnqueueCopyBuffer");
        to.m_entry = device.memory().enter(to.m_name, to.m_capacity * to.m_elementBytes);
        to.m_wanted = 0;
    }
    m_arrays = std::move(arrays);
    m_bytes = bytes;
}

void ArenaMemory::release()
{
    m_buffer = cl::Buffer();
    m_bytes = 0;
    for (Array& array : m_arrays)
    {
        array.m_capacity = array.m_first = array.m_wanted = array.m_kept = 0;
        array.m_demanded = false;
        array.m_entry.reset();
    }
}

void ArenaMemory::write(Device& device, std::size_t array, const void* source, std::size_t count, std::size_t offset)
{
    if (device.failed() || count == 0) return;
    const Array& at = m_arrays[array];
    device.check(device.queue().enqueueWriteBuffer(m_buffer, CL_FALSE, at.m_first + offset * at.m_elementBytes,
                                                   count * at.m_elementBytes, source),
                 "clEnqueueWriteBuffer");
}

void ArenaMemory::read(Device& device, std::size_t array, void* target, std::size_t count, std::size_t offset)
{
    if (device.failed() || count == 0) return;
    const Array& at = m_arrays[array];
    device.check(device.queue().enqueueReadBuffer(m_buffer, CL_FALSE, at.m_first + offset * at.m_elementBytes,
                                                  count * at.m_elementBytes, target),
                 "clEnqueueReadBuffer");
}

void ArenaMemory::copy(Device& device, std::size_t array, const ArenaMemory& from, std::size_t fromArray,
                       std::size_t count)
{
    if (device.failed() || count == 0) return;
    const Array &source = from.m_arrays[fromArray], &target = m_arrays[array];
    device.check(device.queue().enqueueCopyBuffer(from.m_buffer, m_buffer, source.m_first, target.m_first,
                                                  count * target.m_elementBytes),
                 "clEnqueueCopyBuffer");
}
}  // namespace drape
