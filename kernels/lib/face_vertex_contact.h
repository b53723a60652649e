// Tests a cloth face, including its edges, against a vertex of the obstacle. feature_contact.h defines contacts and the
// frame.
#ifndef DRAPE_LIB_FACE_VERTEX_CONTACT_H
#define DRAPE_LIB_FACE_VERTEX_CONTACT_H

#include "feature_meeting.h"

DRAPE_NAMESPACE_BEGIN

// Handles a face that met the vertex. side: the vertex's side at the start, +1 in front of the face.
DRAPE_FUNCTION int faceVertexMet(FeatureTriangle f0, FeatureTriangle f1, Vec3 vertex, Meeting meeting, float side,
                                 PairBounds bounds, Contact* contact)
{
    const FeatureTriangle f = triangleMix(f0, f1, meeting.m_place);
    const FaceArea area = faceArea(f);
    const Vec3 weights = closestOnFace(vertex, f, area.m_thin);
    const Vec3 start = featurePoint(f0, weights), end = featurePoint(f1, weights);
    if (area.m_length == 0.0f) return DRAPE_NO_CONTACT;
    const Vec3 normal = meetingNormal(area.m_vector, area.m_length, vec3Sub(end, start), -side, bounds);
    storeContact(contact, normal, vertex, weights, vec3Dot(normal, vec3Sub(start, vertex)),
                 vec3Dot(normal, vec3Sub(end, vertex)), meeting.m_time);
    return DRAPE_IS_CONTACT;
}

// Answer of faceVertexPassed if the motion decides nothing and the step's end must.
#define DRAPE_ASK_THE_END 3

// Classifies a face and a vertex by their motion alone. s0, s1: the vertex's distance from the face's plane times the
// length of the face's area vector, at the step's start and end.
DRAPE_FUNCTION int faceVertexPassed(const MovingFace* face, Vec3 vertex, float s0, float s1, PairBounds bounds,
                                    Contact* contact)
{
    const FeatureTriangle f0 = face->m_start;
    const int known = faceNearness(face, vertex, s0, s1, bounds);
    if (!asksForMeeting(known, bounds)) return DRAPE_ASK_THE_END;
    if (!bounds.m_searches) return DRAPE_UNDECIDED;
    ++*bounds.m_searches;
    const Meeting meeting = meetFace(face, vertex, bounds);
    if (!meeting.m_met || known != DRAPE_MAY_MEET) return DRAPE_ASK_THE_END;
    const float before = s0 < 0.0f ? -1.0f : 1.0f, after = s1 < 0.0f ? -1.0f : 1.0f;
    if (faceVertexMet(f0, face->m_end, vertex, meeting, before, bounds, contact)) return DRAPE_IS_CONTACT;
    // The two met where the face has no direction. If they changed sides there, the side at the end is the wrong one.
    // The plane of a thin face turns freely about the face's length: its sides mean nothing.
    const int sidesTell = !face->m_areaEnd.m_thin && !isThin(f0, vec3Length(face->m_areaStart));
    return after != before && sidesTell ? DRAPE_NO_CONTACT : DRAPE_ASK_THE_END;
}

// Returns whether the neighbour over the edge on which the closest point lies (weights with one zero) is nearer to
// the vertex. beyond, start, end, origin: see faceVertexContact(). offset: from the vertex to that point; seam: m.
DRAPE_FUNCTION int neighbourIsNearer(Vec3 weights, const DRAPE_UINT* beyond, const DRAPE_GLOBAL float* start,
                                     const DRAPE_GLOBAL float* end, Vec3 origin, Vec3 point, Vec3 offset, float seam)
{
    const DRAPE_UINT neighbour = weights.z == 0.0f ? beyond[0] : weights.x == 0.0f ? beyond[1] : beyond[2];
    const Vec3 opposite = vec3Load(end, neighbour);
    return !leansAway(vec3Scale(offset, -1.0f), vec3Sub(opposite, origin), point, seam) && positionIsValid(opposite) &&
           positionIsValid(vec3Load(start, neighbour));
}

// Tests a moving face against a resting vertex with the given normal cone. A vertex nearest to an edge of the face
// counts here too (weights with one zero); one nearest to a node is the node's contact. beyond: the third vertices of
// the neighbours over the face's three edges (m_a … m_c), as indices into start and end. start, end: positions at the
// step's start and end. A neighbour whose third vertex is invalid makes no contacts and counts as absent. origin: of
// the local frame.
DRAPE_FUNCTION int faceVertexContact(const MovingFace* face, const DRAPE_UINT* beyond, const DRAPE_GLOBAL float* start,
                                     const DRAPE_GLOBAL float* end, Vec3 origin, Vec3 vertex, NormalCone cone,
                                     PairBounds bounds, Contact* contact)
{
    const FeatureTriangle f0 = face->m_start, f1 = face->m_end;
    const float areaLength = face->m_areaEnd.m_length;
    const int thin = face->m_areaEnd.m_thin;
    const float s0 = vec3Dot(face->m_areaStart, vec3Sub(vertex, f0.m_p[0]));
    const float s1 = vec3Dot(face->m_areaEnd.m_vector, vec3Sub(vertex, f1.m_p[0]));
    const float side = s1 < 0.0f ? -1.0f : 1.0f;
    if (bounds.m_mode != DRAPE_DISCRETE)
    {
        const int passed = faceVertexPassed(face, vertex, s0, s1, bounds, contact);
        if (passed != DRAPE_ASK_THE_END) return passed;
    }
    if (drapeAbs(s1) > areaLength * bounds.m_reachSlack) return 0;

    const Vec3 weights = closestOnFace(vertex, f1, thin);
    const int zeros = (weights.x == 0.0f) + (weights.y == 0.0f) + (weights.z == 0.0f);
    if (zeros == 2) return 0;
    Vec3 normal = vec3Scale(face->m_areaEnd.m_vector, -side * drapeRatio(1.0f, areaLength));
    if (zeros == 0 && !thin && !coneAdmits(cone, normal)) return 0;
    const Vec3 point = featurePoint(f1, weights);
    const Vec3 offset = vec3Sub(point, vertex);
    const float distance = vec3Length(offset);
    const float lowFace =
        drapeMin(drapeMin(vec3Dot(offset, f1.m_p[0]), vec3Dot(offset, f1.m_p[1])), vec3Dot(offset, f1.m_p[2]));
    if (provenApart(offset, lowFace, vec3Dot(offset, vertex), bounds)) return 0;
    if (pointIsOutOfReach(distance, vertex, &f1, bounds)) return 0;
    if (distance > DRAPE_SEAM * bounds.m_extent && (zeros == 1 || thin))
    {
        normal = vec3Direction(offset, distance);
        if (!coneAdmits(cone, normal)) return 0;
        // Either long edge of a thin face may seem the nearer one. Squared distances err by 4 u of the square, so
        // that the offset leans by the root of that.
        const float seam = thin ? DRAPE_SEAM * bounds.m_extent + 5e-4f * distance : DRAPE_SEAM * distance;
        if (zeros == 1 && neighbourIsNearer(weights, beyond, start, end, origin, point, offset, seam)) return 0;
    }
    else if (areaLength == 0.0f || (thin && zeros == 0 && !coneAdmits(cone, normal)))
    {
        return 0;
    }
    storeContact(contact, normal, vertex, weights, vec3Dot(normal, vec3Sub(featurePoint(f0, weights), vertex)),
                 vec3Dot(normal, offset), 1.0f);
    return 1;
}

DRAPE_NAMESPACE_END

#endif
