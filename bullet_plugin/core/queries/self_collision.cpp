#include "self_collision.h"

#include <algorithm>

#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
constexpr std::size_t kFirstEntries = 1 << 14;  // a first guess for each list
}  // namespace

float selfRadius(const CcdSettings& settings)
{
    return 0.5000001f * settings.m_separation;
}

void SelfCollisionStage::create(Device& device, const cl::Program& program)
{
    m_volumesKernel.create(device, program);
    m_traverse.create(device, program);
    m_features.create(device, program);
    m_test.create(device, program);
    m_counters.reserve(device, 1);
    m_pairs.reserve(device, kFirstEntries);
    m_vertexFace.reserve(device, kFirstEntries);
    m_edgePairs.reserve(device, kFirstEntries);
    m_hits.reserve(device, kFirstEntries);
}

void SelfCollisionStage::enqueueVolumes(Device& device, DeviceMotion motion, const CcdSettings& settings)
{
    m_volumes.reserve(device, motion.m_vertexCount);
    m_volumesKernel.launch(device, motion.m_vertexCount, kGroup, {cl_uint(motion.m_vertexCount), selfRadius(settings)},
                           motion.m_start, motion.m_end, m_volumes);
}

void SelfCollisionStage::enqueuePairs(Device& device, DeviceTreeView a, DeviceTreeView b, std::uint32_t kind,
                                      Batch batch, std::uint64_t most)
{
    m_counters.fill(device, 0, 1);
    if (b.m_layout.leafCount() == 0) return;
    const TraverseValues values = {batch.m_first,
                                   batch.m_count,
                                   b.m_layout.root(),
                                   kind,
                                   cl_uint(m_pairs.capacity()),
                                   cl_uint(std::min(most, kMostCounted) + 1)};
    m_traverse.launch(device, batch.m_count, kGroup, values, a.m_nodes, a.m_order, a.m_triangles, b.m_nodes, b.m_order,
                      b.m_triangles, b.m_lastLeaf, m_pairs, m_counters);
}

void SelfCollisionStage::enqueueFeatures(Device& device, DeviceMotion motion)
{
    const SelfFeaturesValues values = {cl_uint(m_pairs.capacity()), cl_uint(m_vertexFace.capacity()),
                                       cl_uint(m_edgePairs.capacity())};
    m_features.launch(device, listWidth(device), listGroup(device), values, m_pairs, motion.m_tree.m_triangles,
                      m_volumes, m_vertexFace, m_edgePairs, m_counters);
}

void SelfCollisionStage::enqueueTests(Device& device, DeviceMotion motion, const CcdSettings& settings)
{
    for (cl_uint kind : {DRAPE_VERTEX_FACE, DRAPE_EDGES})
    {
        Buffer<FeaturePair>& list = kind == DRAPE_VERTEX_FACE ? m_vertexFace : m_edgePairs;
        const SelfTestValues values = {settings, kind, cl_uint(list.capacity()), cl_uint(m_hits.capacity())};
        m_test.launch(device, listWidth(device), listGroup(device), values, list, motion.m_tree.m_triangles,
                      motion.m_edges, motion.m_start, motion.m_end, m_hits, m_counters);
    }
}

void SelfCollisionStage::enqueueReadCounters(Device& device)
{
    m_counters.read(device, &m_read, 1);
}

template <typename T>
SelfCollisionStage::Demand SelfCollisionStage::meet(Device& device, std::size_t wanted, Buffer<T>& list) const
{
    if (wanted <= list.capacity()) return Demand::Met;
    const std::size_t roomy = wanted + wanted / 4 + 1024;
    if (wanted >= DRAPE_DEMAND_LIMIT || roomy * sizeof(T) > m_listBytes) return Demand::TooMuch;
    list.reserve(device, roomy);
    return Demand::Grown;
}

SelfCollisionStage::Demand SelfCollisionStage::meetPairs(Device& device)
{
    return meet(device, m_read.m_pairs, m_pairs);
}

SelfCollisionStage::Demand SelfCollisionStage::meetDemand(Device& device)
{
    return std::max({meetPairs(device), meet(device, m_read.m_vertexFace, m_vertexFace),
                     meet(device, m_read.m_edgeEdge, m_edgePairs), meet(device, m_read.m_hits, m_hits)});
}
}  // namespace drape
