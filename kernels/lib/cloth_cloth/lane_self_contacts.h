// Computes the contacts of self_contact.h for as many tests of one kind as there are lanes, on a CPU, like
// lane_contacts.h for obstacles. Lanes with a node against a face that is thin at rest also stay open.
#ifndef DRAPE_LIB_LANE_SELF_CONTACTS_H
#define DRAPE_LIB_LANE_SELF_CONTACTS_H

#include "../narrow_phase/lane_contacts.h"
#include "self_contact.h"

DRAPE_NAMESPACE_BEGIN

#include "../any_width/lanes.h"
#include "../any_width/self_pair.h"
#include "../any_width/end.h"

// Input rows of a test, one lane each: positions (x y z, m) of the node and the face, or of the first edge and the
// second. They stand at the step's start, then at its end, then at rest. The cloth's thickness, m, follows.
#define DRAPE_SELF_POSITIONS 4
#define DRAPE_SELF_ROWS (3 * 3 * DRAPE_SELF_POSITIONS + 1)

// Loads the positions of one instant.
DRAPE_FUNCTION void laneInstant(LanesVec3* positions, const float* rows, int instant)
{
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_SELF_POSITIONS; ++i)
        positions[i] = laneRow(rows, 3 * (DRAPE_SELF_POSITIONS * instant + i));
}

// See selfNodeFace().
DRAPE_FUNCTION void laneSelfNodeFace(LaneContacts* contacts, const float* rows, DRAPE_UINT mode, float reachScale)
{
    LanesVec3 start[4], end[4], rest[4];
    laneInstant(start, rows, 0);
    laneInstant(end, rows, 1);
    laneInstant(rest, rows, 2);
    const LanesTriangle atRest = {{vec3Sub(rest[1], rest[0]), vec3Sub(rest[2], rest[0]), vec3Sub(rest[3], rest[0])}};
    LaneMask thin;
    const Lanes own = selfThickness(lanesLoad(rows, DRAPE_SELF_ROWS - 1), distanceToFace(atRest, &thin));
    const LanesMovingFace face = movingFace(start + 1, end + 1, start[0], end[0], own * reachScale, mode, 0);
    const LanesNearest nearest = nearestOfFace(&face);
    const LaneMask found = (own > 0.0f) & selfNodeNear(&face, &nearest, &contacts->m_near);
    decideLanes(contacts, found, thin | face.m_areaEnd.m_thin | lanesMayMeet(&face, &nearest), face.m_bounds, rows,
                DRAPE_SELF_ROWS - 1);
}

// See selfEdgeEdge().
DRAPE_FUNCTION void laneSelfEdgeEdge(LaneContacts* contacts, const float* rows, DRAPE_UINT mode, float reachScale)
{
    LanesVec3 start[4], end[4], rest[4];
    laneInstant(start, rows, 0);
    laneInstant(end, rows, 1);
    laneInstant(rest, rows, 2);
    const Lanes own = selfThickness(lanesLoad(rows, DRAPE_SELF_ROWS - 1), distanceOfEdges(edgesFrom(rest)));
    const LanesEdgePair pair = edgePair(start, end, own * reachScale, mode, 0);
    const LaneMask found = (own > 0.0f) & selfEdgesNear(&pair, &contacts->m_near);
    decideLanes(contacts, found, lanesOfEdgesMayMeet(&pair), pair.m_bounds, rows, DRAPE_SELF_ROWS - 1);
}

DRAPE_NAMESPACE_END

#endif
