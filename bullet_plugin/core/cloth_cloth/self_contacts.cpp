#include "self_contacts.h"

#include "bullet_plugin/core/broad_phase/patch_cull.h"
#include "bullet_plugin/core/device/list_launch.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
constexpr std::size_t kTeamsPerGroup = 8;  // patches per group where a work-item is a team
constexpr std::size_t kFirstTests = 1 << 16;
// Warps of a GPU's group that traverses the tree, or that takes pairs of patches; see
// kernels/cloth_cloth/self_traversal_gpu.cl.
constexpr std::size_t kTurns = 4;
constexpr std::size_t kPairGroupsPerUnit = 24;
constexpr std::size_t kFirstPairs = 1 << 14;
}  // namespace

void SelfContactStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program cull = load(device.isGpu() ? "cloth_cloth/self_traversal_gpu" : "cloth_cloth/self_cull"),
                      contact = load("cloth_cloth/self_contact");
    m_pack.create(device, load(device.isGpu() ? "cloth_cloth/self_pack" : "cloth_cloth/self_pack_simd"), "selfPack");
    if (device.isGpu()) m_walk.create(device, cull, "selfWalk");
    m_cull.create(device, cull, device.isGpu() ? "selfCullPairs" : "selfCull");
    m_pairs.reserve(device, device.isGpu() ? kFirstPairs : 1);
    m_widen.create(device, load("scene/patch_pack"), "patchWiden");
    m_feature.create(device, device.isGpu() ? contact : load("cloth_cloth/self_contact_simd"), "selfFeature");
    m_sweptKernel.create(device, contact, "selfSwept");
    reserveTests(device, kFirstTests);
    // The others run in the first step; a small tree has no upper levels.
    m_wideNodes.reserve(device, 1);
    m_widen.launch(device, kGroup, kGroup, m_wideNodes.handle(), cl_uint(0), cl_uint(0), cl_uint(0), cl_uint(0),
                   cl_uint(0));
    m_created = !device.failed();
}

void SelfContactStage::reserveTests(Device& device, std::size_t count)
{
    m_tests.reserve(device, count);
    m_swept.reserve(device, count);
}

void SelfContactStage::setTopology(Device& device, const MeshPool& cloths, const std::vector<float>& rest)
{
    const std::size_t width = PatchCullStage::width(device);
    m_layout = makePatches(cloths, rest.data(), std::uint32_t(width));
    const std::vector<cl_uint> vertexIds = vertexIdsOf(m_layout.m_vertexOwners, cloths.triangles());
    const std::vector<cl_uint> edgeIds = edgeIdsOf(m_layout.m_edgeOwners, cloths.triangles());
    std::vector<cl_uint> faceNodes, edgeNodes;
    const WaitAtEnd wait(device);
    m_patches.assign(device, m_layout.m_patches);
    m_faceIds.assign(device, m_layout.m_faceOwners);
    m_vertexIds.assign(device, vertexIds);
    m_edgeIds.assign(device, edgeIds);
    if (!device.isGpu())
    {
        faceNodes = faceNodesOf(m_layout.m_faceOwners, cloths.triangles(), std::uint32_t(width));
        edgeNodes = edgeNodesOf(edgeIds, cloths.edges(), std::uint32_t(width));
        m_faceNodes.assign(device, faceNodes);
        m_edgeNodes.assign(device, edgeNodes);
    }
    m_levels.assign(device, m_layout.m_levels);
    const std::size_t floats = device.isGpu() ? 0 : DRAPE_BOX_FLOATS;
    m_faceBoxes.reserve(device, m_layout.m_faceOwners.size() * floats);
    m_vertexBoxes.reserve(device, (device.isGpu() ? cloths.vertexCount() : vertexIds.size()) * DRAPE_BOX_FLOATS);
    m_edgeBoxes.reserve(device, edgeIds.size() * floats);
    m_wideNodes.reserve(device, m_layout.m_levels.back() * DRAPE_WIDE_NODE_FLOATS * width);
    m_rest.assign(device, rest);
}

void SelfContactStage::setReach(Device& device, const SelfReach& reach)
{
    if (m_sentRadius != reach.m_radius)
    {
        m_sentRadius = reach.m_radius;
        m_radius.assign(device, m_sentRadius);
    }
    if (m_sentThickness != reach.m_thickness)
    {
        m_sentThickness = reach.m_thickness;
        m_thickness.assign(device, m_sentThickness);
    }
}

// Computes the volumes of the patches, the tree's lowest level, and of the nodes above.
void SelfContactStage::enqueuePack(Device& device, SelfBuffers step, Buffer<float>& start,
                                   Buffer<StepCounters>& counters)
{
    const std::size_t width = PatchCullStage::width(device);
    const std::size_t places = m_layout.m_levels[1] * width;  // positions among the first level's children
    const cl_uint patchCount = cl_uint(m_layout.m_patches.size());
    if (device.isGpu())
        m_pack.launch(device, places * width, width, m_patches.handle(), patchCount, m_faceIds.handle(),
                      m_vertexIds.handle(), step.m_triangles.handle(), start.handle(), step.m_end.handle(),
                      m_radius.handle(), step.m_obstacleRadius.handle(), m_vertexBoxes.handle(), m_wideNodes.handle(),
                      counters.handle());
    else
        m_pack.launch(device, places, kTeamsPerGroup, m_patches.handle(), patchCount, cl_uint(places),
                      m_faceIds.handle(), m_vertexIds.handle(), m_edgeIds.handle(), step.m_triangles.handle(),
                      step.m_edges.handle(), start.handle(), step.m_end.handle(), m_radius.handle(),
                      step.m_obstacleRadius.handle(), m_faceBoxes.handle(), m_vertexBoxes.handle(),
                      m_edgeBoxes.handle(), m_wideNodes.handle(), counters.handle());
    for (std::size_t level = 1; level + 1 < m_layout.m_levels.size(); ++level)
    {
        const std::size_t below = m_layout.m_levels[level - 1], first = m_layout.m_levels[level];
        const std::size_t children = (m_layout.m_levels[level + 1] - first) * width;
        m_widen.launch(device, children * DRAPE_WIDE_NODE_FLOATS, kGroup, m_wideNodes.handle(), cl_uint(below),
                       cl_uint(first - below), cl_uint(first), cl_uint(0), cl_uint(children));
    }
}

void SelfContactStage::enqueueWalk(Device& device, SelfBuffers step, Buffer<StepCounters>& counters)
{
    const std::size_t group = kTurns * PatchCullStage::width(device), patchCount = m_layout.m_patches.size();
    m_walk.launch(device, patchCount * group, group, m_patches.handle(), m_radius.handle(), m_wideNodes.handle(),
                  m_levels.handle(), cl_uint(m_layout.m_levels.size() - 1), m_pairs.handle(),
                  cl_uint(m_pairs.capacity()), cl_uint(step.m_limit), counters.handle());
}

void SelfContactStage::enqueuePairs(Device& device, SelfBuffers step, Buffer<float>& start,
                                    Buffer<StepCounters>& counters)
{
    const std::size_t group = kTurns * PatchCullStage::width(device);
    m_cull.launch(device, device.computeUnits() * kPairGroupsPerUnit * group, group, m_pairs.handle(),
                  cl_uint(m_pairs.capacity()), m_patches.handle(), m_faceIds.handle(), m_vertexIds.handle(),
                  m_edgeIds.handle(), step.m_triangles.handle(), step.m_edges.handle(), start.handle(),
                  step.m_end.handle(), m_radius.handle(), m_thickness.handle(), m_vertexBoxes.handle(),
                  m_wideNodes.handle(), m_tests.handle(), cl_uint(m_tests.capacity()), cl_uint(step.m_limit),
                  counters.handle());
}

void SelfContactStage::enqueueCull(Device& device, SelfBuffers step, Buffer<StepCounters>& counters)
{
    const std::size_t patchCount = m_layout.m_patches.size();
    Buffer<float>& start = step.m_mode == DRAPE_DISCRETE ? step.m_end : step.m_start;
    if (patchCount == 0) return;
    enqueuePack(device, step, start, counters);
    if (device.isGpu())
    {
        enqueueWalk(device, step, counters);
        enqueuePairs(device, step, start, counters);
        return;
    }
    m_cull.launch(device, patchCount, kTeamsPerGroup, m_patches.handle(), cl_uint(patchCount), m_faceIds.handle(),
                  m_vertexIds.handle(), m_edgeIds.handle(), m_faceNodes.handle(), m_edgeNodes.handle(),
                  step.m_triangles.handle(), step.m_edges.handle(), start.handle(), step.m_end.handle(),
                  m_radius.handle(), m_thickness.handle(), m_faceBoxes.handle(), m_vertexBoxes.handle(),
                  m_edgeBoxes.handle(), m_wideNodes.handle(), m_levels.handle(), cl_uint(m_layout.m_levels.size() - 1),
                  m_tests.handle(), cl_uint(m_tests.capacity()), cl_uint(step.m_limit), counters.handle());
}

void SelfContactStage::enqueueContacts(Device& device, SelfBuffers step, HitBuffers hits,
                                       Buffer<StepCounters>& counters)
{
    const cl_uint nodes = cl_uint(step.m_nodeCount), triangles = cl_uint(step.m_triangleCount);
    const cl_uint firstSlot = firstSelfSlot(nodes, triangles, cl_uint(step.m_edgeCount));
    const auto launch = [&](Kernel& kernel, std::size_t width, std::size_t group)
    {
        kernel.launch(device, width, group, m_tests.handle(), cl_uint(m_tests.capacity()), step.m_start.handle(),
                      step.m_end.handle(), m_rest.handle(), step.m_triangles.handle(), step.m_edges.handle(), nodes,
                      triangles, firstSlot, cl_uint(step.m_mode), step.m_reachScale, hits.m_hits.handle(),
                      cl_uint(hits.m_hits.capacity()), hits.m_hitPlaces.handle(), hits.m_slotCount.handle(),
                      hits.m_slotSums.handle(), counters.handle(), m_swept.handle());
    };
    launch(m_feature, laneListWidth(device), device.isGpu() ? listGroup(device) : 1);
    if (step.m_mode != DRAPE_DISCRETE) launch(m_sweptKernel, listWidth(device), listGroup(device));
}
}  // namespace drape
