#include "host_patch_cull.h"

#include <algorithm>

#include "bullet_plugin/core/scene/growing_arrays.h"

namespace drape
{
namespace
{
constexpr std::uint32_t kWidth = DRAPE_PATCH_WIDTH;
constexpr std::size_t kFirstTests = 1 << 12;
// Minimum tests of the step before for waking threads: such a step's cull takes half a millisecond. Also the minimum
// cloth triangles, wherever they are: culling that many far from everything takes half a millisecond, too.
constexpr std::size_t kLeastTests = 1 << 10;
constexpr std::size_t kLeastTriangles = 1 << 13;
}  // namespace

void HostPatchCull::setTopology(const MeshPool& obstacles, std::size_t firstSlot)
{
    keepPatches(m_layout, firstSlot, kWidth);
    for (std::size_t slot = firstSlot; slot < obstacles.meshCount(); ++slot)
        appendPatches(m_layout, obstacles, slot, obstacles.mesh(slot).m_positions.data(), kWidth);
    makeLevels(m_layout, kWidth);
    m_levelsMoved = true;
    resizeGrowing(m_faces, m_layout.m_faceOwners.size() * DRAPE_FACE_FLOATS);
    resizeGrowing(m_vertices, m_layout.m_vertexOwners.size() * DRAPE_VERTEX_FLOATS);
    resizeGrowing(m_edges, m_layout.m_edgeOwners.size() * DRAPE_EDGE_FLOATS);
    resizeGrowing(m_vertexIds, m_layout.m_vertexOwners.size());
    resizeGrowing(m_edgeIds, m_layout.m_edgeOwners.size());
    resizeGrowing(m_sizes, m_layout.m_patches.size());
    // A vector of lanes is loaded from it; some of them lie behind the last patch's.
    resizeGrowing(m_volumes, m_layout.m_patches.size() * DRAPE_WIDE_NODE_FLOATS + kWidth);
    resizeGrowing(m_wideNodes, std::size_t(m_layout.m_levels.back()) * DRAPE_WIDE_NODE_FLOATS * kWidth);
}

void HostPatchCull::pack(SlotRange slots, const ObstacleView& obstacle)
{
    const ItemRange patches = patchesOf(m_layout, slots);
    if (m_layout.m_patches.empty() || (patches.empty() && !m_levelsMoved)) return;
    if (!patches.empty()) packFeatures(patches, obstacle);
    for (const LevelPlaces& changed : changedPlaces(m_layout, patches, m_levelsMoved, kWidth))
    {
        const ItemRange entries = changed.m_entries;
        const std::vector<std::uint32_t>& levels = m_layout.m_levels;
        if (changed.m_level == 0)
            m_kernels->m_packVolumes(m_layout.m_faceOwners.data(), std::uint32_t(changed.m_children), entries.first(),
                                     entries.last(), obstacle, m_wideNodes.data(), m_sizes.data(), m_volumes.data());
        else
            m_kernels->m_widen(m_wideNodes.data(), levels[changed.m_level - 1], std::uint32_t(changed.m_children),
                               levels[changed.m_level], entries.first(), entries.last());
    }
    m_levelsMoved = false;
}

void HostPatchCull::packFeatures(ItemRange patches, const ObstacleView& obstacle)
{
    const PatchLanes lanes = lanesOf(m_layout, patches, kWidth);
    m_kernels->m_packFaces(m_layout.m_faceOwners.data(), lanes.m_faces.first(), lanes.m_faces.last(), obstacle,
                           m_faces.data());
    m_kernels->m_packVertices(m_layout.m_vertexOwners.data(), lanes.m_vertices.first(), lanes.m_vertices.last(),
                              obstacle, m_vertices.data(), m_vertexIds.data());
    m_kernels->m_packEdges(m_layout.m_edgeOwners.data(), lanes.m_edges.first(), lanes.m_edges.last(), obstacle,
                           m_edges.data(), m_edgeIds.data());
}

void HostPatchCull::giveBackRoom()
{
    for (std::vector<float>* floats : {&m_faces, &m_vertices, &m_edges, &m_sizes, &m_volumes, &m_wideNodes})
        shrinkSparse(*floats);
    for (std::vector<std::uint32_t>* ids : {&m_vertexIds, &m_edgeIds, &m_layout.m_faceOwners, &m_layout.m_faceFeatures,
                                            &m_layout.m_vertexOwners, &m_layout.m_edgeOwners})
        shrinkSparse(*ids);
    shrinkSparse(m_layout.m_patches);
    m_tests = std::vector<FeatureTest>();
}

PackedPatches HostPatchCull::packed() const
{
    return {m_layout.m_patches.data(),
            m_layout.m_levels.data(),
            std::uint32_t(m_layout.m_levels.size() - 1),
            m_wideNodes.data(),
            m_sizes.data(),
            m_volumes.data(),
            m_faces.data(),
            m_vertices.data(),
            m_edges.data(),
            m_layout.m_faceOwners.data(),
            m_vertexIds.data(),
            m_edgeIds.data(),
            nullptr};
}

std::size_t HostPatchCull::cull(const StepCloths& cloths, TestList list, ThreadTeam& threads,
                                StepCounters& counters) const
{
    const PackedPatches patches = packed();
    const bool worth = m_testsBefore >= kLeastTests || cloths.m_count >= kLeastTriangles;
    runShared(threads, worth, (cloths.m_count + kWidth - 1) / kWidth,
              [&](std::size_t packet) { m_kernels->m_cull(std::uint32_t(packet), cloths, patches, list, &counters); });
    return counters.m_candidates;
}

std::uint64_t HostPatchCull::count(const StepCloths& cloths, std::size_t limit, ThreadTeam& threads)
{
    if (m_layout.m_patches.empty()) return 0;
    StepCounters counters = {};
    const TestList nowhere = {m_tests.data(), 0, std::uint32_t(limit), &counters.m_candidates};
    return std::min(cull(cloths, nowhere, threads, counters), limit + 1);
}

std::size_t HostPatchCull::run(const StepCloths& cloths, std::size_t limit, ThreadTeam& threads, StepCounters& counters)
{
    if (m_tests.empty()) m_tests.resize(kFirstTests);
    if (m_layout.m_patches.empty()) return 0;
    const StepCounters before = counters;
    const auto fill = [&]
    {
        counters = before;
        const TestList list = {m_tests.data(), std::uint32_t(m_tests.size()), std::uint32_t(limit),
                               &counters.m_candidates};
        return m_testsBefore = cull(cloths, list, threads, counters);
    };
    return fillGrowing(m_tests, limit, fill);
}
}  // namespace drape
