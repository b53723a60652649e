// Device memory that grows, and host memory that the device can copy fast.
#pragma once

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device.h"

namespace drape
{
// An array of T on the device. Capacity only grows. Element counts, not bytes. Does not outlive its device.
template <typename T>
class Buffer
{
public:
    // The name is for reports of memory; buffers may share one.
    explicit Buffer(std::string name = "other") : m_name(std::move(name)) {}

    std::size_t capacity() const { return m_capacity; }
    cl::Buffer& handle() { return m_buffer; }
    const cl::Buffer& handle() const { return m_buffer; }

    // Makes room for count elements (at least one). Contents are lost when it grows; returns whether it did.
    bool reserve(Device& device, std::size_t count)
    {
        if (m_capacity >= count && m_capacity > 0) return false;
        const std::size_t wanted = count == 0 ? 1 : count;
        cl_int code = CL_SUCCESS;
        m_buffer = cl::Buffer();  // before the new one is made, so that both need not fit
        m_buffer = cl::Buffer(device.context(), CL_MEM_READ_WRITE, wanted * sizeof(T), nullptr, &code);
        device.countBuffer();
        device.check(code, "clCreateBuffer", std::to_string(wanted * sizeof(T)) + " bytes");
        m_capacity = device.failed() ? 0 : wanted;
        m_entry = device.memory().enter(m_name, m_capacity * sizeof(T));
        return true;
    }

    // Grows like reserve() but keeps the first `kept` elements, if any. The new size then includes up to a quarter of
    // spare room.
    void extend(Device& device, std::size_t count, std::size_t kept)
    {
        if (kept == 0 || m_capacity >= count)
        {
            reserve(device, count);
            return;
        }
        const Buffer before = std::exchange(*this, Buffer(m_name));
        const std::size_t most = device.maxAllocationBytes() / sizeof(T);
        reserve(device, std::max(count, std::min(count + count / 4, most)));
        copy(device, before, count, kept);
    }

    // Makes room for count elements and copies the first `copied` from another buffer.
    void copy(Device& device, const Buffer& from, std::size_t count, std::size_t copied)
    {
        reserve(device, count);
        if (device.failed() || copied == 0) return;
        device.check(device.queue().enqueueCopyBuffer(from.m_buffer, m_buffer, 0, 0, copied * sizeof(T)),
                     "clEnqueueCopyBuffer");
    }

    // Releases the memory once all enqueued work has used it.
    void release() { *this = Buffer(m_name); }

    // Enqueue a copy; the source must stay unchanged until a wait for the device.
    void write(Device& device, const T* source, std::size_t count, std::size_t offset = 0)
    {
        if (device.failed() || count == 0) return;
        device.check(
            device.queue().enqueueWriteBuffer(m_buffer, CL_FALSE, offset * sizeof(T), count * sizeof(T), source),
            "clEnqueueWriteBuffer");
    }
    void assign(Device& device, const std::vector<T>& source)
    {
        reserve(device, source.size());
        write(device, source.data(), source.size());
    }
    // Uploads the elements from `first` on; earlier ones stay.
    void append(Device& device, const std::vector<T>& source, std::size_t first)
    {
        extend(device, source.size(), first);
        write(device, source.data() + first, source.size() - first, first);
    }
    void read(Device& device, T* target, std::size_t count, std::size_t offset = 0)
    {
        if (device.failed() || count == 0) return;
        device.check(
            device.queue().enqueueReadBuffer(m_buffer, CL_FALSE, offset * sizeof(T), count * sizeof(T), target),
            "clEnqueueReadBuffer");
    }
    // Fills every element's bytes with copies of a 32-bit pattern.
    void fill(Device& device, cl_uint pattern, std::size_t count)
    {
        if (device.failed() || count == 0) return;
        device.check(device.queue().enqueueFillBuffer(m_buffer, pattern, 0, count * sizeof(T)), "clEnqueueFillBuffer");
    }

private:
    std::string m_name;
    cl::Buffer m_buffer;
    std::shared_ptr<const void> m_entry;
    std::size_t m_capacity = 0;
};

// Host memory for transfers: pinned if there is a device, plain otherwise. Contents are lost when it grows.
template <typename T>
class Staging
{
public:
    Staging() = default;
    Staging(const Staging&) = delete;
    Staging& operator=(const Staging&) = delete;
    ~Staging() { release(); }

    T* data() { return m_data; }
    const T* data() const { return m_data; }
    std::size_t capacity() const { return m_capacity; }

    // device may be null. The memory must not be in use by a transfer.
    void reserve(Device* device, std::size_t count)
    {
        if (m_capacity >= count && m_capacity > 0) return;
        release();
        const std::size_t wanted = count == 0 ? 1 : count;
        if (device && !device->failed()) mapPinned(*device, wanted);
        if (!m_data)
        {
            m_plain.resize(wanted);
            m_data = m_plain.data();
        }
        m_capacity = wanted;
    }

    // Releases the memory, which must not be in use by a transfer.
    void release()
    {
        if (m_queue()) m_queue.enqueueUnmapMemObject(m_pinned, m_data);
        m_queue = cl::CommandQueue();
        m_pinned = cl::Buffer();
        m_plain.clear();
        m_data = nullptr;
        m_capacity = 0;
    }

private:
    void mapPinned(Device& device, std::size_t count)
    {
        cl_int code = CL_SUCCESS;
        m_pinned =
            cl::Buffer(device.context(), CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, count * sizeof(T), nullptr, &code);
        if (code != CL_SUCCESS) return;  // pinned memory is scarce: plain memory works too
        void* mapped = device.queue().enqueueMapBuffer(m_pinned, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0,
                                                       count * sizeof(T), nullptr, nullptr, &code);
        if (code != CL_SUCCESS) return;
        m_data = static_cast<T*>(mapped);
        m_queue = device.queue();
    }

    cl::Buffer m_pinned;
    cl::CommandQueue m_queue;
    std::vector<T> m_plain;
    T* m_data = nullptr;
    std::size_t m_capacity = 0;
};
}  // namespace drape
