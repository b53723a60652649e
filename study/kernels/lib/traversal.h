// Functions that the traversals of two hierarchies share: which node of a pair opens, and the tests of volumes.
#ifndef DRAPE_LIB_TRAVERSAL_H
#define DRAPE_LIB_TRAVERSAL_H

#include "../shared/traversal.h"
#include "../../../kernels/lib/geometry/dop.h"

DRAPE_NAMESPACE_BEGIN

// Returns whether the cloth's node of an overlapping pair that is not two leaves opens: the one nearer to its root, so
// that both sides shrink together. Unlike opensFirst() it does not look at volumes: so every pair has one parent,
// whatever moves.
DRAPE_FUNCTION int clothOpens(const DRAPE_GLOBAL BvhNode* cloth, const DRAPE_GLOBAL BvhNode* obstacle,
                              DRAPE_UINT clothDepth, DRAPE_UINT obstacleDepth)
{
    if (cloth->m_count == 0) return 0;
    return obstacle->m_count == 0 || clothDepth <= obstacleDepth;
}

// Returns the pair from which clothOpens() led to this one. Opening the shallower side keeps the cloth's depth at the
// obstacle's or one more. Below a leaf the other side is the deeper one. So the deeper side opened last, and at equal
// depth the obstacle.
DRAPE_FUNCTION NodePair parentPair(NodePair pair, const DRAPE_GLOBAL BvhLink* clothLinks,
                                   const DRAPE_GLOBAL BvhLink* obstacleLinks)
{
    const BvhLink cloth = clothLinks[pair.m_cloth];
    const BvhLink obstacle = obstacleLinks[pair.m_obstacle];
    NodePair parent = pair;
    if (cloth.m_depth > obstacle.m_depth)
    {
        parent.m_cloth = cloth.m_parent;
    }
    else
    {
        parent.m_obstacle = obstacle.m_parent;
    }
    return parent;
}

// Returns whether a pair is its parent's first child: of the pairs below a pair, exactly one is reached by first
// children only.
DRAPE_FUNCTION int isFirstChild(NodePair pair, NodePair parent, const DRAPE_GLOBAL BvhNode* cloths,
                                const DRAPE_GLOBAL BvhNode* obstacles)
{
    if (parent.m_cloth != pair.m_cloth) return cloths[parent.m_cloth].m_first == pair.m_cloth;
    return obstacles[parent.m_obstacle].m_first == pair.m_obstacle;
}

DRAPE_NAMESPACE_END

#endif
