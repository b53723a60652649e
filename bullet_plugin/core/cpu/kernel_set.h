// The host's kernels for one instruction set: the one of the including file's compilation. That file defines
// DRAPE_KERNEL_SET, the table's name, DRAPE_SELF_KERNEL_SET, the name of the table for cloths with themselves
// (self_kernel_set.h), and DRAPE_INSTRUCTIONS.
#include "build_options.h"

#include "cpu_kernels.h"
#include "kernels/lib/broad_phase/cull_packet.h"
#include "kernels/lib/narrow_phase/lane_contacts.h"
#include "opencl_words.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "simd_group.h takes a mask's bytes for such a CPU's");

namespace drape
{
namespace
{
#include "kernels/narrow_phase/narrow_phase.cl"
#include "kernels/narrow_phase/narrow_phase_simd.cl"
#include "kernels/broad_phase/patch_cull_simd.cl"
#include "kernels/scene/patch_pack.cl"

void packFaces(const uint* owners, uint first, uint last, const ObstacleView& obstacle, float* faces)
{
    for (uint i = first; i < last; ++i)
        packFace(&obstacle, owners, i, faces);
}

void packVertices(const uint* owners, uint first, uint last, const ObstacleView& obstacle, float* vertices, uint* ids)
{
    for (uint i = first; i < last; ++i)
        packVertex(&obstacle, owners, i, vertices, ids);
}

void packEdges(const uint* owners, uint first, uint last, const ObstacleView& obstacle, float* edges, uint* ids)
{
    for (uint i = first; i < last; ++i)
        packEdge(&obstacle, owners, i, edges, ids);
}

void packVolumes(const uint* faceOwners, uint patchCount, uint first, uint last, const ObstacleView& obstacle,
                 float* wideNodes, float* sizes, float* volumes)
{
    for (uint patch = first; patch < last; ++patch)
        packVolume(&obstacle, faceOwners, patchCount, patch, wideNodes, sizes, volumes);
}

void widen(float* wideNodes, uint below, uint nodeCount, uint level, uint first, uint last)
{
    for (uint node = first; node < last; ++node)
        for (uint row = 0; row < DRAPE_WIDE_NODE_FLOATS; ++row)
            widenChild(wideNodes, below, nodeCount, level, node, row);
}

void cull(uint packet, const StepCloths& cloths, const PackedPatches& patches, const TestList& tests,
          StepCounters* counters)
{
    cullPacket(&cloths, &patches, packet, &tests, counters);
}

void findContacts(uint item, uint items, const FeatureInput& input, const ContactSink& sink, uint* swept,
                  StepCounters* counters)
{
    runItem(item, items, [&] { runFeatureTests(&input, &sink, swept, counters); });
}

void findSwept(uint item, uint items, const FeatureInput& input, const ContactSink& sink, uint* swept,
               StepCounters* counters)
{
    uint searches = 0;
    FeatureInput counting = input;
    counting.m_cloth.m_searches = &searches;
    runItem(item, items, [&] { runSweptTests(&counting, &sink, swept, UINT_MAX, counters); });
}
}  // namespace

extern const CpuSelfKernels DRAPE_SELF_KERNEL_SET;
extern const CpuKernels DRAPE_KERNEL_SET;
const CpuKernels DRAPE_KERNEL_SET = {
    DRAPE_INSTRUCTIONS, packFaces, packVertices,          packEdges, packVolumes, widen, cull,
    findContacts,       findSwept, &DRAPE_SELF_KERNEL_SET};
}  // namespace drape
