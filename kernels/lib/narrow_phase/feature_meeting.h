// Decides whether a cloth feature and an obstacle feature meet during the step.
//
// The certified search of ccd.h gives the answer. An automatic step runs it only where simpler tests leave a meeting
// possible, and a continuous step uses its answer only there, so that both give the same contacts. The simpler tests
// bound the distance at the step's start and end, and look for a plane that separates the features.
// docs/design_notes/contact_geometry.md explains them.
#ifndef DRAPE_LIB_FEATURE_MEETING_H
#define DRAPE_LIB_FEATURE_MEETING_H

#include "../ccd/ccd.h"
#include "feature_contact.h"
#include "paths.h"

DRAPE_NAMESPACE_BEGIN

// Coarsest tolerance of the time of a meeting, as a fraction of the step.
#define DRAPE_MEETING_TIME 0.03125f

#include "../any_width/one.h"
#include "../any_width/moving_face.h"
#include "../any_width/edges.h"
#include "../any_width/end.h"

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

// Returns the unit normal with the given direction on the side from which the cloth's point came. displacement:
// displacement of that point in the step, a straight line. If it runs along the surface, `side` decides: 1 for the
// direction itself.
DRAPE_FUNCTION Vec3 meetingNormal(Vec3 direction, float length, Vec3 displacement, float side, PairBounds bounds)
{
    const Vec3 normal = vec3Direction(direction, length);
    const float along = vec3Dot(normal, displacement);
    if (drapeAbs(along) > DRAPE_SEAM * bounds.m_extent) side = along < 0.0f ? 1.0f : -1.0f;
    return vec3Scale(normal, side);
}

// Classifies a moving face and the origin; see DRAPE_STAY_APART.
DRAPE_FUNCTION int faceNearness(const MovingFace* face, const NearestOfFace* nearest)
{
    if (!faceComesNear(face, nearest)) return DRAPE_STAY_APART;
    const float before = leastAlong(nearest->m_point, face->m_start);
    return nearnessAcross(nearest->m_point, drapeMin(nearest->m_low, before), 0.0f, face->m_bounds);
}

// Classifies two moving edges; see DRAPE_STAY_APART.
DRAPE_FUNCTION int edgesNearness(const EdgePair* pair)
{
    if (!edgesComeNear(pair)) return DRAPE_STAY_APART;
    const Vec3 offset = pair->m_offset;
    const float low = drapeMin(vec3Dot(offset, pair->m_start.m_a), vec3Dot(offset, pair->m_start.m_b));
    const float high = drapeMax(0.0f, vec3Dot(offset, pair->m_start.m_far));
    return nearnessAcross(offset, drapeMin(pair->m_low, low), drapeMax(pair->m_high, high), pair->m_bounds);
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
        result.m_hit && pathsOverlap(start, end, kind == DRAPE_VERTEX_FACE ? 1 : 2, DRAPE_PATH_REACH * bounds.m_reach);
    meeting.m_time = meeting.m_place = result.m_time;
    if (meeting.m_met)
    {
        const float latest = drapeMin(1.0f, result.m_time + 2.0f * settings.m_timeTolerance);
        const float middle = result.m_time + 0.5f * (latest - result.m_time);
        meeting.m_place = coplanarTime(&vectors, result.m_time, latest, middle);
    }
    return meeting;
}

DRAPE_FUNCTION Meeting meetFace(const MovingFace* face)
{
    const Vec3 origin = vec3(0.0f, 0.0f, 0.0f);
    const Vec3 start[4] = {origin, face->m_start.m_p[0], face->m_start.m_p[1], face->m_start.m_p[2]};
    const Vec3 end[4] = {origin, face->m_end.m_p[0], face->m_end.m_p[1], face->m_end.m_p[2]};
    return meetFeatures(DRAPE_VERTEX_FACE, start, end, faceMotion(face), face->m_bounds);
}

DRAPE_FUNCTION Meeting meetEdges(const EdgePair* pair)
{
    const Vec3 origin = vec3(0.0f, 0.0f, 0.0f);
    const Vec3 start[4] = {pair->m_start.m_a, pair->m_start.m_b, origin, pair->m_start.m_far};
    const Vec3 end[4] = {pair->m_end.m_a, pair->m_end.m_b, origin, pair->m_end.m_far};
    return meetFeatures(DRAPE_EDGES, start, end, edgesMotion(pair), pair->m_bounds);
}

DRAPE_NAMESPACE_END

#endif
