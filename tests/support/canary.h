// A known pattern behind a device buffer, to see whether a kernel writes past the end.
//
// guard() enlarges the memory behind a Buffer without telling it: its capacity stays what was asked for, and what a
// kernel writes beyond lands in the pattern. Contents of the buffer are lost. intact() waits for the device.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/arena.h"
#include "bullet_plugin/core/device/buffer.h"

namespace drape::test
{
constexpr std::size_t kCanaryWords = 256;
constexpr cl_uint kCanaryPattern = 0xc0ffee11u;

template <typename T>
void guard(Device& device, Buffer<T>& buffer, std::size_t count)
{
    static_assert(sizeof(T) % sizeof(cl_uint) == 0, "canaries are 32-bit words");
    buffer = Buffer<T>();
    buffer.reserve(device, count);
    const std::size_t bytes = buffer.capacity() * sizeof(T);
    cl_int code = CL_SUCCESS;
    buffer.handle() =
        cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes + kCanaryWords * sizeof(cl_uint), nullptr, &code);
    device.check(code, "clCreateBuffer", "with canary");
    device.check(
        device.queue().enqueueFillBuffer(buffer.handle(), kCanaryPattern, bytes, kCanaryWords * sizeof(cl_uint)),
        "clEnqueueFillBuffer");
}

// Fills the guarded buffer with the source; otherwise equal to guard().
template <typename T>
void guardCopy(Device& device, Buffer<T>& buffer, const std::vector<T>& source)
{
    guard(device, buffer, source.size());
    buffer.write(device, source.data(), source.size());
    device.wait();
}

inline bool patternFollows(Device& device, cl::Buffer& buffer, std::size_t bytes)
{
    std::vector<cl_uint> words(kCanaryWords, 0);
    device.check(device.queue().enqueueReadBuffer(buffer, CL_TRUE, bytes, kCanaryWords * sizeof(cl_uint), words.data()),
                 "clEnqueueReadBuffer");
    for (cl_uint word : words)
    {
        if (word != kCanaryPattern) return false;
    }
    return !device.failed();
}

template <typename T>
bool intact(Device& device, Buffer<T>& buffer)
{
    return patternFollows(device, buffer.handle(), buffer.capacity() * sizeof(T));
}

// Puts the pattern behind an arena, whose contents stay. The arena must not grow afterwards.
inline void guard(Device& device, ArenaMemory& arena)
{
    const std::size_t bytes = arena.bytes();
    cl_int code = CL_SUCCESS;
    cl::Buffer guarded(device.context(), CL_MEM_READ_WRITE, bytes + kCanaryWords * sizeof(cl_uint), nullptr, &code);
    device.countBuffer();
    device.check(code, "clCreateBuffer", "with canary");
    device.check(device.queue().enqueueCopyBuffer(arena.handle(), guarded, 0, 0, bytes), "clEnqueueCopyBuffer");
    device.check(device.queue().enqueueFillBuffer(guarded, kCanaryPattern, bytes, kCanaryWords * sizeof(cl_uint)),
                 "clEnqueueFillBuffer");
    arena.handle() = guarded;
}

inline bool intact(Device& device, ArenaMemory& arena)
{
    return patternFollows(device, arena.handle(), arena.bytes());
}

template <typename T>
std::vector<T> contents(Device& device, Buffer<T>& buffer, std::size_t count)
{
    std::vector<T> values(count);
    buffer.read(device, values.data(), count);
    device.wait();
    return values;
}

template <typename T>
std::vector<T> contents(Device& device, const ArenaArray<T>& array, std::size_t count)
{
    std::vector<T> values(count);
    array.read(device, values.data(), count);
    device.wait();
    return values;
}
}  // namespace drape::test
