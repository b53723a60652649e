// Arguments of the kernels that split a level's nodes (kernels/shared/bindings.h). order, other: triangles, and room
// for as many. queue: open nodes; children: node i of the queue opens 2 i and 2 i + 1. sums, scratch, hulls: see
// groupSplit(); scratch also holds a list of nodesPerGroup nodes.
#ifndef DRAPE_TOP_DOWN_BINDINGS_H
#define DRAPE_TOP_DOWN_BINDINGS_H

#include "../../kernels/shared/bindings.h"
#include "lib/top_down.h"

DRAPE_NAMESPACE_BEGIN

typedef struct SplitValues
{
    SplitRule m_rule;
    DRAPE_UINT m_count;          // nodes in the queue
    DRAPE_UINT m_nodesPerGroup;  // nodes that a work-group takes
    DRAPE_UINT m_smallSize;      // nodes of at most so many triangles are split by one work-item
    DRAPE_UINT m_largeSize;      // nodes of so many triangles are split by other kernels
} SplitValues;

DRAPE_NAMESPACE_END

#define DRAPE_TOP_DOWN_SPLIT_ITEMS                                                                        \
    DRAPE_VALUE(SplitValues, values), DRAPE_UPDATES(BvhNode, nodes), DRAPE_UPDATES(DRAPE_UINT, splits),   \
        DRAPE_UPDATES(DRAPE_UINT, order), DRAPE_UPDATES(DRAPE_UINT, other), DRAPE_READS(Vec3, centroids), \
        DRAPE_READS(Dop, volumes), DRAPE_READS(OpenNode, queue), DRAPE_UPDATES(OpenNode, children)
#define DRAPE_TOP_DOWN_SPLIT_GROUPS                                                               \
    DRAPE_TOP_DOWN_SPLIT_ITEMS, DRAPE_LOCAL(DRAPE_ULONG, sums), DRAPE_LOCAL(DRAPE_UINT, scratch), \
        DRAPE_LOCAL(float, hulls)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(topDownSplitItems, DRAPE_TOP_DOWN_SPLIT_ITEMS)
DRAPE_BIND(topDownSplitGroups, DRAPE_TOP_DOWN_SPLIT_GROUPS)
}  // namespace drape::kernels
#endif

#endif
