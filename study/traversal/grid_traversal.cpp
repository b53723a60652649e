#include "study/traversal/grid_traversal.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;

// The mean of the leaves' largest extents, m; 0 where no leaf is finite.
double meanExtent(const Hierarchy& tree)
{
    double sum = 0;
    std::size_t count = 0;
    for (const BvhNode& node : tree.m_nodes)
    {
        double extent = 0;
        for (int axis = 0; axis < 3; ++axis)
            extent = std::max(extent, double(node.m_high[axis]) - double(node.m_low[axis]));
        if (node.m_count > 0 || !std::isfinite(extent)) continue;
        sum += extent;
        ++count;
    }
    return count == 0 ? 0 : sum / double(count);
}
}  // namespace

GridFrame gridFrame(const Hierarchy& cloth, const Hierarchy& obstacle)
{
    float low[3], extent = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        low[axis] = std::numeric_limits<float>::infinity();
        float high = -low[axis];
        for (const BvhNode& node : obstacle.m_nodes)
        {
            if (node.m_count > 0 || !(node.m_low[axis] <= node.m_high[axis])) continue;
            low[axis] = std::min(low[axis], node.m_low[axis]);
            high = std::max(high, node.m_high[axis]);
        }
        if (!std::isfinite(low[axis]) || !std::isfinite(high)) low[axis] = high = 0;
        extent = std::max(extent, high - low[axis]);
    }
    const double cell = std::max({meanExtent(cloth), meanExtent(obstacle), double(extent) / DRAPE_GRID_SIDE, 1e-30});
    return {vec3(low[0], low[1], low[2]), float(1 / cell)};
}

GridTraversal::GridTraversal(Device& device, const ProgramLoader& load)
{
    const cl::Program program = load("grid");
    m_entries.create(device, program);
    m_starts.create(device, program);
    m_pairs.create(device, program);
    m_sort.create(device, load);
    m_cells.reserve(device, DRAPE_GRID_CELLS + 1);
}

void GridTraversal::reserve(Device& device, std::size_t entries)
{
    m_capacity = cl_uint(entries);
    m_keys.reserve(device, entries);
    m_places.reserve(device, entries);
}

void GridTraversal::setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle)
{
    m_frame = gridFrame(cloth, obstacle);
    m_clothLeaves = cl_uint(cloth.m_order.size());
    m_obstacleLeaves = cl_uint(obstacle.m_order.size());
    if (m_capacity < 2 * m_obstacleLeaves) reserve(device, 2 * std::size_t(m_obstacleLeaves));
}

void GridTraversal::enqueue(Device& device, const TraversalStep& step)
{
    const BroadPhaseBuffers &cloth = step.m_cloth, &obstacle = step.m_obstacle;
    GridValues values = {step.list(), m_frame, m_obstacleLeaves, m_capacity};
    m_keys.fill(device, DRAPE_GRID_CELLS, m_capacity);
    m_entries.launch(device, m_obstacleLeaves, kGroup, values, obstacle.m_nodes, m_keys, m_places, step.m_counters);
    m_sort.enqueue(device, m_keys, m_places, m_capacity, 3 * DRAPE_GRID_BITS + 1, WorkShape::Device);
    m_starts.launch(device, std::size_t(m_capacity) + 1, kGroup, m_capacity, m_keys, m_cells);
    values.m_leafCount = m_clothLeaves;
    m_pairs.launch(device, m_clothLeaves, kGroup, values, cloth.m_nodes, cloth.m_order, cloth.m_triangles,
                   obstacle.m_nodes, obstacle.m_order, obstacle.m_triangles, m_cells, m_places, step.m_thickness,
                   step.m_candidates, step.m_counters);
}

bool GridTraversal::grow(Device& device, const TraversalCounters& counters, bool& limitReached)
{
    if (counters.m_entries <= m_capacity) return false;
    const std::size_t wanted = counters.m_entries + std::size_t(counters.m_entries) / 4;
    limitReached = wanted * sizeof(cl_uint) > device.maxAllocationBytes();
    if (!limitReached) reserve(device, wanted);
    return true;
}
}  // namespace drape
