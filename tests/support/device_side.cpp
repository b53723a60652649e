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
