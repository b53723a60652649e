// A side's arrays in guarded device buffers, and the stages' programs built once per test.
#pragma once

#include "bullet_plugin/core/queries/refit.h"
#include "bullet_plugin/core/device/program.h"
#include "tests/support/backends.h"
#include "tests/support/canary.h"
#include "tests/support/side.h"

namespace drape::test
{
// Every buffer has a canary behind it.
struct DeviceSide
{
    Buffer<BvhNode> m_nodes;
    Buffer<cl_uint> m_order;
    Buffer<Triangle> m_triangles;
    Buffer<Edge> m_edges;
    Buffer<float> m_start, m_end;
    Buffer<NormalCone> m_vertexCones, m_edgeCones;

    void upload(Device& device, const Side& side);
    bool allIntact(Device& device);
};

// Returns the program of kernels/<name>.cl from the tests' cache.
cl::Program programOf(Device& device, const std::string& name, const std::string& defines = std::string());
// Loads programs for stages that need several.
ProgramLoader programsOf(Device& device);

// Zeroed counters on the device, and reading them back.
void clearCounters(Device& device, Buffer<StepCounters>& counters);
StepCounters readCounters(Device& device, Buffer<StepCounters>& counters);
}  // namespace drape::test
