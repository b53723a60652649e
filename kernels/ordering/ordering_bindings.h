// Arguments of the ordering's kernels (shared/bindings.h). Features are the cloths'.
//
// unsorted, ranks, featureCounts: see ContactSink. firsts: first position of each feature's contacts in canonical
// order. members, keys: see orderingGather. counters, next: of this step and of the next one.
#ifndef DRAPE_ORDERING_BINDINGS_H
#define DRAPE_ORDERING_BINDINGS_H

#include "../shared/bindings.h"
#include "../shared/contact.h"
#include "../shared/mesh.h"

DRAPE_NAMESPACE_BEGIN

typedef struct OrderingValues
{
    DRAPE_UINT m_capacity;  // unsorted contacts
    DRAPE_UINT m_features;
    DRAPE_UINT m_ranked;  // maximum contacts of a feature that need no launch of their own
    DRAPE_UINT m_sums;    // position of the sums behind the features' numbers; 0 without sums
    DRAPE_UINT m_block;   // features of a group, or sums of a block
    DRAPE_UINT m_parts;   // work-items that copy a contact
} OrderingValues;

DRAPE_NAMESPACE_END

#define DRAPE_ORDERING_COUNT                                                     \
    DRAPE_VALUE(OrderingValues, values), DRAPE_READS(DRAPE_UINT, featureCounts), \
        DRAPE_WRITES(DRAPE_UINT, blockCounts), DRAPE_LOCAL(DRAPE_UINT, scratch)
#define DRAPE_ORDERING_PLACE                                                                                    \
    DRAPE_VALUE(OrderingValues, values), DRAPE_READS(DRAPE_UINT, featureCounts), DRAPE_READS(DRAPE_UINT, sums), \
        DRAPE_WRITES(DRAPE_UINT, firsts), DRAPE_UPDATES(StepCounters, counters), DRAPE_LOCAL(DRAPE_UINT, scratch)
#define DRAPE_ORDERING_GATHER                                                                                      \
    DRAPE_VALUE(OrderingValues, values), DRAPE_READS(Contact, unsorted), DRAPE_UPDATES(DRAPE_UINT, featureCounts), \
        DRAPE_READS(DRAPE_UINT, firsts), DRAPE_WRITES(DRAPE_UINT, members), DRAPE_WRITES(DRAPE_UINT, keys),        \
        DRAPE_READS(StepCounters, counters), DRAPE_WRITES(StepCounters, next)
#define DRAPE_ORDERING_GATHER_SMALL                                                                                  \
    DRAPE_VALUE(OrderingValues, values), DRAPE_READS(Contact, unsorted), DRAPE_READS(DRAPE_UINT, ranks),             \
        DRAPE_READS(DRAPE_UINT, featureCounts), DRAPE_WRITES(DRAPE_UINT, firsts), DRAPE_WRITES(DRAPE_UINT, members), \
        DRAPE_WRITES(DRAPE_UINT, keys), DRAPE_UPDATES(StepCounters, counters), DRAPE_WRITES(StepCounters, next)
#define DRAPE_ORDERING_SORT                                                                                   \
    DRAPE_VALUE(OrderingValues, values), DRAPE_READS(DRAPE_UINT, firsts), DRAPE_UPDATES(DRAPE_UINT, members), \
        DRAPE_UPDATES(DRAPE_UINT, keys), DRAPE_READS(StepCounters, counters)
#define DRAPE_ORDERING_WRITE                                                                              \
    DRAPE_VALUE(OrderingValues, values), DRAPE_READS(Contact, unsorted), DRAPE_READS(DRAPE_UINT, firsts), \
        DRAPE_READS(DRAPE_UINT, members), DRAPE_READS(DRAPE_UINT, keys), DRAPE_WRITES(Contact, contacts), \
        DRAPE_READS(StepCounters, counters), DRAPE_WRITES(DRAPE_UINT, featureCounts)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(orderingCount, DRAPE_ORDERING_COUNT)
DRAPE_BIND(orderingPlace, DRAPE_ORDERING_PLACE)
DRAPE_BIND(orderingGather, DRAPE_ORDERING_GATHER)
DRAPE_BIND(orderingGatherSmall, DRAPE_ORDERING_GATHER_SMALL)
DRAPE_BIND(orderingSort, DRAPE_ORDERING_SORT)
DRAPE_BIND(orderingWrite, DRAPE_ORDERING_WRITE)
}  // namespace drape::kernels
#endif

#endif
