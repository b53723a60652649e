// Arguments of the traversals' kernels (kernels/shared/bindings.h).
//
// Nodes, orders and triangles: of either side's hierarchy. thickness: m, cloths × obstacles; see meshesPaired().
// candidates: pairs of triangles; counters: demands count on past a list's capacity.
#ifndef DRAPE_TRAVERSAL_BINDINGS_H
#define DRAPE_TRAVERSAL_BINDINGS_H

#include "../../kernels/shared/bindings.h"
#include "lib/grid.h"
#include "shared/traversal.h"

DRAPE_NAMESPACE_BEGIN

// The list of candidates, and what limits it.
typedef struct ListValues
{
    DRAPE_UINT m_obstacleMeshes;
    DRAPE_UINT m_capacity, m_limit;
} ListValues;

typedef struct FrontValues
{
    ListValues m_list;
    DRAPE_UINT m_obstacleLinks;  // position of the obstacles' links behind the cloths'
    DRAPE_UINT m_obstacleOrder;  // position of the obstacles' order behind the cloths'
    DRAPE_UINT m_oldCount;       // pairs of the old front
    DRAPE_UINT m_keep;           // write the new front
    DRAPE_UINT m_raise;          // pairs of the old front that came apart climb
    DRAPE_UINT m_floorDepth;     // sum of depths above which no pair climbs
    DRAPE_UINT m_frontCapacity;
} FrontValues;

typedef struct SingleValues
{
    ListValues m_list;
    DRAPE_UINT m_clothRoot, m_obstacleRoot;
    DRAPE_UINT m_spillCapacity;
} SingleValues;

typedef struct GridValues
{
    ListValues m_list;
    GridFrame m_frame;
    DRAPE_UINT m_leafCount;      // leaves of the side whose leaves are work-items
    DRAPE_UINT m_entryCapacity;  // capacity of keys and places
} GridValues;

DRAPE_NAMESPACE_END

#define DRAPE_BROAD_PHASE_FRONT                                                                                   \
    DRAPE_VALUE(FrontValues, values), DRAPE_READS(BvhNode, clothNodes), DRAPE_READS(BvhNode, obstacleNodes),      \
        DRAPE_READS(BvhLink, links), DRAPE_READS(DRAPE_UINT, orders), DRAPE_READS(Triangle, clothTriangles),      \
        DRAPE_READS(Triangle, obstacleTriangles), DRAPE_READS(float, thickness), DRAPE_READS(NodePair, oldFront), \
        DRAPE_WRITES(NodePair, newFront), DRAPE_WRITES(Candidate, candidates),                                    \
        DRAPE_WRITES(TraversalCounters, counters)
#define DRAPE_BROAD_PHASE_SINGLE                                                                                       \
    DRAPE_VALUE(SingleValues, values), DRAPE_READS(BvhNode, clothNodes), DRAPE_READS(DRAPE_UINT, clothOrder),          \
        DRAPE_READS(Triangle, clothTriangles), DRAPE_READS(BvhNode, obstacleNodes),                                    \
        DRAPE_READS(DRAPE_UINT, obstacleOrder), DRAPE_READS(Triangle, obstacleTriangles),                              \
        DRAPE_READS(float, thickness), DRAPE_WRITES(Candidate, candidates), DRAPE_WRITES(TraversalCounters, counters), \
        DRAPE_UPDATES(NodePair, spill)
#define DRAPE_GRID_ENTRIES                                                                        \
    DRAPE_VALUE(GridValues, values), DRAPE_READS(BvhNode, nodes), DRAPE_WRITES(DRAPE_UINT, keys), \
        DRAPE_WRITES(DRAPE_UINT, places), DRAPE_WRITES(TraversalCounters, counters)
#define DRAPE_GRID_STARTS \
    DRAPE_VALUE(DRAPE_UINT, count), DRAPE_READS(DRAPE_UINT, keys), DRAPE_WRITES(DRAPE_UINT, starts)
#define DRAPE_GRID_PAIRS                                                                                    \
    DRAPE_VALUE(GridValues, values), DRAPE_READS(BvhNode, clothNodes), DRAPE_READS(DRAPE_UINT, clothOrder), \
        DRAPE_READS(Triangle, clothTriangles), DRAPE_READS(BvhNode, obstacleNodes),                         \
        DRAPE_READS(DRAPE_UINT, obstacleOrder), DRAPE_READS(Triangle, obstacleTriangles),                   \
        DRAPE_READS(DRAPE_UINT, starts), DRAPE_READS(DRAPE_UINT, places), DRAPE_READS(float, thickness),    \
        DRAPE_WRITES(Candidate, candidates), DRAPE_WRITES(TraversalCounters, counters)

#ifndef __OPENCL_VERSION__
namespace drape::kernels
{
DRAPE_BIND(broadPhaseFront, DRAPE_BROAD_PHASE_FRONT)
DRAPE_BIND(broadPhaseSingle, DRAPE_BROAD_PHASE_SINGLE)
DRAPE_BIND(gridEntries, DRAPE_GRID_ENTRIES)
DRAPE_BIND(gridStarts, DRAPE_GRID_STARTS)
DRAPE_BIND(gridPairs, DRAPE_GRID_PAIRS)
}  // namespace drape::kernels
#endif

#endif
