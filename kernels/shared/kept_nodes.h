// Nodes of cloths that stay on a device between steps (core/solver/device/kept_nodes.h). SI units.
#ifndef DRAPE_SHARED_KEPT_NODES_H
#define DRAPE_SHARED_KEPT_NODES_H

#include "types.h"

DRAPE_NAMESPACE_BEGIN

// A node between two steps. The fourth numbers make it three vectors of four.
typedef struct KeptNode
{
    Vec3 m_position;      // m
    float m_inverseMass;  // 1/kg, 0 for a pinned node
    Vec3 m_velocity;      // m/s
    float m_unused;
    Vec3 m_support;  // m/s², see nodeSupport()
    float m_unusedToo;
} KeptNode;

// A kept cloth in a step, and what its prediction needs. Nodes are in the caller's order.
typedef struct KeptCloth
{
    DRAPE_UINT m_count;      // nodes
    DRAPE_UINT m_before;     // index of the first node at the step's start
    DRAPE_UINT m_after;      // index at its end
    DRAPE_UINT m_start;      // floats, of the first node's start among the detection's nodes; DRAPE_NOT_DETECTED: none
    DRAPE_UINT m_end;        // floats, of its end
    DRAPE_UINT m_solved;     // index among the solver's nodes
    Vec3 m_gravity;          // m/s, what gravity adds to a velocity in the step
    float m_time;            // s, the step's time
    float m_perSecond;       // 1/s, its inverse as Bullet has it
    float m_shift;           // s², of the acceleration: see SubstepBody::afterPrediction()
    float m_supportShift;    // s², the same of a node's support
    float m_mostOffPath;     // m, from its path's end, beyond which a node may have passed a surface
    float m_leastThickness;  // m, of its pairs
} KeptCloth;
#define DRAPE_NOT_DETECTED 0xffffffffu

// A launch over kept cloths: their number, and the work-items of each.
typedef struct KeptLaunch
{
    DRAPE_UINT m_cloths, m_lanes;
} KeptLaunch;

// Bounds of a kept cloth's next step, as keys that rise with their numbers (orderedBits()): of the nodes' positions, of
// their ends by Bullet's prediction, and of their ends by that of substeps.
#define DRAPE_KEPT_BOXES 3u
typedef struct KeptBounds
{
    DRAPE_UINT m_low[3 * DRAPE_KEPT_BOXES], m_high[3 * DRAPE_KEPT_BOXES];
    DRAPE_UINT m_isInvalid;  // true if a number is not finite
    DRAPE_UINT m_isOffPath;  // true if a node left its path by more than KeptCloth::m_mostOffPath
} KeptBounds;

// Returns a key that rises with the number.
DRAPE_FUNCTION DRAPE_UINT orderedBits(DRAPE_UINT bits)
{
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
// Returns the bits of a key's number.
DRAPE_FUNCTION DRAPE_UINT numberBits(DRAPE_UINT key)
{
    return (key & 0x80000000u) != 0u ? key & 0x7fffffffu : ~key;
}

DRAPE_NAMESPACE_END

#endif
