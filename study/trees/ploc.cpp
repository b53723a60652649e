#include "study/trees/ploc.h"

#include <algorithm>
#include <cassert>

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
// Clusters of a work-item, and work-items of a group, when a round is counted and merged.
constexpr cl_uint kGroupsShare = 4, kSerialShare = 256;
constexpr std::size_t kGroupsGroup = 256, kSerialGroup = 16;
// Rounds between two looks at how many clusters are left; a round leaves about 0.6 of them, so few are launched in
// vain.
constexpr cl_uint kBatch = 6;
// Rounds there can be: each adds at most one to the height.
constexpr cl_uint kMostRounds = DRAPE_TREE_HEIGHT;

struct HostClusters
{
    std::vector<Box> m_boxes;
    std::vector<std::uint32_t> m_numbers;
};

// One round on the host: the clusters that are left, and those that were made behind the others.
HostClusters mergeRound(const HostClusters& from, std::uint32_t round, std::uint32_t radius, std::uint32_t leafCount,
                        std::vector<Cluster>& clusters, std::vector<std::uint32_t>& sizes)
{
    const std::uint32_t count = std::uint32_t(from.m_boxes.size());
    const int forced = plocIsForced(round, count);
    std::vector<std::uint32_t> nearest(count);
    for (std::uint32_t i = 0; i < count; ++i)
        nearest[i] = plocNearest(from.m_boxes.data(), count, i, radius, forced);
    HostClusters to;
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const std::uint32_t j = nearest[i];
        Box box = from.m_boxes[i];
        std::uint32_t number = from.m_numbers[i];
        if (j != i && nearest[j] == i)
        {
            if (j < i) continue;
            box = boxUnion(&box, &from.m_boxes[j]);
            clusters.push_back(Cluster{number, from.m_numbers[j]});
            sizes.push_back(sizes[number] + sizes[from.m_numbers[j]]);
            number = leafCount + std::uint32_t(clusters.size()) - 1;
        }
        to.m_boxes.push_back(box);
        to.m_numbers.push_back(number);
    }
    return to;
}
}  // namespace

Tree buildPlocOnHost(const std::vector<Triangle>& triangles, const float* positions, std::uint32_t codeBits,
                     std::uint32_t radius)
{
    Tree tree;
    const std::uint32_t count = std::uint32_t(triangles.size());
    const MortonOrder sorted = sortByMorton(triangles, positions, codeBits);
    resizeTree(tree, count);
    tree.m_order = sorted.m_order;
    if (count == 1) treeSetLeaf(tree.m_nodes.data(), 0, 0);
    if (count <= 1) return tree;
    HostClusters left;
    std::vector<Cluster> clusters;
    std::vector<std::uint32_t> sizes(count, 1);
    for (std::uint32_t i = 0; i < count; ++i)
    {
        left.m_boxes.push_back(boxOfTriangle(&triangles[sorted.m_order[i]], positions));
        left.m_numbers.push_back(i);
    }
    for (std::uint32_t round = 0; left.m_boxes.size() > 1; ++round)
        left = mergeRound(left, round, radius, count, clusters, sizes);
    std::vector<ClusterPlace> places(clusters.size());
    places.back() = ClusterPlace{0, 0};
    for (std::size_t cluster = clusters.size(); cluster-- > 0;)
    {
        plocLink(tree.m_nodes.data(), tree.m_splits.data(), tree.m_order.data(), sorted.m_order.data(), clusters.data(),
                 sizes.data(), places.data(), count, std::uint32_t(cluster));
    }
    return tree;
}

void PlocStage::create(Device& device, const ProgramLoader& load)
{
    m_order.create(device, load);
    const cl::Program program = load("ploc");
    m_leaves.create(device, program, "plocLeaves");
    m_nearest.create(device, program, "plocFindNearest");
    m_count.create(device, program, "plocCount");
    m_merge.create(device, program);
    m_place.create(device, program, "plocPlace");
}

void PlocStage::reserve(Device& device, cl_uint count)
{
    m_boxes.reserve(device, count);
    m_boxesOut.reserve(device, count);
    m_numbers.reserve(device, count);
    m_numbersOut.reserve(device, count);
    m_nearestOf.reserve(device, count);
    m_clusters.reserve(device, count);
    m_places.reserve(device, count);
    m_sizes.reserve(device, 2 * std::size_t(count));
    m_blockCounts.reserve(device, count / (kGroupsGroup * kGroupsShare) + 1);
    m_rounds.reserve(device, 2 * (kMostRounds + kBatch + 1));
}

void PlocStage::enqueueRound(Device& device, cl_uint round, cl_uint most, cl_uint radius, bool groups,
                             cl_uint leafCount)
{
    const cl_uint share = groups ? kGroupsShare : kSerialShare;
    const std::size_t group = groups ? kGroupsGroup : kSerialGroup;
    const std::size_t items = (std::size_t(most) + share - 1) / share;
    m_nearest.launch(device, most, kGroup, m_boxes.handle(), m_rounds.handle(), round, radius, m_nearestOf.handle());
    m_count.launch(device, items, group, m_nearestOf.handle(), m_rounds.handle(), round, share, m_blockCounts.handle(),
                   cl::Local(group * sizeof(cl_uint)));
    m_merge.launch(device, items, group, {round, share, leafCount}, m_boxes, m_numbers, m_nearestOf, m_rounds,
                   m_blockCounts, m_boxesOut, m_numbersOut, m_clusters, m_sizes, group);
    std::swap(m_boxes, m_boxesOut);
    std::swap(m_numbers, m_numbersOut);
}

void PlocStage::build(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, cl_uint count,
                      cl_uint codeBits, cl_uint radius, WorkShape shape, DeviceTree& tree)
{
    assert(count > 0 && radius > 0);
    reserve(device, count);
    m_order.enqueue(device, triangles, positions, count, codeBits, shape, m_mortonOrder, m_high, m_low);
    m_leaves.launch(device, count, kGroup, triangles.handle(), positions.handle(), m_mortonOrder.handle(), count,
                    m_boxes.handle(), m_numbers.handle(), m_sizes.handle(), m_rounds.handle());
    std::vector<cl_uint> rounds = {count, 0};
    while (rounds[rounds.size() - 2] > 1 && !device.failed())
    {
        const cl_uint first = cl_uint(rounds.size() / 2 - 1), most = rounds[rounds.size() - 2];
        for (cl_uint round = first; round < first + kBatch; ++round)
            enqueueRound(device, round, most, radius, runsGroups(device, shape), count);
        rounds.resize(rounds.size() + 2 * kBatch);
        m_rounds.read(device, rounds.data(), rounds.size());
        device.wait();
    }
    for (std::size_t round = rounds.size() / 2 - 1; round-- > 0;)
    {
        const cl_uint first = rounds[2 * round + 1], made = rounds[2 * round + 3] - first;
        m_place.launch(device, made, kGroup, tree.m_nodes.handle(), tree.m_splits.handle(), tree.m_order.handle(),
                       m_mortonOrder.handle(), m_clusters.handle(), m_sizes.handle(), m_places.handle(), count, first,
                       made);
    }
    if (count == 1)
    {
        m_place.launch(device, 1, kGroup, tree.m_nodes.handle(), tree.m_splits.handle(), tree.m_order.handle(),
                       m_mortonOrder.handle(), m_clusters.handle(), m_sizes.handle(), m_places.handle(), count,
                       cl_uint(0), cl_uint(0));
    }
}
}  // namespace drape
