// Tests a cloth node against a face of the obstacle, including its edges and vertices. feature_contact.h defines
// contacts and the frame.
#ifndef DRAPE_LIB_NODE_FACE_CONTACT_H
#define DRAPE_LIB_NODE_FACE_CONTACT_H

#include "feature_contact.h"
#include "ways.h"

DRAPE_NAMESPACE_BEGIN

// Returns the cone of the obstacle feature on which the closest point with these weights lies; a face admits its own
// normal only and needs none.
DRAPE_FUNCTION NormalCone closestFeatureCone(Vec3 weights, const DRAPE_GLOBAL Triangle* triangle,
                                             const DRAPE_GLOBAL NormalCone* vertexCones,
                                             const DRAPE_GLOBAL NormalCone* edgeCones)
{
    if (weights.x == 1.0f) return vertexCones[triangle->m_vertices[0]];
    if (weights.y == 1.0f) return vertexCones[triangle->m_vertices[1]];
    if (weights.z == 1.0f) return vertexCones[triangle->m_vertices[2]];
    if (weights.z == 0.0f) return edgeCones[triangle->m_edges[0]];
    if (weights.x == 0.0f) return edgeCones[triangle->m_edges[1]];
    return edgeCones[triangle->m_edges[2]];
}

// Maximum slide along the face, as a share of a pair's extent, of the face's closest point to a point in its plane.
// The point's weights err by u L⁴ over the square of the doubled area. The doubled area exceeds DRAPE_THIN L² for
// faces that are not thin.
#define DRAPE_SLIDE 1e-3f

// Returns whether a point of the face's plane lies in the face, or less than the slack (m) outside of its edges. The
// area vector may have any length.
DRAPE_FUNCTION int isWithinEdges(Vec3 point, const FeatureTriangle* face, Vec3 area, float slack)
{
    int within = 1;
    DRAPE_UNROLL
    for (int i = 0; i < 3; ++i)
    {
        const FeatureEdge edge = triangleEdge(face, i);
        const Vec3 outwards = vec3Cross(vec3Sub(edge.m_b, edge.m_a), area);
        within &= vec3Dot(outwards, vec3Sub(point, edge.m_a)) <= slack * vec3Length(outwards);
    }
    return within;
}

// Returns whether a path through the face's plane went through the face. hit: the point of the path in the plane,
// which was found `distance` (m) from the face.
DRAPE_FUNCTION int wentThrough(Vec3 x0, Vec3 x1, const FeatureTriangle* face, Vec3 area, Vec3 hit, float distance,
                               PairBounds bounds)
{
    const float seam = DRAPE_SEAM * bounds.m_extent;
    if (distance > seam && !(distance <= DRAPE_SLIDE * bounds.m_extent && isWithinEdges(hit, face, area, seam)))
        return 0;
    if (distance <= DRAPE_WAY_REACH * bounds.m_reach) return 1;
    const Vec3 start[4] = {x0, face->m_p[0], face->m_p[1], face->m_p[2]};
    const Vec3 end[4] = {x1, face->m_p[0], face->m_p[1], face->m_p[2]};
    return waysOverlap(start, end, 1, DRAPE_WAY_REACH * bounds.m_reach);
}

// Tests a node that moves from x0 to x1 against a resting face. Returns whether there is a contact.
DRAPE_FUNCTION int nodeFaceContact(Vec3 x0, Vec3 x1, const RestingFace* resting, const DRAPE_GLOBAL Triangle* triangle,
                                   const DRAPE_GLOBAL NormalCone* vertexCones, const DRAPE_GLOBAL NormalCone* edgeCones,
                                   PairBounds bounds, Contact* contact)
{
    const FeatureTriangle face = resting->m_corners;
    const Vec3 area = resting->m_area.m_vector;
    const float areaLength = resting->m_area.m_length;
    const int thin = resting->m_area.m_thin;
    const float s0 = vec3Dot(area, vec3Sub(x0, face.m_p[0]));
    const float s1 = vec3Dot(area, vec3Sub(x1, face.m_p[0]));
    const float before = bounds.m_mode == DRAPE_DISCRETE ? s1 : s0;
    const float side = before < 0.0f ? -1.0f : 1.0f;
    // A face whose area is too small for a length has no side; the tests below find what is near.
    const int passed = areaLength > 0.0f && side * s1 < 0.0f;
    // |s1| / |area| is a lower bound of the distance.
    if (!passed && drapeAbs(s1) > areaLength * bounds.m_reachSlack) return 0;
    Vec3 normal = vec3Scale(area, side * drapeRatio(1.0f, areaLength));

    if (passed)  // the path went through the face's plane
    {
        const float time = s0 / (s0 - s1);
        const Vec3 hit = vec3Mix(x0, x1, time);
        const Vec3 weights = closestOnFace(hit, face, thin);
        const Vec3 point = featurePoint(face, weights);
        if (wentThrough(x0, x1, &face, area, hit, vec3Length(vec3Sub(hit, point)), bounds))
        {
            storeContact(contact, normal, point, vec3(1.0f, 0.0f, 0.0f), vec3Dot(normal, vec3Sub(x0, point)),
                         vec3Dot(normal, vec3Sub(x1, point)), time);
            return 1;
        }
        // The path went around the face, so the node belongs on the side where it ends. The plane of a thin face turns
        // freely about the face's length: its sides mean nothing.
        if (!thin)
        {
            if (drapeAbs(s1) > areaLength * bounds.m_reachSlack) return 0;
            normal = vec3Scale(normal, -1.0f);
        }
    }

    const Vec3 weights = closestOnFace(x1, face, thin);
    const Vec3 point = featurePoint(face, weights);
    const Vec3 offset = vec3Sub(x1, point);
    const float highFace =
        drapeMax(drapeMax(vec3Dot(offset, face.m_p[0]), vec3Dot(offset, face.m_p[1])), vec3Dot(offset, face.m_p[2]));
    if (provenApart(offset, vec3Dot(offset, x1), highFace, bounds)) return 0;
    const float distance = vec3Length(offset);
    if (pointIsOutOfReach(distance, x1, &face, bounds)) return 0;
    const int onFace = weights.x > 0.0f && weights.y > 0.0f && weights.z > 0.0f;
    if (distance > DRAPE_SEAM * bounds.m_extent && (!onFace || thin))
    {
        normal = vec3Direction(offset, distance);
        if (!onFace && !coneAdmits(closestFeatureCone(weights, triangle, vertexCones, edgeCones), normal)) return 0;
    }
    else if (areaLength == 0.0f)
    {
        return 0;  // touching a face without a direction: its neighbours report it
    }
    storeContact(contact, normal, point, vec3(1.0f, 0.0f, 0.0f), vec3Dot(normal, vec3Sub(x0, point)),
                 vec3Dot(normal, offset), 1.0f);
    return 1;
}

DRAPE_NAMESPACE_END

#endif
