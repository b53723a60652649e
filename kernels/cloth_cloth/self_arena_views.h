// Views of the data of cloths that collide with themselves, in a device's arenas. For devices only.
#ifndef DRAPE_SELF_ARENA_VIEWS_H
#define DRAPE_SELF_ARENA_VIEWS_H

#include "../lib/cloth_cloth/self_views.h"
#include "../lib/step_data/arena_views.h"
#include "cloth_cloth_bindings.h"

static SelfPatches selfPatchesAt(__global PatchWord* arena, const SelfPatchLayout* layout)
{
    SelfPatches patches;
    patches.m_patches = (__global const Patch*)(arena + layout->m_patches);
    patches.m_patchCount = layout->m_patchCount;
    patches.m_entries = layout->m_entries;
    patches.m_faceIds = (__global const uint*)(arena + layout->m_faceIds);
    patches.m_vertexIds = (__global const uint*)(arena + layout->m_vertexIds);
    patches.m_edgeIds = (__global const uint*)(arena + layout->m_edgeIds);
    patches.m_faceNodes = (__global const uint*)(arena + layout->m_faceNodes);
    patches.m_edgeNodes = (__global const uint*)(arena + layout->m_edgeNodes);
    patches.m_levels = (__global const uint*)(arena + layout->m_levels);
    patches.m_levelCount = layout->m_levelCount;
    patches.m_faceBoxes = (__global float*)(arena + layout->m_faceBoxes);
    patches.m_vertexBoxes = (__global float*)(arena + layout->m_vertexBoxes);
    patches.m_edgeBoxes = (__global float*)(arena + layout->m_edgeBoxes);
    patches.m_wideNodes = (__global float*)(arena + layout->m_wideNodes);
    patches.m_smooth.m_first = 0;
    return patches;
}

// Views an arena that the kernel does not write.
static SelfPatches selfPatchesIn(__global const PatchWord* arena, const SelfPatchLayout* layout)
{
    return selfPatchesAt((__global PatchWord*)arena, layout);
}

static SelfInput selfInput(const SelfFeatureValues* values, __global const FeatureTest* tests,
                           __global const StepCounters* counters, __global const float* nodes,
                           __global const float* rest, __global const ClothWord* cloths, uint* searches)
{
    SelfInput input;
    input.m_tests = tests;
    input.m_count = min(counters->m_selfTests, values->m_testCapacity);
    input.m_view =
        selfView(clothAt(nodes, cloths, &values->m_cloth, values->m_mode, searches), rest, values->m_reachScale);
    input.m_firstFeature = values->m_firstFeature;
    return input;
}

#endif
