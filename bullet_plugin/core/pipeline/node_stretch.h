// Names a range of cloth nodes that a caller writes.
#pragma once

#include <cstddef>

namespace drape
{
// A range of adjacent nodes of a cloth, and the memory to write them to: x y z per node.
struct NodeStretch
{
    std::size_t m_cloth;  // index in the caller's list
    std::size_t m_first, m_count;
    float *m_start, *m_end;  // first node's positions at the step's start and end
};
}  // namespace drape
