// Traversal::Grid: a uniform grid over the obstacle, made anew each step, in place of a walk down trees (see
// study/kernels/lib/grid.h). It reads the trees' leaves alone. Cost: linear in the triangles and in the cells that
// their boxes cover.
#pragma once

#include "study/kernels/lib/grid.h"
#include "study/traversal/device_traversal.h"
#include "study/trees/radix_sort.h"

namespace drape
{
// A grid around the obstacle's leaves whose cells are as large as either side's leaves are on average, or larger.
GridFrame gridFrame(const Hierarchy& cloth, const Hierarchy& obstacle);

class GridTraversal : public DeviceTraversal
{
public:
    GridTraversal(Device& device, const ProgramLoader& load);

    void setTopology(Device& device, const Hierarchy& cloth, const Hierarchy& obstacle) override;
    void enqueue(Device& device, const TraversalStep& step) override;
    bool grow(Device& device, const TraversalCounters& counters, bool& limitReached) override;

private:
    void reserve(Device& device, std::size_t entries);

    BoundKernel<kernels::gridEntries> m_entries;
    BoundKernel<kernels::gridStarts> m_starts;
    BoundKernel<kernels::gridPairs> m_pairs;
    RadixSortStage m_sort;
    Buffer<cl_uint> m_keys, m_places, m_cells;
    GridFrame m_frame = {};
    cl_uint m_clothLeaves = 0, m_obstacleLeaves = 0, m_capacity = 0;
};
}  // namespace drape
