// The host's kernels for one instruction set: the one of the including file's compilation. That file defines
// DRAPE_KERNEL_SET, the table's name, DRAPE_SELF_KERNEL_SET, the name of the table for cloths with themselves
// (self_kernel_set.h), and DRAPE_INSTRUCTIONS.
#include "build_options.h"

#include "cpu_kernels.h"
#include "kernels/lib/cull_packet.h"
#include "kernels/lib/lane_contacts.h"
#include "opencl_words.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "team.h takes a mask's bytes for such a CPU's");

namespace drape
{
namespace
{
#include "kernels/narrow_phase/narrow_phase.cl"
#include "kernels/narrow_phase/narrow_phase_simd.cl"
#include "kernels/broad_phase/patch_cull.cl"
#include "kernels/scene/patch_pack.cl"

void packFaces(const uint* owners, uint first, uint last, const ObstacleView& obstacle, float* faces)
{
    launch(last - first,
           [&]
           {
               patchPackFaces(owners, first, last, obstacle.m_triangles, obstacle.m_positions, obstacle.m_vertexCones,
                              obstacle.m_edgeCones, faces);
           });
}

void packVertices(const uint* owners, uint first, uint last, const ObstacleView& obstacle, float* vertices, uint* ids)
{
    launch(last - first,
           [&]
           {
               patchPackVertices(owners, first, last, obstacle.m_triangles, obstacle.m_positions,
                                 obstacle.m_vertexCones, vertices, ids);
           });
}

void packEdges(const uint* owners, uint first, uint last, const ObstacleView& obstacle, float* edges, uint* ids)
{
    launch(last - first,
           [&] {
               patchPackEdges(owners, first, last, obstacle.m_triangles, obstacle.m_positions, obstacle.m_edgeCones,
                              edges, ids);
           });
}

void packVolumes(const uint* faceOwners, uint patchCount, uint first, uint last, const ObstacleView& obstacle,
                 float* wideNodes, float* sizes, float* volumes)
{
    launch(last - first,
           [&]
           {
               patchVolumes(faceOwners, patchCount, first, last, obstacle.m_triangles, obstacle.m_positions,
                            obstacle.m_vertexCones, obstacle.m_edgeCones, wideNodes, sizes, volumes);
           });
}

void widen(float* wideNodes, uint below, uint nodeCount, uint level, uint first, uint last)
{
    launch((last - first) * DRAPE_WIDE_NODE_FLOATS,
           [&] { patchWiden(wideNodes, below, nodeCount, level, first, last); });
}

void cull(uint packet, const ClothView& cloth, const HostCloths& cloths, const PackedPatches& patches, HostTests tests,
          StepCounters* counters)
{
    runItem(packet, (cloths.m_count + DRAPE_LANES - 1) / DRAPE_LANES,
            [&]
            {
                patchCull(cloths.m_order, cloth.m_triangles, cloths.m_count, cloth.m_start, cloth.m_end,
                          cloths.m_radius, cloths.m_thickness, cloths.m_obstacleMeshes, cloths.m_reachScale,
                          cloth.m_mode, cloths.m_motions, cloths.m_motionCount, patches.m_wideNodes, patches.m_levels,
                          patches.m_levelCount, patches.m_patches, tests.m_tests, tests.m_capacity, tests.m_limit,
                          counters, patches.m_sizes, patches.m_volumes, patches.m_faces, patches.m_vertices,
                          patches.m_edges);
            });
}

// more: the kernel's arguments after the list of swept tests.
template <class Kernel, class... More>
void runFeatures(Kernel kernel, uint item, uint items, const HostFeatures& all, HostHits hits, uint* swept,
                 StepCounters* counters, More... more)
{
    const ClothView& cloth = all.m_cloth;
    const ObstacleView& obstacle = all.m_obstacle;
    const PackedPatches& patches = all.m_patches;
    runItem(item, items,
            [&]
            {
                kernel(all.m_tests, all.m_count, cloth.m_start, cloth.m_end, cloth.m_triangles, cloth.m_edges,
                       cloth.m_nodeCount, cloth.m_triangleCount, cloth.m_mode, obstacle.m_triangles,
                       obstacle.m_vertexCones, obstacle.m_edgeCones, patches.m_faces, patches.m_vertices,
                       patches.m_edges, patches.m_faceIds, patches.m_vertexIds, patches.m_edgeIds, all.m_motions,
                       hits.m_hits, hits.m_capacity, nullptr, hits.m_slotCount, nullptr, counters, swept, more...);
            });
}

void findHits(uint item, uint items, const HostFeatures& features, HostHits hits, uint* swept, StepCounters* counters)
{
    runFeatures(narrowPhaseFeature, item, items, features, hits, swept, counters);
}

void findSwept(uint item, uint items, const HostFeatures& features, HostHits hits, uint* swept, StepCounters* counters)
{
    runFeatures(narrowPhaseSwept, item, items, features, hits, swept, counters, UINT_MAX);
}
}  // namespace

extern const CpuSelfKernels DRAPE_SELF_KERNEL_SET;
extern const CpuKernels DRAPE_KERNEL_SET;
const CpuKernels DRAPE_KERNEL_SET = {
    DRAPE_INSTRUCTIONS, packFaces, packVertices,          packEdges, packVolumes, widen, cull,
    findHits,           findSwept, &DRAPE_SELF_KERNEL_SET};
}  // namespace drape
