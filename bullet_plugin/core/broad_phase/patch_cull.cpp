#include "patch_cull.h"

namespace drape
{
namespace
{
constexpr std::uint32_t kWidthGpu = 32;  // a warp
constexpr std::uint32_t kWidthCpu = 16;  // a vector of 512 bits
constexpr std::size_t kGroup = 64;
// Cloth triangles per group where a work-item is a team: small groups even out unequal triangles.
constexpr std::size_t kTeamsPerGroup = 8;
}  // namespace

std::uint32_t PatchCullStage::width(const Device& device)
{
    return device.isGpu() ? kWidthGpu : kWidthCpu;
}

std::string PatchCullStage::defines(const Device& device)
{
    return "#define DRAPE_PATCH_WIDTH " + std::to_string(width(device)) + "\n#define DRAPE_LANES " +
           (device.isGpu() ? "1\n" : std::to_string(kWidthCpu) + "\n");
}

void PatchCullStage::create(Device& device, const cl::Program& program)
{
    m_cull.create(device, program, "patchCull");
    m_packFaces.create(device, program, "patchPackFaces");
    m_packVertices.create(device, program, "patchPackVertices");
    m_packEdges.create(device, program, "patchPackEdges");
    m_volumes.create(device, program, "patchVolumes");
    m_widen.create(device, program, "patchWiden");
}

void PatchCullStage::setTopology(Device& device, const MeshPool& obstacles)
{
    const std::size_t lanes = width(device);
    m_layout = makePatches(obstacles, std::uint32_t(lanes));
    m_patches.assign(device, m_layout.m_patches);
    m_faceOwners.assign(device, m_layout.m_faceOwners);
    m_vertexOwners.assign(device, m_layout.m_vertexOwners);
    m_edgeOwners.assign(device, m_layout.m_edgeOwners);
    m_levels.assign(device, m_layout.m_levels);
    m_faces.reserve(device, m_layout.m_faceOwners.size() * DRAPE_FACE_FLOATS);
    m_vertices.reserve(device, m_layout.m_vertexOwners.size() * DRAPE_VERTEX_FLOATS);
    m_edges.reserve(device, m_layout.m_edgeOwners.size() * DRAPE_EDGE_FLOATS);
    m_vertexIds.reserve(device, m_layout.m_vertexOwners.size());
    m_edgeIds.reserve(device, m_layout.m_edgeOwners.size());
    m_sizes.reserve(device, m_layout.m_patches.size());
    m_wideNodes.reserve(device, m_layout.m_levels.back() * DRAPE_WIDE_NODE_FLOATS * lanes);
    device.wait();
}

void PatchCullStage::pack(Device& device, Buffer<Triangle>& triangles, Buffer<float>& positions, Buffer<float>& spreads,
                          Buffer<NormalCone>& vertexCones, Buffer<NormalCone>& edgeCones)
{
    const auto lanes = [](const std::vector<std::uint32_t>& owners) { return cl_uint(owners.size()); };
    m_packFaces.launch(device, m_layout.m_faceOwners.size(), kGroup, m_faceOwners.handle(),
                       lanes(m_layout.m_faceOwners), triangles.handle(), positions.handle(), spreads.handle(),
                       m_faces.handle());
    m_packVertices.launch(device, m_layout.m_vertexOwners.size(), kGroup, m_vertexOwners.handle(),
                          lanes(m_layout.m_vertexOwners), triangles.handle(), positions.handle(), vertexCones.handle(),
                          m_vertices.handle(), m_vertexIds.handle());
    m_packEdges.launch(device, m_layout.m_edgeOwners.size(), kGroup, m_edgeOwners.handle(),
                       lanes(m_layout.m_edgeOwners), triangles.handle(), positions.handle(), edgeCones.handle(),
                       m_edges.handle(), m_edgeIds.handle());
    const std::size_t width = PatchCullStage::width(device);
    for (std::size_t level = 0; level + 1 < m_layout.m_levels.size(); ++level)
    {
        const cl_uint first = m_layout.m_levels[level];
        const cl_uint places = cl_uint((m_layout.m_levels[level + 1] - first) * width);
        if (level == 0)
        {
            m_volumes.launch(device, places, kGroup, m_faceOwners.handle(), cl_uint(m_layout.m_patches.size()), places,
                             triangles.handle(), positions.handle(), m_wideNodes.handle(), m_sizes.handle());
            continue;
        }
        const cl_uint below = m_layout.m_levels[level - 1];
        m_widen.launch(device, places, kGroup, m_wideNodes.handle(), below, first - below, first, places);
    }
}

void PatchCullStage::enqueue(Device& device, Cloths cloths, Buffer<StepCounters>& counters)
{
    if (m_layout.m_patches.empty() || cloths.m_count == 0) return;
    const std::size_t teamItems = device.isGpu() ? width(device) : 1;
    m_cull.launch(device, cloths.m_count * teamItems, device.isGpu() ? teamItems : kTeamsPerGroup,
                  cloths.m_order.handle(), cloths.m_triangles.handle(), cl_uint(cloths.m_count),
                  cloths.m_start.handle(), cloths.m_end.handle(), cloths.m_radius.handle(), m_wideNodes.handle(),
                  m_levels.handle(), cl_uint(m_layout.m_levels.size() - 1), m_patches.handle(), m_sizes.handle(),
                  m_faces.handle(), m_vertices.handle(), m_edges.handle(), cloths.m_thickness.handle(),
                  cl_uint(cloths.m_obstacleMeshes), cloths.m_reachScale, cl_uint(cloths.m_mode), m_tests.handle(),
                  cl_uint(m_tests.capacity()), cl_uint(cloths.m_limit), counters.handle());
}
}  // namespace drape
