// Arguments of the narrow phase's kernels (shared/bindings.h).
//
// tests: listed by the cull; nodes, cloths, obstacles, patches: see shared/arenas.h; motions: of the obstacles that
// move in the step. contacts, ranks, featureCounts: see ContactSink. swept: tests that the continuous test decides.
#ifndef DRAPE_NARROW_PHASE_BINDINGS_H
#define DRAPE_NARROW_PHASE_BINDINGS_H

#include "../shared/arenas.h"
#include "../shared/bindings.h"
#include "../shared/contact.h"
#include "../shared/motion.h"
#include "../shared/patch.h"

DRAPE_NAMESPACE_BEGIN

typedef struct FeatureValues
{
    ClothLayout m_cloth;
    ObstacleLayout m_obstacle;
    PatchLayout m_patches;
    DRAPE_UINT m_testCapacity;
    DRAPE_UINT m_mode;  // DRAPE_DISCRETE …
    DRAPE_UINT m_most;  // tests; the launch does nothing if there are more
    DRAPE_UINT m_contactCapacity;
    DRAPE_UINT m_sums;  // see contactSink()
} FeatureValues;

DRAPE_NAMESPACE_END

#define DRAPE_NARROW_PHASE_SMALL                                                                                \
    DRAPE_VALUE(FeatureValues, values), DRAPE_READS(FeatureTest, tests), DRAPE_READS(float, nodes),             \
        DRAPE_READS(ClothWord, cloths), DRAPE_READS(ObstacleWord, obstacles), DRAPE_READS(PatchWord, patches),  \
        DRAPE_READS(ObstacleMotion, motions), DRAPE_WRITES(Contact, contacts), DRAPE_WRITES(DRAPE_UINT, ranks), \
        DRAPE_UPDATES(DRAPE_UINT, featureCounts), DRAPE_UPDATES(StepCounters, counters)
#define DRAPE_NARROW_PHASE_FEATURE DRAPE_NARROW_PHASE_SMALL, DRAPE_WRITES(DRAPE_UINT, swept)
#define DRAPE_NARROW_PHASE_SWEPT DRAPE_NARROW_PHASE_SMALL, DRAPE_READS(DRAPE_UINT, swept)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(narrowPhaseFeature, DRAPE_NARROW_PHASE_FEATURE)
DRAPE_BIND(narrowPhaseSwept, DRAPE_NARROW_PHASE_SWEPT)
DRAPE_BIND(narrowPhaseSmall, DRAPE_NARROW_PHASE_SMALL)
}  // namespace drape::kernels
#endif

#endif
