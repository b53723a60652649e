#include "patch_cull.h"

#include "bullet_plugin/core/scene/patch_width.h"

namespace drape
{
namespace
{
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

void PatchCullStage::create(Device& device, const ProgramLoader& load)
{
    if (device.isGpu())
    {
        m_walk.create(device, load("broad_phase/patch_traversal_gpu"));
        m_cullPairs.create(device, load("broad_phase/patch_cull_pairs_gpu"));
    }
    else
        m_cull.create(device, load("broad_phase/patch_cull_simd"));
    reserveFirstPairs(device);
}

void PatchCullStage::reserveFirstPairs(Device& device)
{
    m_pairs.reserve(device, device.isGpu() ? kFirstPairs : 1);
}

void PatchCullStage::giveBackRoom(Device& device)
{
    m_pairs.release();
    reserveFirstPairs(device);
}

void PatchCullStage::enqueue(Device& device, const ClothBuffers& cloths, const PairBuffers& pairs,
                             const PatchBuffers& patches, Settings settings, FeatureTestList& tests,
                             Buffer<StepCounters>& counters)
{
    const std::size_t triangles = cloths.m_layout.m_triangleCount, width = patchWidth(device);
    if (patches.m_count == 0 || triangles == 0) return;
    const bool many = triangles >= kManyTriangles || !device.isGpu();
    const CullValues values = {cloths.m_layout,
                               patches.m_layout,
                               cl_uint(pairs.m_obstacleMeshes),
                               settings.m_reachScale,
                               settings.m_mode,
                               cl_uint(pairs.m_motionCount),
                               cl_uint(tests.capacity()),
                               cl_uint(settings.m_limit),
                               cl_uint(m_pairs.capacity()),
                               cl_uint(settings.m_pairLimit),
                               cl_uint(many ? width : 1)};
    const std::size_t packets = (triangles + values.m_packet - 1) / values.m_packet;
    if (!device.isGpu())
    {
        m_cull.launch(device, packets, 1, values, cloths.m_nodes, cloths.m_topology, pairs.m_radius, pairs.m_thickness,
                      pairs.m_motions, patches.m_patches, tests.m_tests, counters);
        return;
    }
    const std::size_t walkGroup = width * (many ? kWalkTurns : kWalkTurnsAlone), cullGroup = kCullTurns * width;
    m_walk.launch(device, packets * walkGroup, walkGroup, values, cloths.m_nodes, cloths.m_topology, pairs.m_radius,
                  pairs.m_thickness, pairs.m_motions, patches.m_patches, m_pairs, counters);
    m_cullPairs.launch(device, device.computeUnits() * kPairGroupsPerUnit * cullGroup, cullGroup, values, m_pairs,
                       cloths.m_nodes, cloths.m_topology, pairs.m_motions, patches.m_patches, tests.m_tests, counters);
}
}  // namespace drape
