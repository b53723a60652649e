// A device buffer as a kernel's argument: a buffer or an arena of such elements.
#pragma once

#include "arena.h"
#include "buffer.h"

namespace drape
{
// Valid until the buffer or arena grows, moves or ends.
template <typename T>
class BufferView
{
public:
    BufferView() = default;
    BufferView(const Buffer<T>& buffer) : m_handle(&buffer.handle()) {}
    BufferView(const Arena<T>& arena) : m_handle(&arena.handle()) {}

    const cl::Buffer& handle() const { return *m_handle; }

private:
    const cl::Buffer* m_handle = nullptr;
};
}  // namespace drape
