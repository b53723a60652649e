// Contacts of single features: a cloth node against an obstacle face, a cloth face against an obstacle vertex, a cloth edge
// against an obstacle edge. The cloth moves linearly over the step, the obstacle rests.
//
// A contact is reported when (a) the node, face or edge passed through the other feature during the step, and then its
// normal points to the side the cloth came from and the gap at the end is negative; or (b) the two are within reach at the
// step's end and locally closest: the direction between them lies in the obstacle's normal cone and, for edges, in the
// cloth's Voronoi region. The second condition drops pairs whose neighbours are nearer and whose normals would push
// sideways. Pairs are dropped for distance only on proof (provenApart).
//
// All positions are in a local frame: the caller has subtracted a vertex of the obstacle's triangle, so that rounding scales
// with the size of the pair and not with its distance from the world's origin.
#ifndef DRAPE_LIB_FEATURE_CONTACT_H
#define DRAPE_LIB_FEATURE_CONTACT_H

#include "../shared/contact.h"
#include "../shared/mesh.h"
#include "closest.h"

DRAPE_NAMESPACE_BEGIN

// Relative size of a distance at which its direction is rounding noise, and width of the seam between neighbouring features
// in which a path that hits both, or by rounding neither, still counts as a hit.
#define DRAPE_SEAM 1e-5f

typedef struct FeatureTriangle
{
    Vec3 m_a, m_b, m_c;
} FeatureTriangle;

typedef struct FeatureEdge
{
    Vec3 m_a, m_b;
} FeatureEdge;

DRAPE_FUNCTION Vec3 triangleNormal(FeatureTriangle f) { return vec3Cross(vec3Sub(f.m_b, f.m_a), vec3Sub(f.m_c, f.m_a)); }

DRAPE_FUNCTION FeatureTriangle triangleMix(FeatureTriangle f, FeatureTriangle g, float t)
{
    FeatureTriangle r;
    r.m_a = vec3Mix(f.m_a, g.m_a, t);
    r.m_b = vec3Mix(f.m_b, g.m_b, t);
    r.m_c = vec3Mix(f.m_c, g.m_c, t);
    return r;
}

DRAPE_FUNCTION Vec3 featurePoint(FeatureTriangle f, Vec3 weights)
{
    return trianglePoint(f.m_a, f.m_b, f.m_c, weights);
}

DRAPE_FUNCTION float triangleExtent(FeatureTriangle f)
{
    return drapeMax(drapeMax(vec3NormMax(f.m_a), vec3NormMax(f.m_b)), vec3NormMax(f.m_c));
}

// True when the support gap along n proves a distance above reach. lowA: least n·a over one set; highB: greatest n·b over
// the other; extent: largest coordinate of both. With u = 2^-24: three products, two sums and the frame's shift err by at
// most 12 u |n|₁ extent.
DRAPE_FUNCTION int provenApart(Vec3 n, float lowA, float highB, float extent, float reach)
{
    const float twelveUnits = 7.1525574e-7f;
    const float gap = lowA - highB - twelveUnits * vec3Norm1(n) * extent - 1e-36f;
    return gap > reach * vec3Length(n) * (1.0f + twelveUnits);
}

DRAPE_FUNCTION int coneAdmits(NormalCone cone, Vec3 direction)
{
    return drapeAbs(vec3Dot(cone.m_axis, direction)) >= cone.m_cosine;
}

DRAPE_FUNCTION void storeContact(Contact* contact, Vec3 normal, Vec3 point, Vec3 weights, float gap0, float gap1,
                                 float time)
{
    contact->m_normal[0] = normal.x;
    contact->m_normal[1] = normal.y;
    contact->m_normal[2] = normal.z;
    contact->m_point[0] = point.x;
    contact->m_point[1] = point.y;
    contact->m_point[2] = point.z;
    contact->m_weights[0] = weights.x;
    contact->m_weights[1] = weights.y;
    contact->m_weights[2] = weights.z;
    contact->m_gap0 = gap0;
    contact->m_gap1 = gap1;
    contact->m_time = time;
}

// The cone of the obstacle feature on which the closest point with these weights lies; a face admits its own normal only
// and needs none.
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

// Node moving from x0 to x1 against a resting face. Returns whether there is a contact.
DRAPE_FUNCTION int nodeFaceContact(Vec3 x0, Vec3 x1, FeatureTriangle face, const DRAPE_GLOBAL Triangle* triangle,
                                   const DRAPE_GLOBAL NormalCone* vertexCones,
                                   const DRAPE_GLOBAL NormalCone* edgeCones, float reach, Contact* contact)
{
    const Vec3 area = triangleNormal(face);
    const float areaLength = vec3Length(area);
    const float s0 = vec3Dot(area, vec3Sub(x0, face.m_a));
    const float s1 = vec3Dot(area, vec3Sub(x1, face.m_a));
    const float side = s0 < 0.0f ? -1.0f : 1.0f;
    const float extent = drapeMax(drapeMax(vec3NormMax(x0), vec3NormMax(x1)), triangleExtent(face));
    Vec3 normal = vec3Scale(area, side * drapeRatio(1.0f, areaLength));

    if (side * s1 < 0.0f)  // the path passed through the face's plane
    {
        const float time = s0 / (s0 - s1);
        const Vec3 hit = vec3Mix(x0, x1, time);
        const Vec3 weights = closestOnTriangle(hit, face.m_a, face.m_b, face.m_c);
        const Vec3 point = featurePoint(face, weights);
        if (vec3Length(vec3Sub(hit, point)) > DRAPE_SEAM * extent) return 0;
        storeContact(contact, normal, point, vec3(1.0f, 0.0f, 0.0f), vec3Dot(normal, vec3Sub(x0, point)),
                     vec3Dot(normal, vec3Sub(x1, point)), time);
        return 1;
    }

    // |s1| / |area| is a lower bound of the distance; the slack covers the rounding of both.
    if (drapeAbs(s1) > areaLength * (reach * 1.001f + DRAPE_SEAM * extent)) return 0;
    const Vec3 weights = closestOnTriangle(x1, face.m_a, face.m_b, face.m_c);
    const Vec3 point = featurePoint(face, weights);
    const Vec3 offset = vec3Sub(x1, point);
    const float highFace = drapeMax(drapeMax(vec3Dot(offset, face.m_a), vec3Dot(offset, face.m_b)), vec3Dot(offset, face.m_c));
    if (provenApart(offset, vec3Dot(offset, x1), highFace, extent, reach)) return 0;
    const float distance = vec3Length(offset);
    const int onFace = weights.x > 0.0f && weights.y > 0.0f && weights.z > 0.0f;
    if (distance > DRAPE_SEAM * extent && (!onFace || areaLength == 0.0f))
    {
        normal = vec3Scale(offset, 1.0f / distance);
        if (!coneAdmits(closestFeatureCone(weights, triangle, vertexCones, edgeCones), normal)) return 0;
    }
    else if (areaLength == 0.0f)
    {
        return 0;  // touching a face without a direction: its neighbours report it
    }
    storeContact(contact, normal, point, vec3(1.0f, 0.0f, 0.0f), vec3Dot(normal, vec3Sub(x0, point)),
                 vec3Dot(normal, offset), 1.0f);
    return 1;
}

// Signed volume of a moving face and a resting vertex at time t; zero when they are coplanar.
DRAPE_FUNCTION float faceVertexVolume(FeatureTriangle f0, FeatureTriangle f1, Vec3 vertex, float t)
{
    const FeatureTriangle f = triangleMix(f0, f1, t);
    return vec3Dot(triangleNormal(f), vec3Sub(vertex, f.m_a));
}

// A face that swept over the vertex. side: where the vertex was at the start, +1 in front of the face.
DRAPE_FUNCTION int faceVertexPassed(FeatureTriangle f0, FeatureTriangle f1, Vec3 vertex, float s0, float s1, float side,
                                    float extent, float reach, Contact* contact)
{
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
    const Vec3 weights = closestOnTriangle(vertex, f.m_a, f.m_b, f.m_c);
    const int onFace = weights.x > 0.0f && weights.y > 0.0f && weights.z > 0.0f;
    const float miss = vec3Length(vec3Sub(vertex, featurePoint(f, weights)));
    if (miss > (onFace ? reach : DRAPE_SEAM * extent)) return 0;
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

// True when q, a point of the edge, sees the point nearer than the face beyond the edge does: their offset does not lean
// towards that face's third vertex.
DRAPE_FUNCTION int leansAway(Vec3 offset, Vec3 opposite, Vec3 q)
{
    const Vec3 inward = vec3Sub(opposite, q);
    return vec3Dot(offset, inward) <= DRAPE_SEAM * vec3Length(offset) * vec3Length(inward);
}

// Face moving from f0 to f1 against a resting vertex with the given normal cone. A vertex nearest to an edge of the face
// counts here too (weights with one zero); one nearest to a node is the node's contact. beyond: the third vertices of the
// neighbours over the face's three edges, at the step's end.
DRAPE_FUNCTION int faceVertexContact(FeatureTriangle f0, FeatureTriangle f1, FeatureTriangle beyond, Vec3 vertex,
                                     NormalCone cone, float reach, Contact* contact)
{
    const Vec3 area = triangleNormal(f1);
    const float areaLength = vec3Length(area);
    const float s0 = vec3Dot(triangleNormal(f0), vec3Sub(vertex, f0.m_a));
    const float s1 = vec3Dot(area, vec3Sub(vertex, f1.m_a));
    const float side = s0 < 0.0f ? -1.0f : 1.0f;
    const float extent = drapeMax(drapeMax(triangleExtent(f0), triangleExtent(f1)), vec3NormMax(vertex));
    if (side * s1 < 0.0f) return faceVertexPassed(f0, f1, vertex, s0, s1, side, extent, reach, contact);
    if (drapeAbs(s1) > areaLength * (reach * 1.001f + DRAPE_SEAM * extent)) return 0;

    const Vec3 weights = closestOnTriangle(vertex, f1.m_a, f1.m_b, f1.m_c);
    const int zeros = (weights.x == 0.0f) + (weights.y == 0.0f) + (weights.z == 0.0f);
    if (zeros == 2) return 0;
    const Vec3 point = featurePoint(f1, weights);
    const Vec3 offset = vec3Sub(point, vertex);
    const float distance = vec3Length(offset);
    const float lowFace = drapeMin(drapeMin(vec3Dot(offset, f1.m_a), vec3Dot(offset, f1.m_b)), vec3Dot(offset, f1.m_c));
    if (provenApart(offset, lowFace, vec3Dot(offset, vertex), extent, reach)) return 0;
    Vec3 normal = vec3Scale(area, -side * drapeRatio(1.0f, areaLength));
    if (distance > DRAPE_SEAM * extent && (zeros == 1 || areaLength == 0.0f))
    {
        normal = vec3Scale(offset, 1.0f / distance);
        const Vec3 opposite = weights.z == 0.0f ? beyond.m_a : weights.x == 0.0f ? beyond.m_b : beyond.m_c;
        if (!leansAway(vec3Scale(offset, -1.0f), opposite, point)) return 0;
    }
    else if (areaLength == 0.0f)
    {
        return 0;
    }
    if (!coneAdmits(cone, normal)) return 0;
    storeContact(contact, normal, vertex, weights, vec3Dot(normal, vec3Sub(featurePoint(f0, weights), vertex)),
                 vec3Dot(normal, offset), 1.0f);
    return 1;
}

DRAPE_FUNCTION FeatureEdge edgeMix(FeatureEdge e, FeatureEdge g, float t)
{
    FeatureEdge r;
    r.m_a = vec3Mix(e.m_a, g.m_a, t);
    r.m_b = vec3Mix(e.m_b, g.m_b, t);
    return r;
}

// Six times the signed volume of two edges; zero when they are coplanar.
DRAPE_FUNCTION float edgeEdgeVolume(FeatureEdge e, FeatureEdge o)
{
    return vec3Dot(vec3Cross(vec3Sub(e.m_b, e.m_a), vec3Sub(o.m_b, o.m_a)), vec3Sub(o.m_a, e.m_a));
}

// An edge that swept over the obstacle's edge. v0, v1: the volumes at the step's start and end, of opposite sign.
DRAPE_FUNCTION int edgeEdgePassed(FeatureEdge e0, FeatureEdge e1, FeatureEdge o, float v0, float v1, float extent,
                                  float reach, Contact* contact)
{
    const float side = v0 < 0.0f ? -1.0f : 1.0f;
    float low = 0.0f, high = 1.0f, time = 0.0f;
    for (int i = 0; i < 4; ++i)
    {
        time = low + (high - low) * (v0 / (v0 - v1));
        const float v = edgeEdgeVolume(edgeMix(e0, e1, time), o);
        if (side * v < 0.0f)
        {
            high = time;
            v1 = v;
        }
        else
        {
            low = time;
            v0 = v;
        }
        if (v0 == v1) break;
    }
    const FeatureEdge e = edgeMix(e0, e1, time);
    float s, t;
    closestOnSegments(e.m_a, e.m_b, o.m_a, o.m_b, &s, &t);
    const int inside = s > 0.0f && s < 1.0f && t > 0.0f && t < 1.0f;
    const Vec3 point = vec3Mix(o.m_a, o.m_b, t);
    const float miss = vec3Length(vec3Sub(vec3Mix(e.m_a, e.m_b, s), point));
    if (miss > (inside ? 0.1f * reach : DRAPE_SEAM * extent)) return 0;
    const Vec3 direction = vec3Cross(vec3Sub(e.m_b, e.m_a), vec3Sub(o.m_b, o.m_a));
    const float length = vec3Length(direction);
    if (length <= DRAPE_SEAM * vec3Length(vec3Sub(e.m_b, e.m_a)) * vec3Length(vec3Sub(o.m_b, o.m_a))) return 0;
    const Vec3 normal = vec3Scale(direction, -side / length);
    const float gap1 = vec3Dot(normal, vec3Sub(vec3Mix(e1.m_a, e1.m_b, s), point));
    storeContact(contact, normal, point, vec3(1.0f - s, s, 0.0f),
                 vec3Dot(normal, vec3Sub(vec3Mix(e0.m_a, e0.m_b, s), point)), gap1, time);
    return gap1 < reach;
}

// Edge moving from e0 to e1 against a resting edge with the given normal cone; both closest points inside their edges.
// oppositeA, oppositeB: third vertices of the cloth's two triangles at this edge, at the step's end.
DRAPE_FUNCTION int edgeEdgeContact(FeatureEdge e0, FeatureEdge e1, Vec3 oppositeA, Vec3 oppositeB, FeatureEdge o,
                                   NormalCone cone, float reach, Contact* contact)
{
    const Vec3 along = vec3Sub(o.m_b, o.m_a);
    const Vec3 direction = vec3Cross(vec3Sub(e1.m_b, e1.m_a), along);
    const float v0 = edgeEdgeVolume(e0, o);
    const float v1 = vec3Dot(direction, vec3Sub(o.m_a, e1.m_a));
    const float extent = drapeMax(drapeMax(drapeMax(vec3NormMax(e0.m_a), vec3NormMax(e0.m_b)),
                                           drapeMax(vec3NormMax(e1.m_a), vec3NormMax(e1.m_b))),
                                  drapeMax(vec3NormMax(o.m_a), vec3NormMax(o.m_b)));
    if ((v0 < 0.0f && v1 > 0.0f) || (v0 > 0.0f && v1 < 0.0f))
    {
        return edgeEdgePassed(e0, e1, o, v0, v1, extent, reach, contact);
    }
    const float squared = vec3Dot(direction, direction);
    const float length = drapeSqrt(squared);
    // Inside both edges the offset is parallel to the direction (or the edges are parallel, and it may be any).
    const int parallel = length <= DRAPE_SEAM * vec3Length(vec3Sub(e1.m_b, e1.m_a)) * vec3Length(along);
    if (!parallel && drapeAbs(vec3Dot(cone.m_axis, direction)) < cone.m_cosine * length) return 0;
    if (!parallel && drapeAbs(v1) > length * (reach * 1.001f + DRAPE_SEAM * extent)) return 0;
    float s, t;
    closestOnSegments(e1.m_a, e1.m_b, o.m_a, o.m_b, &s, &t);
    if (!(s > 0.0f && s < 1.0f && t > 0.0f && t < 1.0f)) return 0;
    const Vec3 point = vec3Mix(o.m_a, o.m_b, t);
    const Vec3 x1 = vec3Mix(e1.m_a, e1.m_b, s);
    const Vec3 offset = vec3Sub(x1, point);
    const float lowCloth = drapeMin(vec3Dot(offset, e1.m_a), vec3Dot(offset, e1.m_b));
    const float highObstacle = drapeMax(vec3Dot(offset, o.m_a), vec3Dot(offset, o.m_b));
    if (provenApart(offset, lowCloth, highObstacle, extent, reach)) return 0;
    const float distance = vec3Length(offset);
    Vec3 normal;
    if (distance > DRAPE_SEAM * extent)
    {
        normal = vec3Scale(offset, 1.0f / distance);
        const Vec3 toObstacle = vec3Scale(offset, -1.0f);
        if (!leansAway(toObstacle, oppositeA, x1) || !leansAway(toObstacle, oppositeB, x1)) return 0;
        if (parallel && !coneAdmits(cone, normal)) return 0;
    }
    else
    {
        if (parallel) return 0;  // touching along a line: the ends report it
        normal = vec3Scale(direction, (v0 < 0.0f ? 1.0f : -1.0f) / length);
    }
    storeContact(contact, normal, point, vec3(1.0f - s, s, 0.0f),
                 vec3Dot(normal, vec3Sub(vec3Mix(e0.m_a, e0.m_b, s), point)), vec3Dot(normal, offset), 1.0f);
    return 1;
}

DRAPE_NAMESPACE_END

#endif
