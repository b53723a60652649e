// Computes contacts of as many feature tests of one kind as there are lanes, on a CPU. The results have the same bits
// as those of node_face_contact.h, face_vertex_contact.h and edge_edge_contact.h.
//
// Exceptional lanes stay open, and the caller tests them one by one. Exceptions are thin faces, features that may
// meet, nodes that passed a face's plane, features that may be out of reach after all, touching or nearly parallel
// edges, and invalid positions. Not for continuous steps, which search every pair for a meeting.
#ifndef DRAPE_LIB_LANE_CONTACTS_H
#define DRAPE_LIB_LANE_CONTACTS_H

#include "feature_meeting.h"
#include "lanes.h"

// Input rows of a test, one lane each: positions (x y z) of the cloth's feature at the step's start and then at its
// end, and of the obstacle's feature. Its cone (except of faces) and the reach follow. All in metres, in the world's
// frame; starts are relative to the obstacle.
#define DRAPE_NODE_FACE_ROWS 16
#define DRAPE_FACE_VERTEX_ROWS 26
#define DRAPE_EDGE_EDGE_ROWS 23

// m_found: contacts. The caller must check those in m_asks against neighbours: a node nearest to an edge or corner
// against its cone, a vertex nearest to an edge against the face beyond. m_point: on the feature of two or three
// corners. m_offset: from the obstacle's closest point to the cloth's, m_distance long. Both are in the frame of the
// obstacle's first position.
typedef struct LaneContacts
{
    LaneMask m_open, m_found, m_asks;
    LanesVec3 m_normal, m_weights, m_point, m_offset;
    Lanes m_distance, m_gap0, m_gap1;
} LaneContacts;

// Lanes of PairBounds.
typedef struct LaneBounds
{
    Lanes m_extent, m_reach, m_reachSlack;
} LaneBounds;

// Access one lane's numbers in rows of lanes.
static void putNumber(float* rows, const uint row, const uint lane, const float number)
{
    rows[row * DRAPE_LANES + lane] = number;
}

static void putVec3(float* rows, const uint row, const uint lane, const Vec3 v)
{
    putNumber(rows, row, lane, v.x);
    putNumber(rows, row + 1, lane, v.y);
    putNumber(rows, row + 2, lane, v.z);
}
static Vec3 rowOf(const float* rows, const uint row, const uint lane)
{
    return vec3(rows[row * DRAPE_LANES + lane], rows[(row + 1) * DRAPE_LANES + lane], rows[(row + 2) * DRAPE_LANES + lane]);
}
static Vec3 vec3Of(const LanesVec3* lanes, const uint lane)
{
    return vec3(laneOf(&lanes->x, lane), laneOf(&lanes->y, lane), laneOf(&lanes->z, lane));
}

static LanesVec3 lanesZero(void)
{
    return lanesVec3(lanesSplat(0.0f), lanesSplat(0.0f), lanesSplat(0.0f));
}
static LanesVec3 laneRow(const float* rows, const int row)
{
    return lanesVec3(lanesLoad(rows, row), lanesLoad(rows, row + 1), lanesLoad(rows, row + 2));
}
static Lanes exactDot(const LanesVec3 a, const LanesVec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static LanesVec3 exactCross(const LanesVec3 a, const LanesVec3 b)
{
    return lanesVec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static Lanes exactLength(const LanesVec3 a)
{
    return sqrt(exactDot(a, a));
}
static LanesVec3 exactScale(const LanesVec3 a, const Lanes s)
{
    return lanesVec3(a.x * s, a.y * s, a.z * s);
}
static LanesVec3 exactAddScaled(const LanesVec3 a, const LanesVec3 b, const Lanes s)
{
    return lanesVec3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
static Lanes exactNormMax(const LanesVec3 a)
{
    return lanesMax(lanesMax(lanesAbs(a.x), lanesAbs(a.y)), lanesAbs(a.z));
}
static Lanes exactRatio(const Lanes numerator, const Lanes denominator)
{
    return lanesSelect(denominator > 0.0f, numerator / denominator, 0.0f);
}
static LanesVec3 lanesChoose(const LaneMask mask, const LanesVec3 yes, const LanesVec3 no)
{
    return lanesVec3(lanesSelect(mask, yes.x, no.x), lanesSelect(mask, yes.y, no.y), lanesSelect(mask, yes.z, no.z));
}

// Computes closestOnTriangle() on lanes. Later choices come first there.
static LanesVec3 laneClosest(const LanesVec3 p, const LanesVec3* corners)
{
    const LanesVec3 a = corners[0], b = corners[1], c = corners[2];
    const LanesVec3 ab = lanesSub(b, a), ac = lanesSub(c, a);
    const LanesVec3 ap = lanesSub(p, a), bp = lanesSub(p, b), cp = lanesSub(p, c);
    const Lanes d1 = exactDot(ab, ap), d2 = exactDot(ac, ap), d3 = exactDot(ab, bp), d4 = exactDot(ac, bp);
    const Lanes d5 = exactDot(ab, cp), d6 = exactDot(ac, cp);
    const Lanes vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    const Lanes zero = lanesSplat(0.0f), one = lanesSplat(1.0f);
    const Lanes v = exactRatio(vb, va + vb + vc), w = exactRatio(vc, va + vb + vc);
    LanesVec3 weights = lanesVec3(lanesMax(1.0f - v - w, zero), v, w);
    const Lanes onA = exactRatio(d4 - d3, (d4 - d3) + (d5 - d6));
    weights = lanesChoose((va <= 0.0f) & (d4 - d3 >= 0.0f) & (d5 - d6 >= 0.0f), lanesVec3(zero, 1.0f - onA, onA), weights);
    const Lanes onB = exactRatio(d2, d2 - d6);
    weights = lanesChoose((vb <= 0.0f) & (d2 >= 0.0f) & (d6 <= 0.0f), lanesVec3(1.0f - onB, zero, onB), weights);
    const Lanes onC = exactRatio(d1, d1 - d3);
    weights = lanesChoose((vc <= 0.0f) & (d1 >= 0.0f) & (d3 <= 0.0f), lanesVec3(1.0f - onC, onC, zero), weights);
    weights = lanesChoose((d6 >= 0.0f) & (d5 <= d6), lanesVec3(zero, zero, one), weights);
    weights = lanesChoose((d3 >= 0.0f) & (d4 <= d3), lanesVec3(zero, one, zero), weights);
    return lanesChoose((d1 <= 0.0f) & (d2 <= 0.0f), lanesVec3(one, zero, zero), weights);
}

// See trianglePoint().
static LanesVec3 lanePoint(const LanesVec3* corners, const LanesVec3 weights)
{
    const LanesVec3 a = corners[0], b = corners[1], c = corners[2];
    return lanesVec3(weights.x * a.x + weights.y * b.x + weights.z * c.x,
                     weights.x * a.y + weights.y * b.y + weights.z * c.y,
                     weights.x * a.z + weights.y * b.z + weights.z * c.z);
}

static LaneBounds laneBounds(const Lanes extent, const Lanes reach)
{
    LaneBounds bounds;
    bounds.m_extent = extent;
    bounds.m_reach = reach;
    bounds.m_reachSlack = reach * 1.001f + DRAPE_SEAM * extent;
    return bounds;
}

// See provenApart().
static LaneMask laneApart(const LanesVec3 n, const Lanes lowA, const Lanes highB, const LaneBounds* bounds)
{
    const float twelveUnits = 7.1525574e-7f;
    const Lanes gap = lowA - highB - twelveUnits * lanesNorm1(n) * bounds->m_extent - 1e-36f;
    return gap > bounds->m_reach * exactLength(n) * (1.0f + twelveUnits);
}

// See furtherApart().
static LaneMask laneFurther(const LanesVec3 n, const Lanes low, const Lanes high, const Lanes distance,
                            const LaneBounds* bounds)
{
    LaneBounds further = *bounds;
    further.m_reach = distance;
    return laneApart(n, low, high, &further);
}

// See meetingDistance().
static Lanes laneMeetingDistance(const Lanes motion, const LaneBounds* bounds)
{
    return motion * (1.0f + DRAPE_SEAM) + DRAPE_SEAM * bounds->m_extent;
}

// See volumeAdmitsMeeting().
static LaneMask laneAdmitsMeeting(const Lanes volume, const Lanes area, const Lanes distance, const LaneBounds* bounds)
{
    const Lanes extent = bounds->m_extent;
    return lanesAbs(volume) <= area * distance + 10.0f * DRAPE_SEAM * (extent * extent * extent);
}

typedef struct LaneBox
{
    LanesVec3 m_low, m_high;
} LaneBox;

static LaneBox laneBox(const LanesVec3 a, const LanesVec3 b)
{
    LaneBox box;
    box.m_low = lanesVec3(lanesMin(a.x, b.x), lanesMin(a.y, b.y), lanesMin(a.z, b.z));
    box.m_high = lanesVec3(lanesMax(a.x, b.x), lanesMax(a.y, b.y), lanesMax(a.z, b.z));
    return box;
}

static LaneBox laneJoined(const LaneBox a, const LaneBox b)
{
    LaneBox box;
    box.m_low = laneBox(a.m_low, b.m_low).m_low;
    box.m_high = laneBox(a.m_high, b.m_high).m_high;
    return box;
}

// See boxesApart().
static LaneMask laneBoxesApart(const LaneBox a, const LaneBox b, const LaneBounds* bounds)
{
    const Lanes slack = DRAPE_SEAM * bounds->m_extent;
    return (a.m_low.x - b.m_high.x > slack) | (b.m_low.x - a.m_high.x > slack) | (a.m_low.y - b.m_high.y > slack) |
           (b.m_low.y - a.m_high.y > slack) | (a.m_low.z - b.m_high.z > slack) | (b.m_low.z - a.m_high.z > slack);
}

// Area vector of a resting face, its length, and whether the face is thin; see faceArea().
typedef struct LaneArea
{
    LanesVec3 m_vector;
    Lanes m_length;
    LaneMask m_thin;
} LaneArea;

static LaneArea laneArea(const LanesVec3* corners)
{
    const LanesVec3 ab = lanesSub(corners[1], corners[0]), ac = lanesSub(corners[2], corners[0]);
    LaneArea area;
    area.m_vector = exactCross(ab, ac);
    const Lanes length = exactLength(area.m_vector);
    area.m_length = lanesSelect(length > 1e-18f, length, 0.0f);
    area.m_thin = lanesNot(area.m_length > DRAPE_THIN * (exactDot(ab, ab) + exactDot(ac, ac)));
    return area;
}

static Lanes laneExtent(const LanesVec3* corners)
{
    return lanesMax(lanesMax(exactNormMax(corners[0]), exactNormMax(corners[1])), exactNormMax(corners[2]));
}

// A moving face and a point that rests in the frame's origin. m_comesNear: faceNearness() is not DRAPE_STAY_APART. The
// other members are those at the step's end. m_after: the origin's distance from the face's plane times the length of
// the area vector. m_weights: of the face's closest point, m_point. m_low: the least product of that point and a
// corner.
typedef struct LaneFace
{
    LaneMask m_comesNear;
    LaneArea m_area;
    Lanes m_after, m_low;
    LanesVec3 m_weights, m_point;
    LaneBounds m_bounds;
} LaneFace;

static LaneFace laneFace(const LanesVec3* start, const LanesVec3* end, const Lanes reach, const uint mode)
{
    LaneFace face;
    face.m_area = laneArea(end);
    const Lanes extent = laneExtent(end);
    face.m_bounds = laneBounds(mode == DRAPE_DISCRETE ? extent : lanesMax(laneExtent(start), extent), reach);
    face.m_after = -exactDot(face.m_area.m_vector, end[0]);
    face.m_weights = laneClosest(lanesZero(), end);
    face.m_point = lanePoint(end, face.m_weights);
    face.m_low = lanesMin(lanesMin(exactDot(face.m_point, end[0]), exactDot(face.m_point, end[1])),
                          exactDot(face.m_point, end[2]));
    face.m_comesNear = lanesMaskSplat(0);
    if (mode == DRAPE_DISCRETE) return face;
    Lanes motion = lanesSplat(0.0f);
    LaneBox box = laneBox(start[0], end[0]);
    DRAPE_UNROLL
    for (int k = 0; k < 3; ++k)
    {
        motion = lanesMax(motion, exactLength(lanesSub(end[k], start[k])));
        box = laneJoined(box, laneBox(start[k], end[k]));
    }
    const Lanes distance = laneMeetingDistance(motion, &face.m_bounds);
    const LanesVec3 area = exactCross(lanesSub(start[1], start[0]), lanesSub(start[2], start[0]));
    face.m_comesNear = laneAdmitsMeeting(exactDot(area, start[0]), exactLength(area), distance, &face.m_bounds) &
                     laneAdmitsMeeting(face.m_after, face.m_area.m_length, distance, &face.m_bounds) &
                     lanesNot(laneBoxesApart(box, laneBox(lanesZero(), lanesZero()), &face.m_bounds)) &
                     lanesNot(laneFurther(face.m_point, face.m_low, lanesSplat(0.0f), distance, &face.m_bounds));
    return face;
}

// Returns the unit normal of the face's plane on the side given by `sign`.
static LanesVec3 lanePlane(const LaneArea* area, const Lanes sign)
{
    return exactScale(area->m_vector, sign * exactRatio(lanesSplat(1.0f), area->m_length));
}

// Returns lanes whose positions are all certainly valid.
static LaneMask laneValid(const float* rows, const int count)
{
    Lanes sum = lanesSplat(0.0f);
    for (int row = 0; row < count; ++row)
        sum += lanesAbs(lanesLoad(rows, row));
    return sum <= DRAPE_FARTHEST;
}

// Stores the contacts of lanes whose features are near at the step's end. direct: those whose normal is the offset's.
static void laneNear(LaneContacts* contacts, const LaneMask found, const LaneMask direct, const LanesVec3 plane,
                     const LanesVec3 startOffset, const LaneBounds* bounds)
{
    const LanesVec3 direction = exactScale(contacts->m_offset, 1.0f / contacts->m_distance);
    contacts->m_open |= direct & lanesNot(contacts->m_distance > 1e-18f);
    contacts->m_open |= found & (contacts->m_distance > bounds->m_reach - DRAPE_WAY_ROUNDING * bounds->m_extent);
    contacts->m_normal = lanesChoose(direct, direction, plane);
    contacts->m_gap0 = exactDot(contacts->m_normal, startOffset);
    contacts->m_gap1 = exactDot(contacts->m_normal, contacts->m_offset);
    contacts->m_found = found & lanesNot(contacts->m_open);
}

// See nodeFaceContact().
static void laneNodeFace(LaneContacts* contacts, const float* rows, const uint mode)
{
    const LanesVec3 a = laneRow(rows, 6);
    const LanesVec3 x0 = lanesSub(laneRow(rows, 0), a), x1 = lanesSub(laneRow(rows, 3), a);
    const LanesVec3 face[3] = {lanesZero(), lanesSub(laneRow(rows, 9), a), lanesSub(laneRow(rows, 12), a)};
    const LaneArea area = laneArea(face);
    const Lanes end = exactNormMax(x1);
    const Lanes extent =
        lanesMax(mode == DRAPE_DISCRETE ? end : lanesMax(exactNormMax(x0), end), laneExtent(face));
    const LaneBounds bounds = laneBounds(extent, lanesLoad(rows, 15));
    const Lanes s0 = exactDot(area.m_vector, x0), s1 = exactDot(area.m_vector, x1);
    const Lanes side = lanesSelect((mode == DRAPE_DISCRETE ? s1 : s0) < 0.0f, lanesSplat(-1.0f), lanesSplat(1.0f));
    const LaneMask passed = (area.m_length > 0.0f) & (side * s1 < 0.0f);
    contacts->m_open = area.m_thin | passed | lanesNot(laneValid(rows, 15));

    const LanesVec3 weights = laneClosest(x1, face);
    const LanesVec3 point = lanePoint(face, weights);
    contacts->m_point = point;
    contacts->m_offset = lanesSub(x1, point);
    contacts->m_distance = exactLength(contacts->m_offset);
    const Lanes high = lanesMax(lanesMax(exactDot(contacts->m_offset, face[0]), exactDot(contacts->m_offset, face[1])),
                                exactDot(contacts->m_offset, face[2]));
    const LaneMask apart = (lanesAbs(s1) > area.m_length * bounds.m_reachSlack) |
                           laneApart(contacts->m_offset, exactDot(contacts->m_offset, x1), high, &bounds);
    const LaneMask onFace = (weights.x > 0.0f) & (weights.y > 0.0f) & (weights.z > 0.0f);
    const LaneMask direct = (contacts->m_distance > DRAPE_SEAM * bounds.m_extent) & lanesNot(onFace);
    laneNear(contacts, lanesNot(apart) & (direct | lanesNot(area.m_length == 0.0f)), direct,
             lanePlane(&area, side), lanesSub(x0, point), &bounds);
    contacts->m_asks = direct;
    contacts->m_weights = weights;
}

// See faceVertexContact().
static void laneFaceVertex(LaneContacts* contacts, const float* rows, const uint mode)
{
    const LanesVec3 vertex = laneRow(rows, 18), axis = laneRow(rows, 21);
    const Lanes cosine = lanesLoad(rows, 24);
    LanesVec3 start[3], end[3];
    DRAPE_UNROLL
    for (int k = 0; k < 3; ++k)
    {
        start[k] = lanesSub(laneRow(rows, 3 * k), vertex);
        end[k] = lanesSub(laneRow(rows, 9 + 3 * k), vertex);
    }
    const LaneFace face = laneFace(start, end, lanesLoad(rows, 25), mode);
    contacts->m_open = face.m_area.m_thin | face.m_comesNear | lanesNot(laneValid(rows, 21));

    const LanesVec3 weights = face.m_weights;
    const LaneMask inside = (weights.x != 0.0f) & (weights.y != 0.0f) & (weights.z != 0.0f);
    const LaneMask corner = ((weights.x == 0.0f) & (weights.y == 0.0f)) | ((weights.y == 0.0f) & (weights.z == 0.0f)) |
                            ((weights.z == 0.0f) & (weights.x == 0.0f));
    contacts->m_point = contacts->m_offset = face.m_point;
    contacts->m_distance = exactLength(face.m_point);
    const LaneMask apart = (lanesAbs(face.m_after) > face.m_area.m_length * face.m_bounds.m_reachSlack) |
                           laneApart(face.m_point, face.m_low, lanesSplat(0.0f), &face.m_bounds);
    const LaneMask direct = lanesNot(inside) & (contacts->m_distance > DRAPE_SEAM * face.m_bounds.m_extent);
    const Lanes sign = lanesSelect(face.m_after < 0.0f, lanesSplat(1.0f), lanesSplat(-1.0f));
    laneNear(contacts, lanesNot(apart | corner) & (direct | lanesNot(face.m_area.m_length == 0.0f)), direct,
             lanePlane(&face.m_area, sign), lanePoint(start, weights), &face.m_bounds);
    const LaneMask admitted = lanesAbs(exactDot(axis, contacts->m_normal)) >= cosine;
    contacts->m_found &= admitted | lanesNot(inside | direct);
    contacts->m_asks = direct;
    contacts->m_weights = weights;
}

// Two edges at an instant: the ends of the first and the far end of the second, whose near one is the frame's origin.
typedef struct LaneEdges
{
    LanesVec3 m_a, m_b, m_far;
} LaneEdges;

static Lanes edgesExtent(const LaneEdges* edges)
{
    return lanesMax(lanesMax(exactNormMax(edges->m_a), exactNormMax(edges->m_b)), exactNormMax(edges->m_far));
}

// Parameters of the closest points along two edges; see closestOnSegments().
typedef struct LanePlaces
{
    Lanes m_s, m_t;
} LanePlaces;

static Lanes lanesClamp01(const Lanes a)
{
    return lanesMin(lanesMax(a, lanesSplat(0.0f)), lanesSplat(1.0f));
}

static LanePlaces lanePlaces(const LaneEdges* edges)
{
    const LanesVec3 u = lanesSub(edges->m_b, edges->m_a), v = edges->m_far, w = edges->m_a;
    const Lanes uu = exactDot(u, u), vv = exactDot(v, v), uv = exactDot(u, v), uw = exactDot(u, w), vw = exactDot(v, w);
    const Lanes determinant = uu * vv - uv * uv;
    const Lanes s =
        lanesClamp01(lanesSelect(vv > 0.0f, exactRatio(uv * vw - uw * vv, determinant), exactRatio(-uw, uu)));
    const Lanes t = exactRatio(uv * s + vw, vv), kept = lanesClamp01(t);
    const LaneMask beyond = (t < 0.0f) | (t > 1.0f);
    LanePlaces places;
    places.m_t = lanesSelect(beyond, kept, t);
    places.m_s = lanesSelect(beyond, lanesClamp01(exactRatio(uv * kept - uw, uu)), s);
    return places;
}

// Returns the offset from the second edge to the first.
static LanesVec3 laneOffset(const LaneEdges* edges, const LanePlaces places)
{
    return lanesSub(exactAddScaled(edges->m_a, lanesSub(edges->m_b, edges->m_a), places.m_s),
                    exactAddScaled(lanesZero(), edges->m_far, places.m_t));
}

// Two edges at the step's end: the volume that they span where they are closest, and the offset there. The offset has
// its least product with an end of the first edge and its greatest with one of the second. m_comesNear: as for a
// face.
typedef struct LaneCrossing
{
    LanesVec3 m_direction, m_offset;
    Lanes m_squared, m_volume, m_low, m_high;
    LanePlaces m_places;
    LaneMask m_parallel, m_comesNear;
    LaneBounds m_bounds;
} LaneCrossing;

static LaneCrossing laneCrossing(const LaneEdges* start, const LaneEdges* end, const Lanes reach, const uint mode)
{
    const LanesVec3 across = lanesSub(end->m_b, end->m_a), along = end->m_far;
    const Lanes extent = edgesExtent(end);
    LaneCrossing crossing;
    LaneBounds* bounds = &crossing.m_bounds;
    *bounds = laneBounds(mode == DRAPE_DISCRETE ? extent : lanesMax(edgesExtent(start), extent), reach);
    crossing.m_direction = exactCross(across, along);
    crossing.m_squared = exactDot(crossing.m_direction, crossing.m_direction);
    crossing.m_volume = -exactDot(crossing.m_direction, end->m_a);
    crossing.m_parallel =
        crossing.m_squared <= DRAPE_SEAM * DRAPE_SEAM * exactDot(across, across) * exactDot(along, along);
    crossing.m_places = lanePlaces(end);
    crossing.m_offset = laneOffset(end, crossing.m_places);
    crossing.m_low = lanesMin(exactDot(crossing.m_offset, end->m_a), exactDot(crossing.m_offset, end->m_b));
    crossing.m_high = lanesMax(lanesSplat(0.0f), exactDot(crossing.m_offset, along));
    crossing.m_comesNear = lanesMaskSplat(0);
    if (mode == DRAPE_DISCRETE) return crossing;
    const Lanes motion = lanesMax(exactLength(lanesSub(end->m_a, start->m_a)), exactLength(lanesSub(end->m_b, start->m_b))) +
                         exactLength(lanesSub(along, start->m_far));
    const Lanes distance = laneMeetingDistance(motion, bounds);
    const LanesVec3 direction = exactCross(lanesSub(start->m_b, start->m_a), start->m_far);
    const LaneBox box = laneJoined(laneBox(start->m_a, start->m_b), laneBox(end->m_a, end->m_b));
    const LaneBox other = laneJoined(laneBox(lanesZero(), start->m_far), laneBox(lanesZero(), along));
    crossing.m_comesNear = laneAdmitsMeeting(exactDot(direction, start->m_a), exactLength(direction), distance, bounds) &
                         laneAdmitsMeeting(crossing.m_volume, sqrt(crossing.m_squared), distance, bounds) &
                         lanesNot(laneBoxesApart(box, other, bounds)) &
                         lanesNot(laneFurther(crossing.m_offset, crossing.m_low, crossing.m_high, distance, bounds));
    return crossing;
}

// Computes contacts of edges that are not parallel and whose closest points lie inside both. m_open must be set before.
static void laneEdgesNear(LaneContacts* contacts, const LaneEdges* start, const LaneEdges* end,
                          const LaneCrossing* crossing, const LaneMask admitted)
{
    const LaneBounds* bounds = &crossing->m_bounds;
    const Lanes s = crossing->m_places.m_s, t = crossing->m_places.m_t;
    contacts->m_point = exactAddScaled(lanesZero(), end->m_far, t);
    contacts->m_offset = crossing->m_offset;
    contacts->m_distance = exactLength(contacts->m_offset);
    const LaneMask apart =
        (crossing->m_volume * crossing->m_volume > crossing->m_squared * (bounds->m_reachSlack * bounds->m_reachSlack)) |
        laneApart(contacts->m_offset, crossing->m_low, crossing->m_high, bounds);
    const LaneMask found = admitted & (s > 0.0f) & (s < 1.0f) & (t > 0.0f) & (t < 1.0f) & lanesNot(apart);
    contacts->m_open |= found & lanesNot(contacts->m_distance > DRAPE_SEAM * bounds->m_extent);
    laneNear(contacts, found, found, contacts->m_offset, laneOffset(start, crossing->m_places), bounds);
    contacts->m_asks = lanesMaskSplat(0);
}

// See edgeEdgeContact().
static void laneEdgeEdge(LaneContacts* contacts, const float* rows, const uint mode)
{
    const LanesVec3 origin = laneRow(rows, 12), axis = laneRow(rows, 18), far = lanesSub(laneRow(rows, 15), origin);
    const Lanes cosine = lanesLoad(rows, 21);
    const LaneEdges start = {lanesSub(laneRow(rows, 0), origin), lanesSub(laneRow(rows, 3), origin), far};
    const LaneEdges end = {lanesSub(laneRow(rows, 6), origin), lanesSub(laneRow(rows, 9), origin), far};
    const LaneCrossing crossing = laneCrossing(&start, &end, lanesLoad(rows, 22), mode);
    contacts->m_open = lanesNot(laneValid(rows, 18)) | crossing.m_parallel | crossing.m_comesNear;
    const Lanes facing = exactDot(axis, crossing.m_direction);
    const LaneMask admitted = lanesNot((cosine > 0.0f) & (facing * facing < cosine * cosine * crossing.m_squared));
    laneEdgesNear(contacts, &start, &end, &crossing, admitted);
    contacts->m_weights = lanesVec3(1.0f - crossing.m_places.m_s, crossing.m_places.m_s, lanesSplat(0.0f));
}

#endif
