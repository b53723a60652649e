// A side's arrays in guarded device buffers, and the stages' programs built once per test.
#pragma once

#include "bullet_plugin/core/queries/refit.h"
#include "bullet_plugin/core/device/program.h"
#include "bullet_plugin/core/scene/device_views.h"
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

// A side as cloths or as obstacles, in arenas with canaries behind them.
class DeviceCloths
{
public:
    void upload(Device& device, const Side& side);
    bool allIntact(Device& device) { return intact(device, m_nodes) && intact(device, m_topology); }
    ClothBuffers buffers() const { return {m_nodes, m_topology, m_layout}; }

private:
    Buffer<float> m_nodes;
    Arena<ClothWord> m_topology;
    ArenaArray<Triangle> m_triangles{m_topology, "test"};
    ArenaArray<Edge> m_edges{m_topology, "test"};
    ArenaArray<cl_uint> m_order{m_topology, "test"};
    ClothLayout m_layout = {};
};

class DeviceObstacles
{
public:
    void upload(Device& device, const Side& side);
    bool allIntact(Device& device) { return intact(device, m_geometry); }
    ObstacleBuffers buffers() const
    {
        return {m_geometry, {m_positions.word(), m_vertexCones.word(), m_edgeCones.word(), m_triangles.word()}};
    }

private:
    Arena<ObstacleWord> m_geometry;
    ArenaArray<float> m_positions{m_geometry, "test"};
    ArenaArray<NormalCone> m_vertexCones{m_geometry, "test"}, m_edgeCones{m_geometry, "test"};
    ArenaArray<Triangle> m_triangles{m_geometry, "test"};
};

// Returns the program of kernels/<name>.cl from the tests' cache.
cl::Program programOf(Device& device, const std::string& name, const std::string& defines = std::string());
// Loads programs for stages that need several.
ProgramLoader programsOf(Device& device);

// Zeroed counters on the device, and reading them back.
void clearCounters(Device& device, Buffer<StepCounters>& counters);
StepCounters readCounters(Device& device, Buffer<StepCounters>& counters);
}  // namespace drape::test
