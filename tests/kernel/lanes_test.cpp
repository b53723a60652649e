// Properties of the device's built-in functions that the culls rely on.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bullet_plugin/core/scene/patch_width.h"
#include "kernels/lib/work_items/lanes.h"
#include "tests/support/device_side.h"

namespace drape::test
{
namespace
{
// Returns a kernel in which a work-item takes the roots of a block's lanes, or on a GPU of its own lane.
std::string rootsOf(const Device& device)
{
    const char* const stored =
        device.isGpu() ? "out[get_global_id(0)] = roots;" : "lanesStore(roots, out, get_global_id(0));";
    const char* const loaded = device.isGpu() ? "in[get_global_id(0)]" : "lanesLoad(in, get_global_id(0))";
    return std::string("\n__kernel void takeRoots(__global const float* in, __global float* out)\n{\n") +
           "    const Lanes roots = lanesSqrt(" + loaded + ");\n    " + stored + "\n}\n";
}

// Squares of lengths, and of products of two.
std::vector<float> squares()
{
    std::mt19937 random(11);
    std::uniform_real_distribution<float> exponent(-37.0f, 37.0f);
    std::vector<float> values = {0.0f};
    while (values.size() < 8192)
        values.push_back(std::pow(10.0f, exponent(random)));
    return values;
}

class LanesTest : public DeviceTest
{
};

TEST_P(LanesTest, RootsErrByLessThanTheCullsAllow)
{
    const std::string source =
        patchDefines(*m_device) + assembleSource("kernels/lib/work_items/lanes.h") + rootsOf(*m_device);
    const cl::Program program = compileSource(*m_device, "lanes", source);
    ASSERT_FALSE(m_device->failed()) << m_device->error().text();
    Kernel kernel;
    kernel.create(*m_device, program, "takeRoots");
    const std::vector<float> values = squares();
    Buffer<float> in, out;
    guardCopy(*m_device, in, values);
    guard(*m_device, out, values.size());
    const std::size_t lanes = m_device->isGpu() ? 1 : patchWidth(*m_device);
    kernel.launch(*m_device, values.size() / lanes, 1, in.handle(), out.handle());
    const std::vector<float> roots = contents(*m_device, out, values.size());
    ASSERT_TRUE(intact(*m_device, out)) << m_device->error().text();
    for (std::size_t i = 0; i < values.size(); ++i)
    {
        const double exact = std::sqrt(double(values[i]));
        EXPECT_LE(std::abs(double(roots[i]) - exact), DRAPE_ROOT_ERROR * exact) << values[i];
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, LanesTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace
}  // namespace drape::test
