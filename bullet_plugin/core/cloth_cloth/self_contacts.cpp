#include "self_contacts.h"

#include "bullet_plugin/core/device/list_launch.h"
#include "bullet_plugin/core/scene/patch_width.h"

namespace drape
{
namespace
{
constexpr std::size_t kGroup = 64;
constexpr std::size_t kPatchesPerGroup = 8;  // if a work-item handles a patch alone
constexpr std::size_t kFirstTests = 1 << 16;
// Warps of a GPU's group that traverses the tree, or that takes pairs of patches; see
// kernels/cloth_cloth/self_traversal_gpu.cl.
constexpr std::size_t kTurns = 4;
constexpr std::size_t kPairGroupsPerUnit = 24;
constexpr std::size_t kFirstPairs = 1 << 14;
}  // namespace

void SelfContactStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program contact = load("cloth_cloth/self_contact");
    if (device.isGpu())
    {
        const cl::Program traversal = load("cloth_cloth/self_traversal_gpu");
        m_pack.create(device, load("cloth_cloth/self_pack_gpu"));
        m_walk.create(device, traversal);
        m_cullPairs.create(device, traversal);
        m_feature.create(device, contact);
    }
    else
    {
        m_pack.create(device, load("cloth_cloth/self_pack_simd"));
        m_cull.create(device, load("cloth_cloth/self_cull_simd"));
        m_feature.create(device, load("cloth_cloth/self_contact_simd"));
    }
    m_pairs.reserve(device, device.isGpu() ? kFirstPairs : 1);
    m_widen.create(device, load("scene/patch_pack"));
    m_swept.create(device, contact);
    m_tests.reserve(device, kFirstTests);
    // The others run in the first step; a small tree has no upper levels.
    m_arena.make(device);
    m_widen.launch(device, kGroup, kGroup, WidenValues{}, m_arena);
    m_created = !device.failed();
}

void SelfContactStage::setTopology(Device& device, const MeshPool& cloths, const std::vector<float>& rest)
{
    const bool gpu = device.isGpu();
    const std::uint32_t width = patchWidth(device);
    m_layout = makePatches(cloths, rest.data(), width);
    m_entries = m_layout.m_levels[1] * width;
    const std::vector<cl_uint> vertexIds = vertexIdsOf(m_layout.m_vertexOwners, cloths.triangles());
    const std::vector<cl_uint> edgeIds = edgeIdsOf(m_layout.m_edgeOwners, cloths.triangles());
    std::vector<cl_uint> faceNodes, edgeNodes;
    if (!gpu) faceNodes = faceNodesOf(m_layout.m_faceOwners, cloths.triangles(), width);
    if (!gpu) edgeNodes = edgeNodesOf(edgeIds, cloths.edges(), width);
    m_patches.demand(m_layout.m_patches.size());
    m_faceIds.demand(m_layout.m_faceOwners.size());
    m_vertexIds.demand(vertexIds.size());
    m_edgeIds.demand(edgeIds.size());
    m_levels.demand(m_layout.m_levels.size());
    m_faceNodes.demand(faceNodes.size());
    m_edgeNodes.demand(edgeNodes.size());
    m_faceBoxes.demand(gpu ? 0 : m_layout.m_faceOwners.size() * DRAPE_BOX_FLOATS);
    m_vertexBoxes.demand((gpu ? cloths.vertexCount() : vertexIds.size()) * DRAPE_BOX_FLOATS);
    m_edgeBoxes.demand(gpu ? 0 : edgeIds.size() * DRAPE_BOX_FLOATS);
    m_wideNodes.demand(m_layout.m_levels.back() * DRAPE_WIDE_NODE_FLOATS * std::size_t(width));
    m_arena.make(device);
    const WaitAtEnd wait(device);
    m_patches.append(device, m_layout.m_patches);
    m_faceIds.append(device, m_layout.m_faceOwners);
    m_vertexIds.append(device, vertexIds);
    m_edgeIds.append(device, edgeIds);
    m_levels.append(device, m_layout.m_levels);
    m_faceNodes.append(device, faceNodes);
    m_edgeNodes.append(device, edgeNodes);
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

SelfPatchLayout SelfContactStage::layout() const
{
    return {m_patches.word(),   cl_uint(m_layout.m_patches.size()),
            m_entries,          m_faceIds.word(),
            m_vertexIds.word(), m_edgeIds.word(),
            m_faceNodes.word(), m_edgeNodes.word(),
            m_levels.word(),    cl_uint(m_layout.m_levels.size() - 1),
            m_faceBoxes.word(), m_vertexBoxes.word(),
            m_edgeBoxes.word(), m_wideNodes.word()};
}

// Computes the volumes of the patches, the tree's lowest level, and of the nodes above.
void SelfContactStage::enqueuePack(Device& device, const SelfCullValues& values, const Input& input,
                                   Buffer<StepCounters>& counters)
{
    const std::size_t width = patchWidth(device), entries = values.m_patches.m_entries;
    m_pack.launch(device, device.isGpu() ? entries * width : entries, device.isGpu() ? width : kPatchesPerGroup, values,
                  input.m_cloths.m_nodes, input.m_cloths.m_topology, m_radius, input.m_obstacleRadius, m_arena,
                  counters);
    for (std::size_t level = 1; level + 1 < m_layout.m_levels.size(); ++level)
    {
        const cl_uint below = m_layout.m_levels[level - 1], first = m_layout.m_levels[level];
        const cl_uint children = (m_layout.m_levels[level + 1] - first) * cl_uint(width);
        const WidenValues widen = {m_wideNodes.word(), below, first - below, first, 0, children};
        m_widen.launch(device, children * std::size_t(DRAPE_WIDE_NODE_FLOATS), kGroup, widen, m_arena);
    }
}

void SelfContactStage::enqueueCull(Device& device, const Input& input, Buffer<StepCounters>& counters)
{
    const std::size_t patchCount = m_layout.m_patches.size(), group = kTurns * patchWidth(device);
    if (patchCount == 0) return;
    const SelfCullValues values = {
        input.m_cloths.m_layout, layout(), input.m_mode, cl_uint(m_pairs.capacity()), cl_uint(m_tests.capacity()),
        cl_uint(input.m_limit)};
    enqueuePack(device, values, input, counters);
    if (!device.isGpu())
    {
        m_cull.launch(device, patchCount, kPatchesPerGroup, values, input.m_cloths.m_nodes, input.m_cloths.m_topology,
                      m_radius, m_thickness, m_arena, m_tests.m_tests, counters);
        return;
    }
    m_walk.launch(device, patchCount * group, group, values, m_radius, m_arena, m_pairs, counters);
    m_cullPairs.launch(device, device.computeUnits() * kPairGroupsPerUnit * group, group, values, m_pairs,
                       input.m_cloths.m_nodes, input.m_cloths.m_topology, m_radius, m_thickness, m_arena,
                       m_tests.m_tests, counters);
}

void SelfContactStage::enqueueContacts(Device& device, const Input& input, UnsortedContacts& contacts,
                                       Buffer<StepCounters>& counters)
{
    const ClothLayout& cloths = input.m_cloths.m_layout;
    const SelfFeatureValues values = {cloths,
                                      cl_uint(m_tests.capacity()),
                                      featureCountOf(cloths.m_nodeCount, cloths.m_triangleCount, cloths.m_edgeCount),
                                      input.m_mode,
                                      input.m_reachScale,
                                      cl_uint(contacts.capacity()),
                                      contacts.sums()};
    m_tests.m_swept.reserve(device, m_tests.capacity());
    const auto launch = [&](auto& kernel, std::size_t width, std::size_t group)
    {
        kernel.launch(device, width, group, values, m_tests.m_tests, input.m_cloths.m_nodes, m_rest,
                      input.m_cloths.m_topology, contacts.m_contacts, contacts.m_ranks, contacts.m_featureCounts,
                      counters, m_tests.m_swept);
    };
    launch(m_feature, laneListWidth(device), device.isGpu() ? listGroup(device) : 1);
    if (input.m_mode != DRAPE_DISCRETE) launch(m_swept, listWidth(device), listGroup(device));
}
}  // namespace drape
