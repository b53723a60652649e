// Views of the arrays in a device's arenas (shared/arenas.h). For devices only.
#ifndef DRAPE_LIB_ARENA_VIEWS_H
#define DRAPE_LIB_ARENA_VIEWS_H

#include "../../shared/arenas.h"
#include "step_views.h"

static ClothView clothAt(__global const float* nodes, __global const ClothWord* cloths, const ClothLayout* layout,
                         const uint mode, uint* searches)
{
    return clothView(nodes, nodes + layout->m_end, (__global const Triangle*)(cloths + layout->m_triangles),
                     (__global const Edge*)(cloths + layout->m_edges), layout->m_nodeCount, layout->m_triangleCount,
                     mode, searches);
}

static ObstacleView obstacleAt(__global const ObstacleWord* obstacles, const ObstacleLayout* layout)
{
    return obstacleView((__global const float*)(obstacles + layout->m_positions),
                        (__global const Triangle*)(obstacles + layout->m_triangles),
                        (__global const NormalCone*)(obstacles + layout->m_vertexCones),
                        (__global const NormalCone*)(obstacles + layout->m_edgeCones));
}

static PackedPatches patchesAt(__global const PatchWord* arena, const PatchLayout* layout)
{
    PackedPatches patches;
    patches.m_patches = (__global const Patch*)(arena + layout->m_patches);
    patches.m_levels = (__global const uint*)(arena + layout->m_levels);
    patches.m_levelCount = layout->m_levelCount;
    patches.m_wideNodes = (__global const float*)(arena + layout->m_wideNodes);
    patches.m_sizes = (__global const float*)(arena + layout->m_sizes);
    patches.m_volumes = (__global const float*)(arena + layout->m_volumes);
    patches.m_faces = (__global const float*)(arena + layout->m_faces);
    patches.m_vertices = (__global const float*)(arena + layout->m_vertices);
    patches.m_edges = (__global const float*)(arena + layout->m_edges);
    patches.m_faceIds = (__global const uint*)(arena + layout->m_faceIds);
    patches.m_vertexIds = (__global const uint*)(arena + layout->m_vertexIds);
    patches.m_edgeIds = (__global const uint*)(arena + layout->m_edgeIds);
    patches.m_faceFeatures = (__global const uint*)(arena + layout->m_faceFeatures);
    return patches;
}

#endif
