// The joined cloth nodes, x y z each, m, at a step's start and at its end. They are adjacent, so that one transfer can
// upload both. Contents are lost when they grow.
#pragma once

#include <algorithm>
#include <cstddef>

#include "bullet_plugin/core/device/buffer.h"

namespace drape
{
class ClothNodes
{
public:
    float* start() { return m_floats.data(); }
    float* end() { return m_floats.data() + m_room; }
    const float* start() const { return m_floats.data(); }
    const float* end() const { return m_floats.data() + m_room; }
    // Floats of each.
    std::size_t room() const { return m_room; }
    // device may be null.
    void reserve(Device* device, std::size_t floats)
    {
        if (m_room >= floats && m_room > 0) return;
        constexpr std::size_t kStep = 1024;  // few distinct sizes, so that small additions need no new memory
        m_room = std::max((floats + kStep - 1) / kStep, std::size_t(1)) * kStep;
        m_floats.reserve(device, 2 * m_room);
    }

    // Releases the memory; contents are lost.
    void release()
    {
        m_floats.release();
        m_room = 0;
    }

private:
    Staging<float> m_floats;
    std::size_t m_room = 0;
};
}  // namespace drape
