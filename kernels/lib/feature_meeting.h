// Decides whether a cloth feature and an obstacle feature meet during the step.
//
// The certified search of ccd.h gives the answer. An automatic step runs it only where simpler tests leave a meeting
// possible, and a continuous step uses its answer only there, so that both give the same contacts. The simpler tests
// bound the distance at the step's start and end, and look for a plane that separates the features.
// docs/design_notes/contact_geometry.md explains them.
#ifndef DRAPE_LIB_FEATURE_MEETING_H
#define DRAPE_LIB_FEATURE_MEETING_H

#include "ccd.h"
#include "feature_contact.h"
#include "ways.h"

DRAPE_NAMESPACE_BEGIN

// Coarsest tolerance of the time of a meeting, as a fraction of the step.
#define DRAPE_MEETING_TIME 0.03125f

DRAPE_FUNCTION float distanceMoved(Vec3 from, Vec3 to)
{
    return vec3Length(vec3Sub(to, from));
}

DRAPE_FUNCTION float faceMotion(const MovingFace* face)
{
    const FeatureTriangle f0 = face->m_start, f1 = face->m_end;
    return drapeMax(drapeMax(distanceMoved(f0.m_p[0], f1.m_p[0]), distanceMoved(f0.m_p[1], f1.m_p[1])),
                    distanceMoved(f0.m_p[2], f1.m_p[2]));
}
DRAPE_FUNCTION float edgeMotion(FeatureEdge e0, FeatureEdge e1)
{
    return drapeMax(distanceMoved(e0.m_a, e1.m_a), distanceMoved(e0.m_b, e1.m_b));
}

// motion: m, of the fastest corner. The result is grown by a share of the pair's extent, far more than the search's
// tolerance and all rounding.
DRAPE_FUNCTION float meetingDistance(float motion, PairBounds bounds)
{
    return motion * (1.0f + DRAPE_SEAM) + DRAPE_SEAM * bounds.m_extent;
}

// volume: of the two features; area: that of the cloth's feature, or of both edges. The volume is made of three offsets
// of at most 2 √3 extents each and errs by less than 1.5e-5 cubed extents.
DRAPE_FUNCTION int volumeAdmitsMeeting(float volume, float area, float distance, PairBounds bounds)
{
    const float extent = bounds.m_extent;
    return drapeAbs(volume) <= area * distance + 10.0f * DRAPE_SEAM * (extent * extent * extent);
}

// Returns whether the plane with the given normal (any length) proves two features further apart; see provenApart().
DRAPE_FUNCTION int furtherApart(Vec3 n, float low, float high, float distance, PairBounds bounds)
{
    bounds.m_reach = distance;
    return provenApart(n, low, high, bounds);
}

// Result of the tests without a search: the features stay too far apart to meet; they come near, but one plane
// separates them from start to end; or they may meet.
#define DRAPE_STAY_APART 0
#define DRAPE_ARE_PARTED 1
#define DRAPE_MAY_MEET 2

// Classifies features that come near. n: normal of the plane; low: the least product of n with the first feature's
// corners at the step's start and end, high: the greatest with the second's. A point on one side at both ends stays
// there on a straight path.
DRAPE_FUNCTION int nearnessAcross(Vec3 n, float low, float high, PairBounds bounds)
{
    return furtherApart(n, low, high, 0.0f, bounds) ? DRAPE_ARE_PARTED : DRAPE_MAY_MEET;
}

// Returns whether the mode requires the search. known: see DRAPE_STAY_APART.
DRAPE_FUNCTION int asksForMeeting(int known, PairBounds bounds)
{
    return bounds.m_mode == DRAPE_CONTINUOUS || known == DRAPE_MAY_MEET;
}

// Returns the unit normal with the given direction on the side from which the cloth's point came. way: displacement
// of that point in the step, a straight line. If it runs along the surface, `side` decides: 1 for the direction
// itself.
DRAPE_FUNCTION Vec3 meetingNormal(Vec3 direction, float length, Vec3 way, float side, PairBounds bounds)
{
    const Vec3 normal = vec3Direction(direction, length);
    const float along = vec3Dot(normal, way);
    if (drapeAbs(along) > DRAPE_SEAM * bounds.m_extent) side = along < 0.0f ? 1.0f : -1.0f;
    return vec3Scale(normal, side);
}

// Classifies a moving face and a resting vertex; see DRAPE_STAY_APART. s0, s1: the volumes at the step's start and end.
DRAPE_FUNCTION int faceNearness(const MovingFace* face, Vec3 vertex, float s0, float s1, PairBounds bounds)
{
    const FeatureTriangle f0 = face->m_start, f1 = face->m_end;
    const float distance = meetingDistance(faceMotion(face), bounds);
    if (!volumeAdmitsMeeting(s0, vec3Length(face->m_areaStart), distance, bounds) ||
        !volumeAdmitsMeeting(s1, face->m_areaEnd.m_length, distance, bounds))
        return DRAPE_STAY_APART;
    const Vec3 least = vec3Least(vec3Least(vec3Least(f0.m_p[0], f0.m_p[1]), vec3Least(f0.m_p[2], f1.m_p[0])),
                                 vec3Least(f1.m_p[1], f1.m_p[2]));
    const Vec3 most = vec3Most(vec3Most(vec3Most(f0.m_p[0], f0.m_p[1]), vec3Most(f0.m_p[2], f1.m_p[0])),
                               vec3Most(f1.m_p[1], f1.m_p[2]));
    if (boxesApart(least, most, vertex, vertex, DRAPE_SEAM * bounds.m_extent)) return DRAPE_STAY_APART;
    const Vec3 weights = closestOnFace(vertex, f1, face->m_areaEnd.m_thin);
    const Vec3 offset = vec3Sub(featurePoint(f1, weights), vertex);
    const float low =
        drapeMin(drapeMin(vec3Dot(offset, f1.m_p[0]), vec3Dot(offset, f1.m_p[1])), vec3Dot(offset, f1.m_p[2]));
    const float high = vec3Dot(offset, vertex);
    if (furtherApart(offset, low, high, distance, bounds)) return DRAPE_STAY_APART;
    const float before =
        drapeMin(drapeMin(vec3Dot(offset, f0.m_p[0]), vec3Dot(offset, f0.m_p[1])), vec3Dot(offset, f0.m_p[2]));
    return nearnessAcross(offset, drapeMin(low, before), high, bounds);
}

// Classifies an edge that moves from e0 to e1 and another one from o0 to o1; see DRAPE_STAY_APART. motion: m, of the
// fastest ends, added up. v0, v1: the volumes at the step's start and end.
DRAPE_FUNCTION int edgesNearness(FeatureEdge e0, FeatureEdge e1, FeatureEdge o0, FeatureEdge o1, float motion, float v0,
                                 float v1, PairBounds bounds)
{
    const float distance = meetingDistance(motion, bounds);
    const float area0 = vec3Length(vec3Cross(vec3Sub(e0.m_b, e0.m_a), vec3Sub(o0.m_b, o0.m_a)));
    const float area1 = vec3Length(vec3Cross(vec3Sub(e1.m_b, e1.m_a), vec3Sub(o1.m_b, o1.m_a)));
    if (!volumeAdmitsMeeting(v0, area0, distance, bounds) || !volumeAdmitsMeeting(v1, area1, distance, bounds))
        return DRAPE_STAY_APART;
    const Vec3 least = vec3Least(vec3Least(e0.m_a, e0.m_b), vec3Least(e1.m_a, e1.m_b));
    const Vec3 most = vec3Most(vec3Most(e0.m_a, e0.m_b), vec3Most(e1.m_a, e1.m_b));
    const Vec3 leastOther = vec3Least(vec3Least(o0.m_a, o0.m_b), vec3Least(o1.m_a, o1.m_b));
    const Vec3 mostOther = vec3Most(vec3Most(o0.m_a, o0.m_b), vec3Most(o1.m_a, o1.m_b));
    if (boxesApart(least, most, leastOther, mostOther, DRAPE_SEAM * bounds.m_extent)) return DRAPE_STAY_APART;
    float s, t;
    closestOnSegments(e1.m_a, e1.m_b, o1.m_a, o1.m_b, &s, &t);
    const Vec3 offset = vec3Sub(vec3Mix(e1.m_a, e1.m_b, s), vec3Mix(o1.m_a, o1.m_b, t));
    const float low = drapeMin(vec3Dot(offset, e1.m_a), vec3Dot(offset, e1.m_b));
    const float high = drapeMax(vec3Dot(offset, o1.m_a), vec3Dot(offset, o1.m_b));
    if (furtherApart(offset, low, high, distance, bounds)) return DRAPE_STAY_APART;
    const float lowBefore = drapeMin(vec3Dot(offset, e0.m_a), vec3Dot(offset, e0.m_b));
    const float highBefore = drapeMax(vec3Dot(offset, o0.m_a), vec3Dot(offset, o0.m_b));
    return nearnessAcross(offset, drapeMin(low, lowBefore), drapeMax(high, highBefore), bounds);
}

// Computes the nearness of a moving and a resting edge.
DRAPE_FUNCTION int edgeNearness(FeatureEdge e0, FeatureEdge e1, FeatureEdge o, float v0, float v1, PairBounds bounds)
{
    return edgesNearness(e0, e1, o, o, edgeMotion(e0, e1), v0, v1, bounds);
}

// Returns settings of the search for a time, which costs three times that for a meeting at the defaults of ccd.h. A
// contact needs its position to a hundredth of the reach, so slow features need the time less exactly.
DRAPE_FUNCTION CcdSettings meetingSettings(float motion, PairBounds bounds)
{
    CcdSettings settings = ccdDefaults();
    const float wanted = 0.01f * drapeRatio(bounds.m_reach, motion);
    settings.m_timeTolerance = drapeMax(settings.m_timeTolerance, drapeMin(wanted, DRAPE_MEETING_TIME));
    return settings;
}

typedef struct Meeting
{
    int m_met;
    float m_time;   // time in the step, never late
    float m_place;  // time in the step at which to test the features: as near as a few iterations come
} Meeting;

DRAPE_FUNCTION Meeting meetFeatures(DRAPE_UINT kind, const Vec3 start[4], const Vec3 end[4], float motion,
                                    PairBounds bounds)
{
    const CcdSettings settings = meetingSettings(motion, bounds);
    const CcdVectors vectors = ccdVectors(kind, start, end);
    const CcdResult result = ccdRun(&vectors, kind == DRAPE_VERTEX_FACE, settings);
    Meeting meeting;
    meeting.m_met =
        result.m_hit && waysOverlap(start, end, kind == DRAPE_VERTEX_FACE ? 1 : 2, DRAPE_WAY_REACH * bounds.m_reach);
    meeting.m_time = meeting.m_place = result.m_time;
    if (meeting.m_met)
    {
        const float latest = drapeMin(1.0f, result.m_time + 2.0f * settings.m_timeTolerance);
        const float middle = result.m_time + 0.5f * (latest - result.m_time);
        meeting.m_place = coplanarTime(&vectors, result.m_time, latest, middle);
    }
    return meeting;
}

DRAPE_FUNCTION Meeting meetFace(const MovingFace* face, Vec3 vertex, PairBounds bounds)
{
    const Vec3 start[4] = {vertex, face->m_start.m_p[0], face->m_start.m_p[1], face->m_start.m_p[2]};
    const Vec3 end[4] = {vertex, face->m_end.m_p[0], face->m_end.m_p[1], face->m_end.m_p[2]};
    return meetFeatures(DRAPE_VERTEX_FACE, start, end, faceMotion(face), bounds);
}

DRAPE_FUNCTION Meeting meetEdge(FeatureEdge e0, FeatureEdge e1, FeatureEdge o, PairBounds bounds)
{
    const Vec3 start[4] = {e0.m_a, e0.m_b, o.m_a, o.m_b};
    const Vec3 end[4] = {e1.m_a, e1.m_b, o.m_a, o.m_b};
    return meetFeatures(DRAPE_EDGES, start, end, edgeMotion(e0, e1), bounds);
}

DRAPE_NAMESPACE_END

#endif
