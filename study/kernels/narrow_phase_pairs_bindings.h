// Arguments of narrowPhaseTest (kernels/shared/bindings.h). candidates, found: pairs of triangles that a traversal
// listed, and its counters. thickness: m, cloths × obstacles. contacts, places, featureCounts: see ContactSink.
#ifndef DRAPE_NARROW_PHASE_PAIRS_BINDINGS_H
#define DRAPE_NARROW_PHASE_PAIRS_BINDINGS_H

#include "../../kernels/shared/arenas.h"
#include "../../kernels/shared/bindings.h"
#include "../../kernels/shared/contact.h"
#include "shared/traversal.h"

DRAPE_NAMESPACE_BEGIN

typedef struct PairValues
{
    ClothLayout m_cloth;
    ObstacleLayout m_obstacle;
    DRAPE_UINT m_candidateCapacity;
    DRAPE_UINT m_obstacleMeshes;
    float m_reachScale;
    DRAPE_UINT m_mode;  // DRAPE_DISCRETE …
    DRAPE_UINT m_contactCapacity;
    DRAPE_UINT m_sums;  // see contactSink()
} PairValues;

DRAPE_NAMESPACE_END

#define DRAPE_NARROW_PHASE_TEST                                                                                 \
    DRAPE_VALUE(PairValues, values), DRAPE_READS(Candidate, candidates), DRAPE_READS(TraversalCounters, found), \
        DRAPE_READS(float, start), DRAPE_READS(float, end), DRAPE_READS(ClothWord, cloths),                     \
        DRAPE_READS(ObstacleWord, obstacles), DRAPE_READS(float, thickness), DRAPE_WRITES(Contact, contacts),   \
        DRAPE_WRITES(DRAPE_UINT, places), DRAPE_UPDATES(DRAPE_UINT, featureCounts),                             \
        DRAPE_UPDATES(StepCounters, counters)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(narrowPhaseTest, DRAPE_NARROW_PHASE_TEST)
}  // namespace drape::kernels
#endif

#endif
