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
    m_volumesKernel.create(device, program, "selfVolumes");
    m_traverse.create(device, program, "leafTraverse");
    m_features.create(device, program, "selfFeatures");
    m_test.create(device, program, "selfTest");
    m_counters.reserve(device, 1);
    m_pairs.reserve(device, kFirstEntries);
    m_vertexFace.reserve(device, kFirstEntries);
    m_edgePairs.reserve(device, kFirstEntries);
    m_hits.reserve(device, kFirstEntries);
}

void SelfCollisionStage::enqueueVolumes(Device& device, DeviceMotion motion, const CcdSettings& settings)
{
    m_volumes.reserve(device, motion.m_vertexCount);
    m_volumesKernel.launch(device, motion.m_vertexCount, kGroup, motion.m_start.handle(), motion.m_end.handle(),
                           cl_uint(motion.m_vertexCount), selfRadius(settings), m_volumes.handle());
}

void SelfCollisionStage::enqueuePairs(Device& device, DeviceTreeView a, DeviceTreeView b, std::uint32_t kind,
                                      Batch batch, std::uint64_t most)
{
    m_counters.fill(device, 0, 1);
    if (b.m_layout.leafCount() == 0) return;
    m_traverse.launch(device, batch.m_count, kGroup, a.m_nodes.handle(), a.m_order.handle(), a.m_triangles.handle(),
                      cl_uint(batch.m_first), cl_uint(batch.m_count), b.m_nodes.handle(), b.m_order.handle(),
                      b.m_triangles.handle(), cl_uint(b.m_layout.root()), b.m_lastLeaf.handle(), cl_uint(kind),
                      m_pairs.handle(), cl_uint(m_pairs.capacity()), cl_uint(std::min(most, kMostCounted) + 1),
                      m_counters.handle());
}

void SelfCollisionStage::enqueueFeatures(Device& device, DeviceMotion motion)
{
    m_features.launch(device, listWidth(device), listGroup(device), m_pairs.handle(), cl_uint(m_pairs.capacity()),
                      motion.m_tree.m_triangles.handle(), m_volumes.handle(), m_vertexFace.handle(),
                      cl_uint(m_vertexFace.capacity()), m_edgePairs.handle(), cl_uint(m_edgePairs.capacity()),
                      m_counters.handle());
}

void SelfCollisionStage::enqueueTests(Device& device, DeviceMotion motion, const CcdSettings& settings)
{
    for (cl_uint kind : {DRAPE_VERTEX_FACE, DRAPE_EDGES})
    {
        Buffer<FeaturePair>& list = kind == DRAPE_VERTEX_FACE ? m_vertexFace : m_edgePairs;
        m_test.launch(device, listWidth(device), listGroup(device), kind, list.handle(), cl_uint(list.capacity()),
                      motion.m_tree.m_triangles.handle(), motion.m_edges.handle(), motion.m_start.handle(),
                      motion.m_end.handle(), settings.m_separation, settings.m_tolerance, settings.m_timeTolerance,
                      cl_uint(settings.m_boxLimit), m_hits.handle(), cl_uint(m_hits.capacity()), m_counters.handle());
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
