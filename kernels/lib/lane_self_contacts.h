// Computes the contacts of self_contact.h for as many tests of one kind as there are lanes, on a CPU, like
// lane_contacts.h for obstacles. Lanes with a node against a face that is thin at rest also stay open.
#ifndef DRAPE_LIB_LANE_SELF_CONTACTS_H
#define DRAPE_LIB_LANE_SELF_CONTACTS_H

#include "lane_contacts.h"
#include "self_contact.h"

// Input rows of a test, one lane each: positions (x y z, m) of the node or the first edge, then of the face or the
// second edge. They stand at the step's start, then at its end, then at rest. The cloth's thickness, m, follows.
#define DRAPE_SELF_POSITIONS 4
#define DRAPE_SELF_ROWS (3 * 3 * DRAPE_SELF_POSITIONS + 1)

// Computes the positions of one instant relative to the k-th position, which is zero itself.
static void laneFrame(LanesVec3* frame, const float* rows, const int instant, const int k)
{
    const LanesVec3 origin = laneRow(rows, 3 * (DRAPE_SELF_POSITIONS * instant + k));
    DRAPE_UNROLL
    for (int i = 0; i < DRAPE_SELF_POSITIONS; ++i)
        frame[i] = lanesSub(laneRow(rows, 3 * (DRAPE_SELF_POSITIONS * instant + i)), origin);
}

static Lanes laneSelfThickness(const float* rows, const Lanes restDistance)
{
    return lanesMin(lanesLoad(rows, DRAPE_SELF_ROWS - 1), DRAPE_REST_SHARE * restDistance);
}

// Computes selfNodeFace() on lanes. m_asks: contacts on the face's boundary, to which a face beyond may be nearer.
static void laneSelfNodeFace(LaneContacts* contacts, const float* rows, const uint mode, const float reachScale)
{
    LanesVec3 start[4], end[4], rest[4];  // the node, which is the frame's origin, and the face
    laneFrame(start, rows, 0, 0);
    laneFrame(end, rows, 1, 0);
    laneFrame(rest, rows, 2, 0);
    const Lanes own = laneSelfThickness(rows, exactLength(lanePoint(rest + 1, laneClosest(lanesZero(), rest + 1))));
    const LaneFace face = laneFace(start + 1, end + 1, own * reachScale, mode);
    contacts->m_open = face.m_area.m_thin | face.m_comesNear | laneArea(rest + 1).m_thin |
                       lanesNot(laneValid(rows, DRAPE_SELF_ROWS - 1));

    const LanesVec3 weights = face.m_weights;
    contacts->m_point = face.m_point;
    contacts->m_offset = exactScale(face.m_point, lanesSplat(-1.0f));
    contacts->m_distance = exactLength(face.m_point);
    const LaneMask apart = (lanesAbs(face.m_after) > face.m_area.m_length * face.m_bounds.m_reachSlack) |
                           laneApart(contacts->m_offset, lanesSplat(0.0f), -face.m_low, &face.m_bounds);
    const LaneMask found = (own > 0.0f) & lanesNot(apart);
    contacts->m_open |= found & lanesNot(contacts->m_distance > DRAPE_SEAM * face.m_bounds.m_extent);
    const LaneMask boundary = lanesNot((weights.x > 0.0f) & (weights.y > 0.0f) & (weights.z > 0.0f));
    const Lanes sign = lanesSelect(face.m_after < 0.0f, lanesSplat(-1.0f), lanesSplat(1.0f));
    laneNear(contacts, found, boundary, lanePlane(&face.m_area, sign),
             exactScale(lanePoint(start + 1, weights), lanesSplat(-1.0f)), &face.m_bounds);
    contacts->m_asks = boundary;
    contacts->m_weights = weights;
}

// Computes selfEdgeEdge() on lanes. Parallel edges are no contact here.
static void laneSelfEdgeEdge(LaneContacts* contacts, const float* rows, const uint mode, const float reachScale)
{
    LanesVec3 p[4], rest[4];
    laneFrame(p, rows, 0, 2);
    const LaneEdges start = {p[0], p[1], p[3]};
    laneFrame(p, rows, 1, 2);
    const LaneEdges end = {p[0], p[1], p[3]};
    laneFrame(rest, rows, 2, 2);
    const LaneEdges atRest = {rest[0], rest[1], rest[3]};
    const Lanes own = laneSelfThickness(rows, exactLength(laneOffset(&atRest, lanePlaces(&atRest))));
    const LaneCrossing crossing = laneCrossing(&start, &end, own * reachScale, mode);
    contacts->m_open = crossing.m_comesNear | lanesNot(laneValid(rows, DRAPE_SELF_ROWS - 1));
    laneEdgesNear(contacts, &start, &end, &crossing, (own > 0.0f) & lanesNot(crossing.m_parallel));
    contacts->m_weights = lanesVec3(crossing.m_places.m_s, crossing.m_places.m_t, lanesSplat(0.0f));
}

#endif
