// Arguments of the broad phase's kernels (shared/bindings.h).
//
// nodes, cloths, patches: see shared/arenas.h. radius, thickness, motions: see StepCloths. pairs: of cloth triangles
// and patches, listed by patchWalk. list: of feature tests, or of pairs; see TestList.
#ifndef DRAPE_BROAD_PHASE_BINDINGS_H
#define DRAPE_BROAD_PHASE_BINDINGS_H

#include "../shared/arenas.h"
#include "../shared/bindings.h"
#include "../shared/motion.h"
#include "../shared/patch.h"

DRAPE_NAMESPACE_BEGIN

typedef struct CullValues
{
    ClothLayout m_cloth;
    PatchLayout m_patches;
    DRAPE_UINT m_obstacleMeshes;
    float m_reachScale;
    DRAPE_UINT m_mode;  // DRAPE_DISCRETE …
    DRAPE_UINT m_motionCount;
    DRAPE_UINT m_capacity, m_limit;          // feature tests
    DRAPE_UINT m_pairCapacity, m_pairLimit;  // pairs of cloth triangles and patches, on a GPU
    DRAPE_UINT m_packet;                     // cloth triangles for which a group of a GPU traverses
} CullValues;

DRAPE_NAMESPACE_END

#define DRAPE_PATCH_CULL                                                                                 \
    DRAPE_VALUE(CullValues, values), DRAPE_READS(float, nodes), DRAPE_READS(ClothWord, cloths),          \
        DRAPE_READS(float, radius), DRAPE_READS(float, thickness), DRAPE_READS(ObstacleMotion, motions), \
        DRAPE_READS(PatchWord, patches), DRAPE_WRITES(FeatureTest, list), DRAPE_WRITES(StepCounters, counters)
#define DRAPE_PATCH_WALK DRAPE_PATCH_CULL
#define DRAPE_PATCH_CULL_PAIRS                                                                                 \
    DRAPE_VALUE(CullValues, values), DRAPE_READS(FeatureTest, pairs), DRAPE_READS(float, nodes),               \
        DRAPE_READS(ClothWord, cloths), DRAPE_READS(ObstacleMotion, motions), DRAPE_READS(PatchWord, patches), \
        DRAPE_WRITES(FeatureTest, list), DRAPE_WRITES(StepCounters, counters)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(patchCull, DRAPE_PATCH_CULL)
DRAPE_BIND(patchWalk, DRAPE_PATCH_WALK)
DRAPE_BIND(patchCullPairs, DRAPE_PATCH_CULL_PAIRS)
}  // namespace drape::kernels
#endif

#endif
