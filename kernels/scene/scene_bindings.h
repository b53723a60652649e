// Arguments of the kernels that place and pack the obstacles (shared/bindings.h).
//
// obstacles, patches: see shared/arenas.h. own, world: the obstacles in their own frames and in the world. owners: of
// the lanes of vertex or edge blocks (shared/patch.h).
#ifndef DRAPE_SCENE_BINDINGS_H
#define DRAPE_SCENE_BINDINGS_H

#include "../shared/arenas.h"
#include "../shared/bindings.h"
#include "../shared/motion.h"

DRAPE_NAMESPACE_BEGIN

// A launch packs the lanes, or the child positions of the wide tree's lowest level, from m_first up to m_last.
typedef struct PackValues
{
    ObstacleLayout m_obstacle;
    PatchLayout m_patches;
    DRAPE_UINT m_first, m_last;
    DRAPE_UINT m_count;  // patches
} PackValues;

// Joins volumes of m_count nodes from m_below on into child positions of the level that begins at m_level.
typedef struct WidenValues
{
    DRAPE_UINT m_wideNodes;  // position in the arena
    DRAPE_UINT m_below;
    DRAPE_UINT m_count;
    DRAPE_UINT m_level;
    DRAPE_UINT m_first, m_last;
} WidenValues;

typedef struct PlaceValues
{
    ObstacleLayout m_own, m_world;
    DRAPE_UINT m_placeCount;
    DRAPE_UINT m_firstVertex, m_vertexCount;
    DRAPE_UINT m_firstEdge, m_edgeCount;
} PlaceValues;

DRAPE_NAMESPACE_END

#define DRAPE_PATCH_PACK_FACES \
    DRAPE_VALUE(PackValues, values), DRAPE_READS(ObstacleWord, obstacles), DRAPE_UPDATES(PatchWord, patches)
#define DRAPE_PATCH_PACK_OWNED                                                                              \
    DRAPE_VALUE(PackValues, values), DRAPE_READS(DRAPE_UINT, owners), DRAPE_READS(ObstacleWord, obstacles), \
        DRAPE_UPDATES(PatchWord, patches)
#define DRAPE_PATCH_WIDEN DRAPE_VALUE(WidenValues, values), DRAPE_UPDATES(PatchWord, patches)
#define DRAPE_PLACE_OBSTACLES                                                                             \
    DRAPE_VALUE(PlaceValues, values), DRAPE_READS(ObstaclePlace, places), DRAPE_READS(ObstacleWord, own), \
        DRAPE_WRITES(ObstacleWord, world)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(patchPackFaces, DRAPE_PATCH_PACK_FACES)
DRAPE_BIND(patchPackVertices, DRAPE_PATCH_PACK_OWNED)
DRAPE_BIND(patchPackEdges, DRAPE_PATCH_PACK_OWNED)
DRAPE_BIND(patchVolumes, DRAPE_PATCH_PACK_FACES)
DRAPE_BIND(patchWiden, DRAPE_PATCH_WIDEN)
DRAPE_BIND(placeObstacles, DRAPE_PLACE_OBSTACLES)
}  // namespace drape::kernels
#endif

#endif
