// Tests a cloth edge against an edge of the obstacle. feature_contact.h defines contacts and the frame.
#ifndef DRAPE_LIB_EDGE_EDGE_CONTACT_H
#define DRAPE_LIB_EDGE_EDGE_CONTACT_H

#include "face_vertex_contact.h"

DRAPE_NAMESPACE_BEGIN

// Handles edges that met. rests: whether the second one rests. The contact's weights are the parameters along both.
DRAPE_FUNCTION int edgesMet(const EdgePair* pair, int rests, Meeting meeting, Contact* contact)
{
    const TwoEdges e0 = pair->m_start, e1 = pair->m_end;
    TwoEdges edges;
    edges.m_a = vec3Mix(e0.m_a, e1.m_a, meeting.m_place);
    edges.m_b = vec3Mix(e0.m_b, e1.m_b, meeting.m_place);
    edges.m_far = vec3Mix(e0.m_far, e1.m_far, meeting.m_place);
    float s, t;
    edgesClosest(edges, &s, &t);
    const Vec3 direction = edgesDirection(edges);
    const float length = vec3Length(direction);
    if (length <= DRAPE_SEAM * vec3Length(vec3Sub(edges.m_b, edges.m_a)) * vec3Length(edges.m_far))
        return DRAPE_NO_CONTACT;
    const Vec3 before = edgesOffset(e0, s, t), after = edgesOffset(e1, s, t);
    // The relative displacement, with the fewest roundings.
    const Vec3 displacement =
        rests ? vec3Sub(vec3Mix(e1.m_a, e1.m_b, s), vec3Mix(e0.m_a, e0.m_b, s)) : vec3Sub(after, before);
    const Vec3 normal = meetingNormal(direction, length, displacement, -signOf(pair->m_before), pair->m_bounds);
    storeContact(contact, normal, secondPoint(e1, t), vec3(s, t, 0.0f), vec3Dot(normal, before), vec3Dot(normal, after),
                 meeting.m_time);
    return DRAPE_IS_CONTACT;
}

// Returns whether the lines of two edges passed each other. The side at the end is then the wrong one for edges that
// met while parallel, whose meeting has no direction.
DRAPE_FUNCTION int edgesChangedSides(float v0, float v1)
{
    return (v0 < 0.0f && v1 > 0.0f) || (v0 > 0.0f && v1 < 0.0f);
}

// Classifies two edges by their motion alone; see faceVertexPassed() and edgesMet().
DRAPE_FUNCTION int edgesPassed(const EdgePair* pair, int rests, Contact* contact)
{
    const PairBounds bounds = pair->m_bounds;
    if (bounds.m_mode == DRAPE_DISCRETE) return DRAPE_ASK_THE_END;
    const int known = edgesNearness(pair);
    if (!asksForMeeting(known, bounds)) return DRAPE_ASK_THE_END;
    if (!bounds.m_searches) return DRAPE_UNDECIDED;
    ++*bounds.m_searches;
    const Meeting meeting = meetEdges(pair);
    if (!meeting.m_met || known != DRAPE_MAY_MEET) return DRAPE_ASK_THE_END;
    if (edgesMet(pair, rests, meeting, contact)) return DRAPE_IS_CONTACT;
    return edgesChangedSides(pair->m_before, pair->m_after) ? DRAPE_NO_CONTACT : DRAPE_ASK_THE_END;
}

// Tests a moving edge against a resting edge with the given normal cone.
DRAPE_FUNCTION int edgeEdgeContact(const EdgePair* pair, NormalCone cone, Contact* contact)
{
    const int passed = edgesPassed(pair, 1, contact);
    if (passed == DRAPE_IS_CONTACT)
    {
        const float s = contact->m_weights[0];
        contact->m_weights[0] = 1.0f - s;
        contact->m_weights[1] = s;
    }
    if (passed != DRAPE_ASK_THE_END) return passed;
    NearContact near;
    if (!edgesNearWithin(pair, cone, &near)) return DRAPE_NO_CONTACT;
    if (near.m_asks && !coneAdmits(cone, near.m_normal)) return DRAPE_NO_CONTACT;
    storeNear(&near, near.m_point, near.m_weights, contact);
    return DRAPE_IS_CONTACT;
}

DRAPE_NAMESPACE_END

#endif
