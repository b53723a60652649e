// A list of feature tests on a device: a cull fills it, and a narrow phase runs the tests (kernels/shared/patch.h).
#pragma once

#include "bullet_plugin/core/device/buffer.h"
#include "kernels/shared/patch.h"

namespace drape
{
struct FeatureTestList
{
    explicit FeatureTestList(const std::string& name) : m_tests(name), m_swept(name) {}

    // Contents are lost when it grows.
    void reserve(Device& device, std::size_t count) { m_tests.reserve(device, count); }
    void release()
    {
        m_tests.release();
        m_swept.release();
    }
    std::size_t capacity() const { return m_tests.capacity(); }

    Buffer<FeatureTest> m_tests;
    // Positions of the tests that the continuous test decides; the narrow phase reserves room for all of them.
    Buffer<cl_uint> m_swept;
};
}  // namespace drape
