// Computes contacts of as many feature tests of one kind as there are lanes, on a CPU, by the texts of any_width/. The
// results have the same bits as those of the texts for one pair.
//
// Exceptional lanes stay open, and the caller tests them one by one. Exceptions are thin faces, features that may meet
// or that touch, nodes that passed a face's plane, features at the edge of the reach, parallel edges, and invalid
// positions. Not for continuous steps, which search every pair for a meeting.
#ifndef DRAPE_LIB_LANE_CONTACTS_H
#define DRAPE_LIB_LANE_CONTACTS_H

#include "../work_items/lanes.h"
#include "feature_meeting.h"
#include "node_face_contact.h"

DRAPE_NAMESPACE_BEGIN

// The words of the texts that differ on lanes. Lanes for which these lack something stay open; see decideLanes().
DRAPE_FUNCTION Lanes drapeAbs(Lanes a)
{
    return lanesAbs(a);
}
DRAPE_FUNCTION LanesVec3 lanesSelectVec3(LaneMask mask, LanesVec3 yes, LanesVec3 no)
{
    return lanesVec3(lanesSelect(mask, yes.x, no.x), lanesSelect(mask, yes.y, no.y), lanesSelect(mask, yes.z, no.z));
}

typedef struct LanesCone
{
    LanesVec3 m_axis;
    Lanes m_cosine;
} LanesCone;

#include "../any_width/lanes.h"
#include "../any_width/vec3.h"
#include "../any_width/closest.h"
#include "../any_width/face.h"
#include "../any_width/bounds.h"

DRAPE_FUNCTION LanesVec3 vec3Direction(LanesVec3 a, Lanes length)
{
    return vec3Scale(a, 1.0f / length);
}
DRAPE_FUNCTION LanesArea faceArea(LanesTriangle f)
{
    return plainArea(f);
}
DRAPE_FUNCTION LanesVec3 closestOnFace(LanesVec3 p, LanesTriangle f, LaneMask thin)
{
    (void)thin;
    return closestOnTriangle(p, f.m_p[0], f.m_p[1], f.m_p[2]);
}
DRAPE_FUNCTION LaneMask pointIsOutOfReach(Lanes distance, LanesVec3 point, LanesTriangle face, LanesBounds bounds)
{
    (void)distance, (void)point, (void)face, (void)bounds;
    return lanesMaskSplat(0);
}
DRAPE_FUNCTION LaneMask edgesAreOutOfReach(Lanes distance, LanesVec3 a, LanesVec3 b, LanesVec3 far, LanesBounds bounds)
{
    (void)distance, (void)a, (void)b, (void)far, (void)bounds;
    return lanesMaskSplat(0);
}

#include "../any_width/node_face.h"
#include "../any_width/moving_face.h"
#include "../any_width/edges.h"
#include "../any_width/end.h"

// Input rows of a test, one lane each: positions (x y z) of the cloth's feature at the step's start and then at its
// end, and of the obstacle's feature. Its cone (except of faces) and the reach follow. All in metres, in the world's
// frame; starts are relative to the obstacle.
#define DRAPE_NODE_FACE_ROWS 16
#define DRAPE_FACE_VERTEX_ROWS 26
#define DRAPE_EDGE_EDGE_ROWS 23

// m_found: lanes with a contact. m_open: lanes that are left to the caller.
typedef struct LaneContacts
{
    LaneMask m_open, m_found;
    LanesNear m_near;
} LaneContacts;

// Access one lane's numbers in rows of lanes.
DRAPE_FUNCTION void putNumber(float* rows, DRAPE_UINT row, DRAPE_UINT lane, float number)
{
    rows[row * DRAPE_LANES + lane] = number;
}
DRAPE_FUNCTION void putVec3(float* rows, DRAPE_UINT row, DRAPE_UINT lane, Vec3 v)
{
    putNumber(rows, row, lane, v.x);
    putNumber(rows, row + 1, lane, v.y);
    putNumber(rows, row + 2, lane, v.z);
}
DRAPE_FUNCTION Vec3 rowOf(const float* rows, DRAPE_UINT row, DRAPE_UINT lane)
{
    const float* first = rows + row * DRAPE_LANES + lane;
    return vec3(first[0], first[DRAPE_LANES], first[2 * DRAPE_LANES]);
}
DRAPE_FUNCTION LanesVec3 laneRow(const float* rows, int row)
{
    return lanesVec3(lanesLoad(rows, row), lanesLoad(rows, row + 1), lanesLoad(rows, row + 2));
}
DRAPE_FUNCTION LanesCone laneCones(const float* rows, int row)
{
    const LanesCone cones = {laneRow(rows, row), lanesLoad(rows, row + 3)};
    return cones;
}
DRAPE_FUNCTION Vec3 vec3Of(const LanesVec3* lanes, DRAPE_UINT lane)
{
    return vec3(laneOf(&lanes->x, lane), laneOf(&lanes->y, lane), laneOf(&lanes->z, lane));
}

// Returns one lane's contact. asks: its m_asks.
DRAPE_FUNCTION NearContact nearOfLane(const LanesNear* lanes, DRAPE_UINT lane, int asks)
{
    NearContact near;
    near.m_normal = vec3Of(&lanes->m_normal, lane);
    near.m_weights = vec3Of(&lanes->m_weights, lane);
    near.m_point = vec3Of(&lanes->m_point, lane);
    near.m_distance = laneOf(&lanes->m_distance, lane);
    near.m_seam = laneOf(&lanes->m_seam, lane);
    near.m_gap0 = laneOf(&lanes->m_gap0, lane);
    near.m_gap1 = laneOf(&lanes->m_gap1, lane);
    near.m_asks = asks;
    return near;
}

// Stores which lanes have a contact and which stay open. `open` are the lanes whose exception does not depend on the
// contact. count: rows of positions. Leaves lanes open where positions may be invalid, and found ones where the
// features touch, are at the edge of the reach, or have a distance too small to divide by.
DRAPE_FUNCTION void decideLanes(LaneContacts* contacts, LaneMask found, LaneMask open, LanesBounds bounds,
                                const float* rows, int count)
{
    const Lanes distance = contacts->m_near.m_distance;
    Lanes sum = lanesSplat(0.0f);
    for (int row = 0; row < count; ++row)
        sum += lanesAbs(lanesLoad(rows, row));
    const LaneMask plain = (distance > 1e-18f) & (distance > DRAPE_SEAM * bounds.m_extent) &
                           lanesNot(distance > bounds.m_reach - DRAPE_PATH_ROUNDING * bounds.m_extent);
    contacts->m_open = open | lanesNot(sum <= DRAPE_FARTHEST) | (found & lanesNot(plain));
    contacts->m_found = found & lanesNot(contacts->m_open);
}

// Returns lanes whose face may meet the point in the origin.
DRAPE_FUNCTION LaneMask lanesMayMeet(const LanesMovingFace* face, const LanesNearest* nearest)
{
    if (face->m_bounds.m_mode == DRAPE_DISCRETE) return lanesMaskSplat(0);
    return faceComesNear(face, nearest);
}
// Returns lanes whose edges may meet.
DRAPE_FUNCTION LaneMask lanesOfEdgesMayMeet(const LanesEdgePair* pair)
{
    return pair->m_bounds.m_mode == DRAPE_DISCRETE ? lanesMaskSplat(0) : edgesComeNear(pair);
}

// See nodeFaceContact().
DRAPE_FUNCTION void laneNodeFace(LaneContacts* contacts, const float* rows, DRAPE_UINT mode)
{
    const LanesNodeFace pair = nodeFace(laneRow(rows, 0), laneRow(rows, 3), laneRow(rows, 6), laneRow(rows, 9),
                                        laneRow(rows, 12), lanesLoad(rows, DRAPE_NODE_FACE_ROWS - 1), mode, 0);
    const LaneMask found = lanesNot(nodeIsFarFromPlane(&pair)) & nodeNearFace(&pair, pair.m_side, &contacts->m_near);
    decideLanes(contacts, found, pair.m_area.m_thin | pair.m_passed, pair.m_bounds, rows, 15);
}

// See faceVertexContact().
DRAPE_FUNCTION void laneFaceVertex(LaneContacts* contacts, const float* rows, DRAPE_UINT mode)
{
    const LanesVec3 start[3] = {laneRow(rows, 0), laneRow(rows, 3), laneRow(rows, 6)};
    const LanesVec3 end[3] = {laneRow(rows, 9), laneRow(rows, 12), laneRow(rows, 15)}, vertex = laneRow(rows, 18);
    const LanesMovingFace face =
        movingFace(start, end, vertex, vertex, lanesLoad(rows, DRAPE_FACE_VERTEX_ROWS - 1), mode, 0);
    const LanesNearest nearest = nearestOfFace(&face);
    const LaneMask found = faceNearVertex(&face, &nearest, laneCones(rows, 21), &contacts->m_near);
    decideLanes(contacts, found, face.m_areaEnd.m_thin | lanesMayMeet(&face, &nearest), face.m_bounds, rows, 21);
}

// See edgeEdgeContact().
DRAPE_FUNCTION void laneEdgeEdge(LaneContacts* contacts, const float* rows, DRAPE_UINT mode)
{
    const LanesVec3 start[4] = {laneRow(rows, 0), laneRow(rows, 3), laneRow(rows, 12), laneRow(rows, 15)};
    const LanesVec3 end[4] = {laneRow(rows, 6), laneRow(rows, 9), start[2], start[3]};
    const LanesEdgePair pair = edgePair(start, end, lanesLoad(rows, DRAPE_EDGE_EDGE_ROWS - 1), mode, 0);
    const LaneMask found = edgesNearWithin(&pair, laneCones(rows, 18), &contacts->m_near);
    decideLanes(contacts, found, pair.m_parallel | lanesOfEdgesMayMeet(&pair), pair.m_bounds, rows, 18);
}

DRAPE_NAMESPACE_END

#endif
