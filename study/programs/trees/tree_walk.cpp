#include "study/programs/trees/tree_walk.h"

#include <algorithm>
#include <stdexcept>

#include "benchmarks/support/result_hash.h"
#include "bullet_plugin/core/ordering/canonical_order.h"
#include "kernels/lib/geometry/dop.h"

namespace drape::bench
{
std::string Found::hash()
{
    sortCandidates(m_candidates);
    return hashText(hashOf(m_candidates));
}

void walkOnHost(const Hierarchy& obstacle, const ClothQueries& cloth, Found& found)
{
    std::vector<std::uint32_t> stack;
    found = Found();
    for (const BvhNode& query : cloth.m_nodes)
    {
        stack.assign(1, obstacle.m_root);
        while (!stack.empty())
        {
            const BvhNode& node = obstacle.m_nodes[stack.back()];
            stack.pop_back();
            ++found.m_tests;
            if (!nodesOverlap(&query, &node)) continue;
            if (node.m_count == 0) found.m_candidates.push_back({query.m_first, obstacle.m_order[node.m_first]});
            for (std::uint32_t child = 0; child < node.m_count; ++child)
                stack.push_back(node.m_first + child);
        }
    }
}

DeviceWalk::DeviceWalk(Device& device, const Hierarchy& obstacle, const ClothQueries& cloth, std::size_t room)
    : m_device(device), m_root(obstacle.m_root), m_count(cl_uint(cloth.m_nodes.size()))
{
    m_walk.create(device, studyPrograms(device)("leaf_walk"), "leafWalk");
    m_volumes.assign(device, cloth.m_nodes);
    m_candidates.reserve(device, room);
    m_counters.reserve(device, 1);
    device.wait();
}

double DeviceWalk::run(Buffer<BvhNode>& nodes, Buffer<cl_uint>& order, double& kernelMs)
{
    constexpr std::size_t kGroup = 32;
    m_device.profiler()->take();
    const Clock::time_point start = Clock::now();
    m_counters.fill(m_device, 0, 1);
    m_walk.launch(m_device, m_count, kGroup, m_volumes.handle(), m_count, nodes.handle(), order.handle(), m_root,
                  m_candidates.handle(), m_counters.handle(), cl_uint(m_candidates.capacity()));
    m_device.wait();
    const double ms = millisecondsSince(start);
    if (m_device.failed()) throw std::runtime_error(m_device.error().text());
    kernelMs = totalMs(m_device.profiler()->take());
    return ms;
}

Found DeviceWalk::found()
{
    TraversalCounters counters = {};
    m_counters.read(m_device, &counters, 1);
    m_device.wait();
    Found found;
    found.m_candidates.resize(std::min<std::size_t>(counters.m_candidates, m_candidates.capacity()));
    m_candidates.read(m_device, found.m_candidates.data(), found.m_candidates.size());
    m_device.wait();
    return found;
}
}  // namespace drape::bench
