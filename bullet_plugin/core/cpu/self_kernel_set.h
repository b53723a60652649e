// The host's kernels of cloths with themselves for one instruction set, apart from kernel_set.h: both narrow phases
// have functions of the same names. The including file defines DRAPE_SELF_KERNEL_SET, the table's name.
#include "build_options.h"

#include "cpu_kernels.h"
#include "kernels/lib/cull_packet.h"
#include "kernels/lib/lane_self_contacts.h"
#include "kernels/lib/self_cull.h"
#include "opencl_words.h"

namespace drape
{
namespace
{
#include "kernels/cloth_cloth/self_contact.cl"
#include "kernels/cloth_cloth/self_contact_simd.cl"
#include "kernels/cloth_cloth/self_cull.cl"
#include "kernels/cloth_cloth/self_pack_simd.cl"

// A discrete step's volumes are those of its end.
const float* startOf(const ClothView& cloth)
{
    return cloth.m_mode == DRAPE_DISCRETE ? cloth.m_end : cloth.m_start;
}

void pack(uint item, const ClothView& cloth, const SelfRadii& radii, const SelfPatches& patches, StepCounters* counters)
{
    runItem(item, patches.m_places,
            [&]
            {
                selfPack(patches.m_patches, patches.m_patchCount, patches.m_places, patches.m_faceIds,
                         patches.m_vertexIds, patches.m_edgeIds, cloth.m_triangles, cloth.m_edges, startOf(cloth),
                         cloth.m_end, radii.m_radius, radii.m_obstacleRadius, patches.m_faceBoxes,
                         patches.m_vertexBoxes, patches.m_edgeBoxes, patches.m_wideNodes, counters);
            });
}

void cull(uint item, const ClothView& cloth, const SelfRadii& radii, const SelfPatches& patches, HostTests tests,
          StepCounters* counters)
{
    runItem(item, patches.m_patchCount,
            [&]
            {
                selfCull(patches.m_patches, patches.m_patchCount, patches.m_faceIds, patches.m_vertexIds,
                         patches.m_edgeIds, patches.m_faceNodes, patches.m_edgeNodes, cloth.m_triangles, cloth.m_edges,
                         startOf(cloth), cloth.m_end, radii.m_radius, radii.m_thickness, patches.m_faceBoxes,
                         patches.m_vertexBoxes, patches.m_edgeBoxes, patches.m_wideNodes, patches.m_levels,
                         patches.m_levelCount, tests.m_tests, tests.m_capacity, tests.m_limit, counters);
            });
}

template <class Kernel>
void runFeatures(Kernel kernel, uint item, uint items, const HostSelfFeatures& all, HostHits hits, uint* swept,
                 StepCounters* counters)
{
    const ClothView& cloth = all.m_view.m_cloth;
    runItem(item, items,
            [&]
            {
                kernel(all.m_tests, all.m_count, cloth.m_start, cloth.m_end, all.m_view.m_rest, cloth.m_triangles,
                       cloth.m_edges, cloth.m_nodeCount, cloth.m_triangleCount, all.m_firstSlot, cloth.m_mode,
                       all.m_view.m_reachScale, hits.m_hits, hits.m_capacity, nullptr, hits.m_slotCount, nullptr,
                       counters, swept);
            });
}

void findHits(uint item, uint items, const HostSelfFeatures& features, HostHits hits, uint* swept,
              StepCounters* counters)
{
    runFeatures(selfFeature, item, items, features, hits, swept, counters);
}

void findSwept(uint item, uint items, const HostSelfFeatures& features, HostHits hits, uint* swept,
               StepCounters* counters)
{
    runFeatures(selfSwept, item, items, features, hits, swept, counters);
}
}  // namespace

extern const CpuSelfKernels DRAPE_SELF_KERNEL_SET;
const CpuSelfKernels DRAPE_SELF_KERNEL_SET = {pack, cull, findHits, findSwept};
}  // namespace drape
