// Tests a cloth face, including its edges, against a vertex of the obstacle. feature_contact.h defines contacts and the
// frame.
#ifndef DRAPE_LIB_FACE_VERTEX_CONTACT_H
#define DRAPE_LIB_FACE_VERTEX_CONTACT_H

#include "feature_meeting.h"
#include "../step_data/cloth_reads.h"

DRAPE_NAMESPACE_BEGIN

// Handles a face that met the vertex.
DRAPE_FUNCTION int faceVertexMet(const MovingFace* face, Meeting meeting, Contact* contact)
{
    const FeatureTriangle f = triangleMix(face->m_start, face->m_end, meeting.m_place);
    const FaceArea area = faceArea(f);
    const Vec3 vertex = vec3(0.0f, 0.0f, 0.0f), weights = closestOnFace(vertex, f, area.m_thin);
    const Vec3 start = featurePoint(face->m_start, weights), end = featurePoint(face->m_end, weights);
    if (area.m_length == 0.0f) return DRAPE_NO_CONTACT;
    const Vec3 normal =
        meetingNormal(area.m_vector, area.m_length, vec3Sub(end, start), -signOf(face->m_before), face->m_bounds);
    storeContact(contact, normal, vertex, weights, vec3Dot(normal, start), vec3Dot(normal, end), meeting.m_time);
    return DRAPE_IS_CONTACT;
}

// Answer of faceVertexPassed() and edgesPassed() if the motion decides nothing and the step's end must.
#define DRAPE_ASK_THE_END 3

// Classifies a face and a vertex in the origin by their motion alone.
DRAPE_FUNCTION int faceVertexPassed(const MovingFace* face, const NearestOfFace* nearest, Contact* contact)
{
    const PairBounds bounds = face->m_bounds;
    if (bounds.m_mode == DRAPE_DISCRETE) return DRAPE_ASK_THE_END;
    const int known = faceNearness(face, nearest);
    if (!asksForMeeting(known, bounds)) return DRAPE_ASK_THE_END;
    if (!bounds.m_searches) return DRAPE_UNDECIDED;
    ++*bounds.m_searches;
    const Meeting meeting = meetFace(face);
    if (!meeting.m_met || known != DRAPE_MAY_MEET) return DRAPE_ASK_THE_END;
    if (faceVertexMet(face, meeting, contact)) return DRAPE_IS_CONTACT;
    // The two met where the face has no direction. If they changed sides there, the side at the end is the wrong one.
    // The plane of a thin face turns freely about the face's length: its sides mean nothing.
    const int sidesTell = !face->m_areaEnd.m_thin && !isThin(face->m_start, vec3Length(face->m_areaStart));
    return signOf(face->m_before) != signOf(face->m_after) && sidesTell ? DRAPE_NO_CONTACT : DRAPE_ASK_THE_END;
}

// Stores the contact of a face near to a vertex, unless the neighbour over the edge on which the closest point lies is
// nearer. A neighbour whose third vertex is invalid makes no contacts and counts as absent. origin: of the local frame.
DRAPE_FUNCTION int acceptFaceVertex(const NearContact* near, const ClothView* cloth,
                                    const DRAPE_GLOBAL Triangle* triangle, Vec3 origin, Contact* contact)
{
    if (near->m_asks)
    {
        const DRAPE_UINT neighbour = vertexBeyond(cloth, triangle,
                                                  near->m_weights.z == 0.0f   ? 0
                                                  : near->m_weights.x == 0.0f ? 1
                                                                              : 2);
        const Vec3 opposite = vec3Load(cloth->m_end, neighbour);
        if (!leansAway(vec3Scale(near->m_point, -1.0f), vec3Sub(opposite, origin), near->m_point, near->m_seam) &&
            positionIsValid(opposite) && positionIsValid(vec3Load(cloth->m_start, neighbour)))
            return DRAPE_NO_CONTACT;
    }
    storeNear(near, vec3(0.0f, 0.0f, 0.0f), near->m_weights, contact);
    return DRAPE_IS_CONTACT;
}

// Tests a moving face against a resting vertex with the given normal cone. origin: the vertex, which is the frame's.
DRAPE_FUNCTION int faceVertexContact(const MovingFace* face, NormalCone cone, const ClothView* cloth,
                                     const DRAPE_GLOBAL Triangle* triangle, Vec3 origin, Contact* contact)
{
    const NearestOfFace nearest = nearestOfFace(face);
    const int passed = faceVertexPassed(face, &nearest, contact);
    if (passed != DRAPE_ASK_THE_END) return passed;
    NearContact near;
    if (!faceNearVertex(face, &nearest, cone, &near)) return DRAPE_NO_CONTACT;
    return acceptFaceVertex(&near, cloth, triangle, origin, contact);
}

DRAPE_NAMESPACE_END

#endif
