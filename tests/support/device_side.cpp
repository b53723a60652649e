#include "tests/support/device_side.h"

namespace drape::test
{
void DeviceSide::upload(Device& device, const Side& side)
{
    guardCopy(device, m_nodes, side.m_nodes);
    guardCopy(device, m_order, side.m_order);
    guardCopy(device, m_triangles, side.m_pool.triangles());
    guardCopy(device, m_edges, side.m_pool.edges());
    guardCopy(device, m_start, side.m_start);
    guardCopy(device, m_end, side.m_end);
    guardCopy(device, m_vertexCones, side.m_vertexCones);
    guardCopy(device, m_edgeCones, side.m_edgeCones);
}

bool DeviceSide::allIntact(Device& device)
{
    return intact(device, m_nodes) && intact(device, m_order) && intact(device, m_triangles) &&
           intact(device, m_edges) && intact(device, m_start) && intact(device, m_end) &&
           intact(device, m_vertexCones) && intact(device, m_edgeCones);
}

void DeviceCloths::upload(Device& device, const Side& side)
{
    const MeshPool& pool = side.m_pool;
    std::vector<float> nodes = side.m_start;
    nodes.insert(nodes.end(), side.m_end.begin(), side.m_end.end());
    guardCopy(device, m_nodes, nodes);
    m_triangles.demand(pool.triangles().size());
    m_edges.demand(pool.edges().size());
    m_order.demand(side.m_order.size());
    m_topology.make(device);
    m_triangles.append(device, pool.triangles());
    m_edges.append(device, pool.edges());
    m_order.append(device, side.m_order);
    guard(device, m_topology);
    device.wait();
    m_layout = {m_triangles.word(),
                m_edges.word(),
                m_order.word(),
                cl_uint(side.m_start.size()),
                cl_uint(pool.vertexCount()),
                cl_uint(pool.triangles().size()),
                cl_uint(pool.edges().size())};
}

void DeviceObstacles::upload(Device& device, const Side& side)
{
    m_positions.demand(side.m_start.size());
    m_vertexCones.demand(side.m_vertexCones.size());
    m_edgeCones.demand(side.m_edgeCones.size());
    m_triangles.demand(side.m_pool.triangles().size());
    m_geometry.make(device);
    m_positions.append(device, side.m_start);
    m_vertexCones.append(device, side.m_vertexCones);
    m_edgeCones.append(device, side.m_edgeCones);
    m_triangles.append(device, side.m_pool.triangles());
    guard(device, m_geometry);
    device.wait();
}

cl::Program programOf(Device& device, const std::string& name, const std::string& defines)
{
    ProgramBuild build;
    return buildProgram(device, name, "", build, defines);
}

ProgramLoader programsOf(Device& device)
{
    return [&device](const char* name) { return programOf(device, name); };
}

void clearCounters(Device& device, Buffer<StepCounters>& counters)
{
    guardCopy(device, counters, std::vector<StepCounters>(1));
}

StepCounters readCounters(Device& device, Buffer<StepCounters>& counters)
{
    return contents(device, counters, 1)[0];
}
}  // namespace drape::test
