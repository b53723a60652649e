#include "tree_cost.h"

#include <algorithm>
#include <numeric>

#include "kernels/lib/tree_cost.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 128;
// Groups per compute unit: enough to hide latency, and few sums to read back.
constexpr std::size_t kGroupsPerUnit = 8;
}  // namespace

double treeCostOnHost(const std::vector<BvhNode>& nodes, std::uint32_t root)
{
    std::uint64_t sum = 0;
    for (const BvhNode& node : nodes)
        sum += areaParts(&node, &nodes[root]);
    return double(sum) / double(DRAPE_AREA_PARTS);
}

void TreeCostStage::create(Device& device, const ProgramLoader& load)
{
    m_sums.create(device, load("tree_cost"), "treeCostSums");
}

void TreeCostStage::enqueue(Device& device, Buffer<BvhNode>& nodes, cl_uint nodeCount, cl_uint root)
{
    const std::size_t groups = std::min((nodeCount + kGroup - 1) / kGroup, kGroupsPerUnit * device.computeUnits());
    m_partial.reserve(device, groups);
    m_read.assign(groups, 0);
    m_sums.launch(device, groups * kGroup, kGroup, nodes.handle(), nodeCount, root, m_partial.handle(),
                  cl::Local(kGroup * sizeof(cl_ulong)));
    m_partial.read(device, m_read.data(), groups);
}

double TreeCostStage::cost() const
{
    return double(std::accumulate(m_read.begin(), m_read.end(), cl_ulong(0))) / double(DRAPE_AREA_PARTS);
}
}  // namespace drape
