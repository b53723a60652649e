// Poses of obstacles and their motion in a step. 32-bit scalars only, no padding.
#ifndef DRAPE_SHARED_MOTION_H
#define DRAPE_SHARED_MOTION_H

#include "types.h"

DRAPE_NAMESPACE_BEGIN

// Maps are three rows of three factors and a shift.
#define DRAPE_MAP_FLOATS 12

// One obstacle's pose in the world, per slot.
typedef struct ObstaclePlace
{
    float m_pose[DRAPE_MAP_FLOATS];  // from the mesh's own frame to the world
    DRAPE_UINT m_posed;              // 0: the positions are the world's already
    DRAPE_UINT m_firstVertex;        // over all obstacles
    DRAPE_UINT m_firstEdge;
} ObstaclePlace;

// An obstacle that moves in the step. Lists of such obstacles are in the order of slots.
typedef struct ObstacleMotion
{
    float m_map[DRAPE_MAP_FLOATS];  // pose at the step's end after the inverse of the one at its start
    float m_low[3], m_high[3];      // m, the obstacle's box at the step's end
    DRAPE_UINT m_mesh;              // slot
} ObstacleMotion;

DRAPE_NAMESPACE_END

#endif
