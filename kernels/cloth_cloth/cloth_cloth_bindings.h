// Arguments of the kernels of cloths with themselves (shared/bindings.h).
//
// nodes, cloths, patches: see shared/arenas.h; rest: m, x y z per node. radius, thickness, obstacleRadius: see
// SelfRadii. pairs: of patches, listed by selfWalk. tests, list: self tests (lib/cloth_cloth/self_contact.h). contacts,
// ranks, featureCounts: see ContactSink. swept: tests that the continuous test decides.
#ifndef DRAPE_CLOTH_CLOTH_BINDINGS_H
#define DRAPE_CLOTH_CLOTH_BINDINGS_H

#include "../shared/arenas.h"
#include "../shared/bindings.h"
#include "../shared/contact.h"
#include "../shared/patch.h"

DRAPE_NAMESPACE_BEGIN

typedef struct SelfCullValues
{
    ClothLayout m_cloth;
    SelfPatchLayout m_patches;
    DRAPE_UINT m_mode;               // DRAPE_DISCRETE …
    DRAPE_UINT m_pairCapacity;       // pairs of patches, on a GPU
    DRAPE_UINT m_capacity, m_limit;  // self tests
} SelfCullValues;

typedef struct SelfFeatureValues
{
    ClothLayout m_cloth;
    DRAPE_UINT m_testCapacity;
    DRAPE_UINT m_firstFeature;  // see featureCountOf()
    DRAPE_UINT m_mode;
    float m_reachScale;
    DRAPE_UINT m_contactCapacity;
    DRAPE_UINT m_sums;  // see contactSink()
} SelfFeatureValues;

DRAPE_NAMESPACE_END

#define DRAPE_SELF_PACK                                                                                    \
    DRAPE_VALUE(SelfCullValues, values), DRAPE_READS(float, nodes), DRAPE_READS(ClothWord, cloths),        \
        DRAPE_READS(float, radius), DRAPE_READS(float, obstacleRadius), DRAPE_UPDATES(PatchWord, patches), \
        DRAPE_UPDATES(StepCounters, counters)
#define DRAPE_SELF_CULL                                                                               \
    DRAPE_VALUE(SelfCullValues, values), DRAPE_READS(float, nodes), DRAPE_READS(ClothWord, cloths),   \
        DRAPE_READS(float, radius), DRAPE_READS(float, thickness), DRAPE_UPDATES(PatchWord, patches), \
        DRAPE_WRITES(FeatureTest, list), DRAPE_UPDATES(StepCounters, counters)
#define DRAPE_SELF_WALK                                                                               \
    DRAPE_VALUE(SelfCullValues, values), DRAPE_READS(float, radius), DRAPE_READS(PatchWord, patches), \
        DRAPE_WRITES(Candidate, list), DRAPE_UPDATES(StepCounters, counters)
#define DRAPE_SELF_CULL_PAIRS                                                                      \
    DRAPE_VALUE(SelfCullValues, values), DRAPE_READS(Candidate, pairs), DRAPE_READS(float, nodes), \
        DRAPE_READS(ClothWord, cloths), DRAPE_READS(float, radius), DRAPE_READS(float, thickness), \
        DRAPE_READS(PatchWord, patches), DRAPE_WRITES(FeatureTest, list), DRAPE_UPDATES(StepCounters, counters)
#define DRAPE_SELF_TESTS                                                                                \
    DRAPE_VALUE(SelfFeatureValues, values), DRAPE_READS(FeatureTest, tests), DRAPE_READS(float, nodes), \
        DRAPE_READS(float, rest), DRAPE_READS(ClothWord, cloths), DRAPE_WRITES(Contact, contacts),      \
        DRAPE_WRITES(DRAPE_UINT, ranks), DRAPE_UPDATES(DRAPE_UINT, featureCounts),                      \
        DRAPE_UPDATES(StepCounters, counters)
#define DRAPE_SELF_FEATURE DRAPE_SELF_TESTS, DRAPE_WRITES(DRAPE_UINT, swept)
#define DRAPE_SELF_SWEPT DRAPE_SELF_TESTS, DRAPE_READS(DRAPE_UINT, swept)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(selfPack, DRAPE_SELF_PACK)
DRAPE_BIND(selfCull, DRAPE_SELF_CULL)
DRAPE_BIND(selfWalk, DRAPE_SELF_WALK)
DRAPE_BIND(selfCullPairs, DRAPE_SELF_CULL_PAIRS)
DRAPE_BIND(selfFeature, DRAPE_SELF_FEATURE)
DRAPE_BIND(selfSwept, DRAPE_SELF_SWEPT)
}  // namespace drape::kernels
#endif

#endif
