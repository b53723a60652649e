// A cloth face, its edges included, against a vertex of the obstacle.
// See feature_contact.h for what a contact is and for the frame.
#ifndef DRAPE_LIB_FACE_VERTEX_CONTACT_H
#define DRAPE_LIB_FACE_VERTEX_CONTACT_H

#include "feature_contact.h"

DRAPE_NAMESPACE_BEGIN

// Signed volume of a moving face and a resting vertex at time t; zero when they are coplanar.
DRAPE_FUNCTION float faceVertexVolume(FeatureTriangle f0, FeatureTriangle f1, Vec3 vertex, float t)
{
    const FeatureTriangle f = triangleMix(f0, f1, t);
    return vec3Dot(triangleNormal(f), vec3Sub(vertex, f.m_p[0]));
}

// A face that swept over the vertex. side: where the vertex was at the start, +1 in front of the face.
DRAPE_FUNCTION int faceVertexPassed(FeatureTriangle f0, FeatureTriangle f1, Vec3 vertex, float s0, float s1, float side,
                                    PairBounds bounds, Contact* contact)
{
    const Vec3 least = vec3Least(vec3Least(vec3Least(f0.m_p[0], f0.m_p[1]), vec3Least(f0.m_p[2], f1.m_p[0])),
                                 vec3Least(f1.m_p[1], f1.m_p[2]));
    const Vec3 most = vec3Most(vec3Most(vec3Most(f0.m_p[0], f0.m_p[1]), vec3Most(f0.m_p[2], f1.m_p[0])),
                               vec3Most(f1.m_p[1], f1.m_p[2]));
    if (boxesApart(least, most, vertex, vertex, bounds.m_reachSlack)) return 0;

    // The volume is cubic in time; a few steps of false position bring its root near enough for the weights.
    float low = 0.0f, high = 1.0f, time = 0.0f;
    for (int i = 0; i < 4; ++i)
    {
        time = low + (high - low) * (s0 / (s0 - s1));
        const float s = faceVertexVolume(f0, f1, vertex, time);
        if (side * s < 0.0f)
        {
            high = time;
            s1 = s;
        }
        else
        {
            low = time;
            s0 = s;
        }
        if (s0 == s1) break;
    }
    const FeatureTriangle f = triangleMix(f0, f1, time);
    const Vec3 weights = closestOnTriangle(vertex, f.m_p[0], f.m_p[1], f.m_p[2]);
    const int onFace = weights.x > 0.0f && weights.y > 0.0f && weights.z > 0.0f;
    const float miss = vec3Length(vec3Sub(vertex, featurePoint(f, weights)));
    if (miss > (onFace ? bounds.m_reach : DRAPE_SEAM * bounds.m_extent)) return 0;
    Vec3 area = triangleNormal(f);
    const Vec3 c1 = vec3Sub(featurePoint(f1, weights), vertex);
    // A face that turned as it passed: its normal at the end is the one that the vertex is behind.
    if (side * vec3Dot(area, c1) < 0.0f) area = triangleNormal(f1);
    const float length = vec3Length(area);
    if (length == 0.0f) return 0;
    const Vec3 normal = vec3Scale(area, -side / length);
    storeContact(contact, normal, vertex, weights, vec3Dot(normal, vec3Sub(featurePoint(f0, weights), vertex)),
                 vec3Dot(normal, c1), time);
    return 1;
}

// Moving face against a resting vertex with the given normal cone. A vertex nearest to an edge of the face counts here
// too (weights with one zero); one nearest to a node is the node's contact. beyond: the third vertices of the
// neighbours over the face's three edges (m_a … m_c), into start and end, positions at the step's start and end; a
// neighbour whose third vertex is invalid makes no contacts and counts as absent. origin: of the local frame.
DRAPE_FUNCTION int faceVertexContact(const MovingFace* face, const DRAPE_UINT* beyond, const DRAPE_GLOBAL float* start,
                                     const DRAPE_GLOBAL float* end, Vec3 origin, Vec3 vertex, NormalCone cone,
                                     PairBounds bounds, Contact* contact)
{
    const FeatureTriangle f0 = face->m_start, f1 = face->m_end;
    const float areaLength = face->m_areaEndLength;
    const float s0 = vec3Dot(face->m_areaStart, vec3Sub(vertex, f0.m_p[0]));
    const float s1 = vec3Dot(face->m_areaEnd, vec3Sub(vertex, f1.m_p[0]));
    const float side = s0 < 0.0f ? -1.0f : 1.0f;
    if (side * s1 < 0.0f) return faceVertexPassed(f0, f1, vertex, s0, s1, side, bounds, contact);
    if (drapeAbs(s1) > areaLength * bounds.m_reachSlack) return 0;

    const Vec3 weights = closestOnTriangle(vertex, f1.m_p[0], f1.m_p[1], f1.m_p[2]);
    const int zeros = (weights.x == 0.0f) + (weights.y == 0.0f) + (weights.z == 0.0f);
    if (zeros == 2) return 0;
    Vec3 normal = vec3Scale(face->m_areaEnd, -side * drapeRatio(1.0f, areaLength));
    if (zeros == 0 && areaLength > 0.0f && !coneAdmits(cone, normal)) return 0;
    const Vec3 point = featurePoint(f1, weights);
    const Vec3 offset = vec3Sub(point, vertex);
    const float distance = vec3Length(offset);
    const float lowFace =
        drapeMin(drapeMin(vec3Dot(offset, f1.m_p[0]), vec3Dot(offset, f1.m_p[1])), vec3Dot(offset, f1.m_p[2]));
    if (provenApart(offset, lowFace, vec3Dot(offset, vertex), bounds)) return 0;
    if (distance > DRAPE_SEAM * bounds.m_extent && (zeros == 1 || areaLength == 0.0f))
    {
        normal = vec3Scale(offset, 1.0f / distance);
        if (!coneAdmits(cone, normal)) return 0;
        const DRAPE_UINT neighbour = weights.z == 0.0f ? beyond[0] : weights.x == 0.0f ? beyond[1] : beyond[2];
        const Vec3 opposite = vec3Load(end, neighbour);
        if (!leansAway(vec3Scale(offset, -1.0f), vec3Sub(opposite, origin), point) && positionIsValid(opposite) &&
            positionIsValid(vec3Load(start, neighbour)))
        {
            return 0;
        }
    }
    else if (areaLength == 0.0f)
    {
        return 0;
    }
    storeContact(contact, normal, vertex, weights, vec3Dot(normal, vec3Sub(featurePoint(f0, weights), vertex)),
                 vec3Dot(normal, offset), 1.0f);
    return 1;
}

DRAPE_NAMESPACE_END

#endif
