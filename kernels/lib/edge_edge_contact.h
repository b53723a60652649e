// Tests a cloth edge against an edge of the obstacle. feature_contact.h defines contacts and the frame.
#ifndef DRAPE_LIB_EDGE_EDGE_CONTACT_H
#define DRAPE_LIB_EDGE_EDGE_CONTACT_H

#include "feature_meeting.h"

DRAPE_NAMESPACE_BEGIN

DRAPE_FUNCTION FeatureEdge edgeMix(FeatureEdge from, FeatureEdge to, float t)
{
    FeatureEdge r;
    r.m_a = vec3Mix(from.m_a, to.m_a, t);
    r.m_b = vec3Mix(from.m_b, to.m_b, t);
    return r;
}

// Returns six times the signed volume of two edges; zero if they are coplanar.
DRAPE_FUNCTION float edgeEdgeVolume(FeatureEdge e, FeatureEdge o)
{
    return vec3Dot(vec3Cross(vec3Sub(e.m_b, e.m_a), vec3Sub(o.m_b, o.m_a)), vec3Sub(o.m_a, e.m_a));
}

// Handles an edge that met the obstacle's edge. v0: the volume at the step's start.
DRAPE_FUNCTION int edgeEdgeMet(FeatureEdge e0, FeatureEdge e1, FeatureEdge o, Meeting meeting, float v0,
                               PairBounds bounds, Contact* contact)
{
    const FeatureEdge e = edgeMix(e0, e1, meeting.m_place);
    float s, t;
    closestOnSegments(e.m_a, e.m_b, o.m_a, o.m_b, &s, &t);
    const Vec3 across = vec3Sub(e.m_b, e.m_a), along = vec3Sub(o.m_b, o.m_a);
    const Vec3 direction = vec3Cross(across, along);
    const float length = vec3Length(direction);
    if (length <= DRAPE_SEAM * vec3Length(across) * vec3Length(along)) return DRAPE_NO_CONTACT;
    const Vec3 point = vec3Mix(o.m_a, o.m_b, t);
    const Vec3 start = vec3Mix(e0.m_a, e0.m_b, s), end = vec3Mix(e1.m_a, e1.m_b, s);
    const Vec3 normal = meetingNormal(direction, length, vec3Sub(end, start), v0 < 0.0f ? 1.0f : -1.0f, bounds);
    storeContact(contact, normal, point, vec3(1.0f - s, s, 0.0f), vec3Dot(normal, vec3Sub(start, point)),
                 vec3Dot(normal, vec3Sub(end, point)), meeting.m_time);
    return DRAPE_IS_CONTACT;
}

// Returns whether the lines of two edges passed each other. The side at the end is then the wrong one for edges that
// met while parallel, whose meeting has no direction.
DRAPE_FUNCTION int edgesChangedSides(float v0, float v1)
{
    return (v0 < 0.0f && v1 > 0.0f) || (v0 > 0.0f && v1 < 0.0f);
}

// Tests an edge that moves from e0 to e1 against a resting edge with the given normal cone; both closest points must be
// inside their edges. A cloth face that is nearer beside the edge is no reason to drop the contact: if cloth bends over
// a sharp edge of the obstacle, every crossing counts. The first comparisons drop most pairs and need neither division
// nor root.
DRAPE_FUNCTION int edgeEdgeContact(FeatureEdge e0, FeatureEdge e1, FeatureEdge o, NormalCone cone, PairBounds bounds,
                                   Contact* contact)
{
    const Vec3 along = vec3Sub(o.m_b, o.m_a);
    const Vec3 across = vec3Sub(e1.m_b, e1.m_a);
    const Vec3 direction = vec3Cross(across, along);
    const float v0 = edgeEdgeVolume(e0, o);
    const float v1 = vec3Dot(direction, vec3Sub(o.m_a, e1.m_a));
    if (bounds.m_mode != DRAPE_DISCRETE)
    {
        const int known = edgeNearness(e0, e1, o, v0, v1, bounds);
        if (asksForMeeting(known, bounds))
        {
            if (!bounds.m_searches) return DRAPE_UNDECIDED;
            ++*bounds.m_searches;
            const Meeting meeting = meetEdge(e0, e1, o, bounds);
            if (meeting.m_met && known == DRAPE_MAY_MEET)
            {
                if (edgeEdgeMet(e0, e1, o, meeting, v0, bounds, contact)) return DRAPE_IS_CONTACT;
                if (edgesChangedSides(v0, v1)) return DRAPE_NO_CONTACT;
            }
        }
    }
    const float squared = vec3Dot(direction, direction);
    // Inside both edges the offset is parallel to the direction (or the edges are parallel, and it may be any).
    const int parallel = squared <= DRAPE_SEAM * DRAPE_SEAM * vec3Dot(across, across) * vec3Dot(along, along);
    if (!parallel)
    {
        const float facing = vec3Dot(cone.m_axis, direction);
        if (cone.m_cosine > 0.0f && facing * facing < cone.m_cosine * cone.m_cosine * squared) return 0;
        if (v1 * v1 > squared * (bounds.m_reachSlack * bounds.m_reachSlack)) return 0;
    }
    float s, t;
    closestOnSegments(e1.m_a, e1.m_b, o.m_a, o.m_b, &s, &t);
    if (!(s > 0.0f && s < 1.0f && t > 0.0f && t < 1.0f)) return 0;
    const Vec3 point = vec3Mix(o.m_a, o.m_b, t);
    const Vec3 x1 = vec3Mix(e1.m_a, e1.m_b, s);
    const Vec3 offset = vec3Sub(x1, point);
    const float lowCloth = drapeMin(vec3Dot(offset, e1.m_a), vec3Dot(offset, e1.m_b));
    const float highObstacle = drapeMax(vec3Dot(offset, o.m_a), vec3Dot(offset, o.m_b));
    if (provenApart(offset, lowCloth, highObstacle, bounds)) return 0;
    const float distance = vec3Length(offset);
    if (edgesAreOutOfReach(distance, e1, o, bounds)) return 0;
    Vec3 normal;
    if (distance > DRAPE_SEAM * bounds.m_extent)
    {
        normal = vec3Direction(offset, distance);
        if (parallel && !coneAdmits(cone, normal)) return 0;
    }
    else
    {
        if (parallel) return 0;  // touching along a line: the ends report it
        const float before = bounds.m_mode == DRAPE_DISCRETE ? v1 : v0;
        normal = vec3Scale(vec3Direction(direction, drapeSqrt(squared)), before < 0.0f ? 1.0f : -1.0f);
    }
    storeContact(contact, normal, point, vec3(1.0f - s, s, 0.0f),
                 vec3Dot(normal, vec3Sub(vec3Mix(e0.m_a, e0.m_b, s), point)), vec3Dot(normal, offset), 1.0f);
    return 1;
}

DRAPE_NAMESPACE_END

#endif
