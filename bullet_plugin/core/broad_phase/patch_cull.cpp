#include "patch_cull.h"

#include <algorithm>

namespace drape
{
namespace
{
constexpr std::uint32_t kWidthGpu = 32;  // a warp
constexpr std::uint32_t kWidthCpu = 16;  // a vector of 512 bits
constexpr std::size_t kGroup = 64;
// Number of triangles from which a GPU traverses for packets of them.
constexpr std::size_t kManyTriangles = 1 << 15;
// Nodes that a traversing group tests together, for a packet and for one triangle, and pairs per culling group.
constexpr std::size_t kWalkTurns = 4;
constexpr std::size_t kWalkTurnsAlone = 2;
constexpr std::size_t kCullTurns = 4;
// Groups that cull pairs, per compute unit. They are DRAPE_CULL_WAVES times the seven for which an H200's compute unit
// has registers, so that uneven groups balance.
constexpr std::size_t kPairGroupsPerUnit = 28;
constexpr std::size_t kFirstPairs = 1 << 16;
}  // namespace

std::uint32_t PatchCullStage::width(const Device& device)
{
    return device.isGpu() ? kWidthGpu : kWidthCpu;
}

std::string PatchCullStage::defines(const Device& device)
{
    // OpenCL does not bound the error of a native root; NVIDIA does (PTX: 2^-23 of it, over the whole range).
    const bool roots = device.isGpu() && device.info().m_platform.rfind("NVIDIA", 0) == 0;
    return "#define DRAPE_PATCH_WIDTH " + std::to_string(width(device)) + "\n#define DRAPE_LANES " +
           (device.isGpu() ? "1\n" : std::to_string(kWidthCpu) + "\n") + (roots ? "#define DRAPE_NATIVE_ROOTS\n" : "");
}

void PatchCullStage::create(Device& device, const ProgramLoader& load)
{
    const cl::Program cull = load(device.isGpu() ? "broad_phase/patch_cull_pairs" : "broad_phase/patch_cull"),
                      pack = load("scene/patch_pack");
    if (device.isGpu()) m_walk.create(device, load("broad_phase/patch_traversal_gpu"), "patchWalk");
    m_cull.create(device, cull, device.isGpu() ? "patchCullPairs" : "patchCull");
    reserveFirstPairs(device);
    m_packFaces.create(device, pack, "patchPackFaces");
    m_packVertices.create(device, pack, "patchPackVertices");
    m_packEdges.create(device, pack, "patchPackEdges");
    m_volumes.create(device, pack, "patchVolumes");
    m_widen.create(device, pack, "patchWiden");
}

void PatchCullStage::reserveFirstPairs(Device& device)
{
    m_pairs.reserve(device, device.isGpu() ? kFirstPairs : 1);
}

void PatchCullStage::giveBackRoom(Device& device)
{
    m_tests.release();
    m_pairs.release();
    reserveFirstPairs(device);
}

void PatchCullStage::setTopology(Device& device, const MeshPool& obstacles, std::size_t firstSlot)
{
    const std::uint32_t lanes = width(device);
    keepPatches(m_layout, firstSlot, lanes);
    const std::size_t patches = m_layout.m_patches.size(), faces = m_layout.m_faceOwners.size();
    const std::size_t vertices = m_layout.m_vertexOwners.size(), edges = m_layout.m_edgeOwners.size();
    const std::size_t volumes = patches * DRAPE_WIDE_NODE_FLOATS;
    for (std::size_t slot = firstSlot; slot < obstacles.meshCount(); ++slot)
        appendPatches(m_layout, obstacles, slot, obstacles.mesh(slot).m_positions.data(), lanes);
    makeLevels(m_layout, lanes);
    m_levelsMoved = true;
    m_patches.append(device, m_layout.m_patches, patches);
    m_faceOwners.append(device, m_layout.m_faceOwners, faces);
    if (device.isGpu()) m_faceFeatures.append(device, m_layout.m_faceFeatures, faces);
    m_vertexOwnersHeld.m_last = std::min(m_vertexOwnersHeld.m_last, vertices);
    m_edgeOwnersHeld.m_last = std::min(m_edgeOwnersHeld.m_last, edges);
    m_levels.assign(device, m_layout.m_levels);
    m_faces.extend(device, m_layout.m_faceOwners.size() * DRAPE_FACE_FLOATS, faces * DRAPE_FACE_FLOATS);
    m_vertices.extend(device, m_layout.m_vertexOwners.size() * DRAPE_VERTEX_FLOATS, vertices * DRAPE_VERTEX_FLOATS);
    m_edges.extend(device, m_layout.m_edgeOwners.size() * DRAPE_EDGE_FLOATS, edges * DRAPE_EDGE_FLOATS);
    m_vertexIds.extend(device, m_layout.m_vertexOwners.size(), vertices);
    m_edgeIds.extend(device, m_layout.m_edgeOwners.size(), edges);
    m_sizes.extend(device, m_layout.m_patches.size(), patches);
    // A vector of lanes is loaded from it; some of them lie behind the last patch's.
    const std::size_t volumesNow = m_layout.m_patches.size() * DRAPE_WIDE_NODE_FLOATS + lanes;
    if (!device.isGpu())
        m_patchVolumes.extend(device, volumesNow, volumes);
    else
        m_patchVolumes.reserve(device, 1);
    // Keeps the lowest level, which comes first: one position per patch, in nodes of `lanes` patches.
    const std::size_t kept = (patches + lanes - 1) / lanes * lanes * DRAPE_WIDE_NODE_FLOATS;
    m_wideNodes.extend(device, m_layout.m_levels.back() * DRAPE_WIDE_NODE_FLOATS * lanes, kept);
}

void PatchCullStage::releasePacking()
{
    m_vertexOwners.release();
    m_edgeOwners.release();
    m_vertexOwnersHeld = m_edgeOwnersHeld = {0, 0};
}

void PatchCullStage::bringOwners(Device& device, ItemRange vertices, ItemRange edges)
{
    const auto bring =
        [&](Buffer<cl_uint>& buffer, const std::vector<std::uint32_t>& owners, ItemRange& held, ItemRange wanted)
    {
        if (held.m_first <= wanted.m_first && wanted.m_last <= held.m_last) return;
        ItemRange all = wanted;
        if (!held.empty()) all = {std::min(held.m_first, wanted.m_first), std::max(held.m_last, wanted.m_last)};
        buffer.extend(device, all.m_last, held.empty() ? 0 : held.m_last);
        // Uploads the whole range again if it grows at its beginning.
        const std::size_t first = held.empty() || all.m_first < held.m_first ? all.m_first : held.m_last;
        buffer.write(device, owners.data() + first, all.m_last - first, first);
        held = all;
    };
    bring(m_vertexOwners, m_layout.m_vertexOwners, m_vertexOwnersHeld, vertices);
    bring(m_edgeOwners, m_layout.m_edgeOwners, m_edgeOwnersHeld, edges);
}

void PatchCullStage::pack(Device& device, SlotRange slots, Buffer<Triangle>& triangles, Buffer<float>& positions,
                          Buffer<NormalCone>& vertexCones, Buffer<NormalCone>& edgeCones)
{
    const ItemRange patches = patchesOf(m_layout, slots);
    if (m_layout.m_patches.empty() || (patches.count() == 0 && !m_levelsMoved)) return;
    if (patches.count() > 0) packFeatures(device, patches, triangles, positions, vertexCones, edgeCones);
    packVolumes(device, patches, triangles, positions, vertexCones, edgeCones);
    m_levelsMoved = false;
}

void PatchCullStage::packFeatures(Device& device, ItemRange patches, Buffer<Triangle>& triangles,
                                  Buffer<float>& positions, Buffer<NormalCone>& vertexCones,
                                  Buffer<NormalCone>& edgeCones)
{
    const PatchLanes lanes = lanesOf(m_layout, patches, width(device));
    const ItemRange faces = lanes.m_faces, vertices = lanes.m_vertices, edges = lanes.m_edges;
    bringOwners(device, vertices, edges);
    m_packFaces.launch(device, faces.count(), kGroup, m_faceOwners.handle(), faces.first(), faces.last(),
                       triangles.handle(), positions.handle(), vertexCones.handle(), edgeCones.handle(),
                       m_faces.handle());
    m_packVertices.launch(device, vertices.count(), kGroup, m_vertexOwners.handle(), vertices.first(), vertices.last(),
                          triangles.handle(), positions.handle(), vertexCones.handle(), m_vertices.handle(),
                          m_vertexIds.handle());
    m_packEdges.launch(device, edges.count(), kGroup, m_edgeOwners.handle(), edges.first(), edges.last(),
                       triangles.handle(), positions.handle(), edgeCones.handle(), m_edges.handle(),
                       m_edgeIds.handle());
}

// Packs the volumes of the patches and of the wide nodes above them.
void PatchCullStage::packVolumes(Device& device, ItemRange patches, Buffer<Triangle>& triangles,
                                 Buffer<float>& positions, Buffer<NormalCone>& vertexCones,
                                 Buffer<NormalCone>& edgeCones)
{
    for (const LevelPlaces& changed : changedPlaces(m_layout, patches, m_levelsMoved, width(device)))
    {
        const ItemRange places = changed.m_places;
        if (changed.m_level == 0)
        {
            m_volumes.launch(device, places.count(), kGroup, m_faceOwners.handle(), cl_uint(changed.m_children),
                             places.first(), places.last(), triangles.handle(), positions.handle(),
                             vertexCones.handle(), edgeCones.handle(), m_wideNodes.handle(), m_sizes.handle(),
                             m_patchVolumes.handle());
            continue;
        }
        m_widen.launch(device, places.count() * DRAPE_WIDE_NODE_FLOATS, kGroup, m_wideNodes.handle(),
                       cl_uint(m_layout.m_levels[changed.m_level - 1]), cl_uint(changed.m_children),
                       cl_uint(m_layout.m_levels[changed.m_level]), places.first(), places.last());
    }
}

void PatchCullStage::enqueueWalk(Device& device, Cloths cloths, Buffer<StepCounters>& counters)
{
    const bool many = cloths.m_count >= kManyTriangles;
    const std::size_t packet = many ? width(device) : 1;
    const std::size_t groups = (cloths.m_count + packet - 1) / packet;
    const std::size_t group = width(device) * (many ? kWalkTurns : kWalkTurnsAlone);
    m_walk.launch(device, groups * group, group, cloths.m_order.handle(), cloths.m_triangles.handle(),
                  cl_uint(cloths.m_count), cloths.m_start.handle(), cloths.m_end.handle(), cloths.m_radius.handle(),
                  cloths.m_thickness.handle(), cl_uint(cloths.m_obstacleMeshes), cloths.m_reachScale,
                  cl_uint(cloths.m_mode), cloths.m_motions.handle(), cl_uint(cloths.m_motionCount),
                  m_wideNodes.handle(), m_levels.handle(), cl_uint(m_layout.m_levels.size() - 1), m_patches.handle(),
                  m_pairs.handle(), cl_uint(m_pairs.capacity()), cl_uint(cloths.m_pairLimit), counters.handle(),
                  cl_uint(packet));
}

void PatchCullStage::enqueuePairs(Device& device, Cloths cloths, Buffer<StepCounters>& counters)
{
    const std::size_t groups = device.computeUnits() * kPairGroupsPerUnit;
    const std::size_t group = kCullTurns * width(device);
    m_cull.launch(device, groups * group, group, m_pairs.handle(), cl_uint(m_pairs.capacity()),
                  cloths.m_triangles.handle(), cloths.m_start.handle(), cloths.m_end.handle(), cl_uint(cloths.m_mode),
                  cloths.m_motions.handle(), m_patches.handle(), m_sizes.handle(), m_faceFeatures.handle(),
                  m_faces.handle(), m_vertices.handle(), m_edges.handle(), m_tests.handle(),
                  cl_uint(m_tests.capacity()), cl_uint(cloths.m_limit), counters.handle());
}

void PatchCullStage::enqueue(Device& device, Cloths cloths, Buffer<StepCounters>& counters)
{
    if (m_layout.m_patches.empty() || cloths.m_count == 0) return;
    if (device.isGpu())
    {
        enqueueWalk(device, cloths, counters);
        enqueuePairs(device, cloths, counters);
        return;
    }
    const std::size_t packets = (cloths.m_count + kWidthCpu - 1) / kWidthCpu;
    m_cull.launch(device, packets, 1, cloths.m_order.handle(), cloths.m_triangles.handle(), cl_uint(cloths.m_count),
                  cloths.m_start.handle(), cloths.m_end.handle(), cloths.m_radius.handle(), cloths.m_thickness.handle(),
                  cl_uint(cloths.m_obstacleMeshes), cloths.m_reachScale, cl_uint(cloths.m_mode),
                  cloths.m_motions.handle(), cl_uint(cloths.m_motionCount), m_wideNodes.handle(), m_levels.handle(),
                  cl_uint(m_layout.m_levels.size() - 1), m_patches.handle(), m_tests.handle(),
                  cl_uint(m_tests.capacity()), cl_uint(cloths.m_limit), counters.handle(), m_sizes.handle(),
                  m_patchVolumes.handle(), m_faces.handle(), m_vertices.handle(), m_edges.handle());
}
}  // namespace drape
