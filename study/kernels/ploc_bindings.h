// Arguments of plocMerge (kernels/shared/bindings.h). boxes, numbers: the round's clusters; nearest: of each; rounds:
// clusters and merges of each round; blockCounts: see plocCount. clusters, sizes: of all rounds.
#ifndef DRAPE_PLOC_BINDINGS_H
#define DRAPE_PLOC_BINDINGS_H

#include "../../kernels/shared/bindings.h"
#include "lib/ploc.h"

DRAPE_NAMESPACE_BEGIN

typedef struct MergeValues
{
    DRAPE_UINT m_round;
    DRAPE_UINT m_share;  // clusters of a work-item
    DRAPE_UINT m_leafCount;
} MergeValues;

DRAPE_NAMESPACE_END

#define DRAPE_PLOC_MERGE                                                                                          \
    DRAPE_VALUE(MergeValues, values), DRAPE_READS(Box, boxes), DRAPE_READS(DRAPE_UINT, numbers),                  \
        DRAPE_READS(DRAPE_UINT, nearest), DRAPE_WRITES(DRAPE_UINT, rounds), DRAPE_READS(DRAPE_UINT, blockCounts), \
        DRAPE_WRITES(Box, boxesOut), DRAPE_WRITES(DRAPE_UINT, numbersOut), DRAPE_WRITES(Cluster, clusters),       \
        DRAPE_WRITES(DRAPE_UINT, sizes), DRAPE_LOCAL(DRAPE_UINT, scratch)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(plocMerge, DRAPE_PLOC_MERGE)
}  // namespace drape::kernels
#endif

#endif
