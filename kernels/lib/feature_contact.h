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
    Vec3 m_p[3];
} FeatureTriangle;

typedef struct FeatureEdge
{
    Vec3 m_a, m_b;
} FeatureEdge;

// Edge i joins corners i and (i + 1) % 3.
DRAPE_FUNCTION FeatureEdge triangleEdge(const FeatureTriangle* f, int i)
{
    FeatureEdge e;
    e.m_a = f->m_p[i];
    e.m_b = f->m_p[i == 2 ? 0 : i + 1];
    return e;
}

// Boxes that do not meet, for points that can only meet at one instant. low/high hold the boxes' corners.
DRAPE_FUNCTION int boxesApart(Vec3 lowA, Vec3 highA, Vec3 lowB, Vec3 highB, float slack)
{
    return lowA.x - highB.x > slack || lowB.x - highA.x > slack || lowA.y - highB.y > slack ||
           lowB.y - highA.y > slack || lowA.z - highB.z > slack || lowB.z - highA.z > slack;
}

DRAPE_FUNCTION Vec3 vec3Least(Vec3 a, Vec3 b) { return vec3(drapeMin(a.x, b.x), drapeMin(a.y, b.y), drapeMin(a.z, b.z)); }
DRAPE_FUNCTION Vec3 vec3Most(Vec3 a, Vec3 b) { return vec3(drapeMax(a.x, b.x), drapeMax(a.y, b.y), drapeMax(a.z, b.z)); }

DRAPE_FUNCTION Vec3 triangleNormal(FeatureTriangle f) { return vec3Cross(vec3Sub(f.m_p[1], f.m_p[0]), vec3Sub(f.m_p[2], f.m_p[0])); }

DRAPE_FUNCTION FeatureTriangle triangleMix(FeatureTriangle f, FeatureTriangle g, float t)
{
    FeatureTriangle r;
    r.m_p[0] = vec3Mix(f.m_p[0], g.m_p[0], t);
    r.m_p[1] = vec3Mix(f.m_p[1], g.m_p[1], t);
    r.m_p[2] = vec3Mix(f.m_p[2], g.m_p[2], t);
    return r;
}

DRAPE_FUNCTION Vec3 featurePoint(FeatureTriangle f, Vec3 weights)
{
    return trianglePoint(f.m_p[0], f.m_p[1], f.m_p[2], weights);
}

DRAPE_FUNCTION float triangleExtent(FeatureTriangle f)
{
    return drapeMax(drapeMax(vec3NormMax(f.m_p[0]), vec3NormMax(f.m_p[1])), vec3NormMax(f.m_p[2]));
}

// A resting face with its area vector (twice the area, unit normal times length).
typedef struct RestingFace
{
    FeatureTriangle m_corners;
    Vec3 m_area;
    float m_areaLength;
} RestingFace;

// A moving face at the step's start and end.
typedef struct MovingFace
{
    FeatureTriangle m_start, m_end;
    Vec3 m_areaStart, m_areaEnd;
    float m_areaEndLength;
} MovingFace;

// Bounds common to a pair of triangles. extent: largest coordinate of all their positions, m. reach: m.
typedef struct PairBounds
{
    float m_extent;
    float m_reach;
    float m_reachSlack;  // reach grown by more than the rounding of a distance and its normal
} PairBounds;

// True when the support gap along n proves a distance above reach. lowA: least n·a over one set; highB: greatest n·b over
// the other. With u = 2^-24: three products, two sums and the frame's shift err by at
// most 12 u |n|₁ extent.
DRAPE_FUNCTION int provenApart(Vec3 n, float lowA, float highB, PairBounds bounds)
{
    const float twelveUnits = 7.1525574e-7f;
    const float gap = lowA - highB - twelveUnits * vec3Norm1(n) * bounds.m_extent - 1e-36f;
    return gap > bounds.m_reach * vec3Length(n) * (1.0f + twelveUnits);
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
DRAPE_FUNCTION int nodeFaceContact(Vec3 x0, Vec3 x1, const RestingFace* resting, const DRAPE_GLOBAL Triangle* triangle,
                                   const DRAPE_GLOBAL NormalCone* vertexCones,
                                   const DRAPE_GLOBAL NormalCone* edgeCones, PairBounds bounds, Contact* contact)
{
    const FeatureTriangle face = resting->m_corners;
    const float areaLength = resting->m_areaLength;
    const float s0 = vec3Dot(resting->m_area, vec3Sub(x0, face.m_p[0]));
    const float s1 = vec3Dot(resting->m_area, vec3Sub(x1, face.m_p[0]));
    const float side = s0 < 0.0f ? -1.0f : 1.0f;
    const int passed = side * s1 < 0.0f;
    // |s1| / |area| is a lower bound of the distance.
    if (!passed && drapeAbs(s1) > areaLength * bounds.m_reachSlack) return 0;
    Vec3 normal = vec3Scale(resting->m_area, side * drapeRatio(1.0f, areaLength));

    if (passed)  // the path went through the face's plane
    {
        const float time = s0 / (s0 - s1);
        const Vec3 hit = vec3Mix(x0, x1, time);
        const Vec3 weights = closestOnTriangle(hit, face.m_p[0], face.m_p[1], face.m_p[2]);
        const Vec3 point = featurePoint(face, weights);
        if (vec3Length(vec3Sub(hit, point)) > DRAPE_SEAM * bounds.m_extent) return 0;
        storeContact(contact, normal, point, vec3(1.0f, 0.0f, 0.0f), vec3Dot(normal, vec3Sub(x0, point)),
                     vec3Dot(normal, vec3Sub(x1, point)), time);
        return 1;
    }

    const Vec3 weights = closestOnTriangle(x1, face.m_p[0], face.m_p[1], face.m_p[2]);
    const Vec3 point = featurePoint(face, weights);
    const Vec3 offset = vec3Sub(x1, point);
    const float highFace =
        drapeMax(drapeMax(vec3Dot(offset, face.m_p[0]), vec3Dot(offset, face.m_p[1])), vec3Dot(offset, face.m_p[2]));
    if (provenApart(offset, vec3Dot(offset, x1), highFace, bounds)) return 0;
    const float distance = vec3Length(offset);
    const int onFace = weights.x > 0.0f && weights.y > 0.0f && weights.z > 0.0f;
    if (distance > DRAPE_SEAM * bounds.m_extent && (!onFace || areaLength == 0.0f))
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

// True when q, a point of the edge, sees the point nearer than the face beyond the edge does: their offset does not lean
// towards that face's third vertex.
DRAPE_FUNCTION int leansAway(Vec3 offset, Vec3 opposite, Vec3 q)
{
    const Vec3 inward = vec3Sub(opposite, q);
    return vec3Dot(offset, inward) <= DRAPE_SEAM * vec3Length(offset) * vec3Length(inward);
}

// Moving face against a resting vertex with the given normal cone. A vertex nearest to an edge of the face counts here too
// (weights with one zero); one nearest to a node is the node's contact. beyond: the third vertices of the neighbours over the
// face's three edges (m_a … m_c), into end, positions at the step's end; origin: of the local frame.
DRAPE_FUNCTION int faceVertexContact(const MovingFace* face, const DRAPE_UINT* beyond, const DRAPE_GLOBAL float* end,
                                     Vec3 origin, Vec3 vertex, NormalCone cone, PairBounds bounds, Contact* contact)
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
        const Vec3 opposite = vec3Sub(vec3Load(end, neighbour), origin);
        if (!leansAway(vec3Scale(offset, -1.0f), opposite, point)) return 0;
    }
    else if (areaLength == 0.0f)
    {
        return 0;
    }
    storeContact(contact, normal, vertex, weights, vec3Dot(normal, vec3Sub(featurePoint(f0, weights), vertex)),
                 vec3Dot(normal, offset), 1.0f);
    return 1;
}

DRAPE_FUNCTION FeatureEdge edgeMix(FeatureEdge from, FeatureEdge to, float t)
{
    FeatureEdge r;
    r.m_a = vec3Mix(from.m_a, to.m_a, t);
    r.m_b = vec3Mix(from.m_b, to.m_b, t);
    return r;
}

// Six times the signed volume of two edges; zero when they are coplanar.
DRAPE_FUNCTION float edgeEdgeVolume(FeatureEdge e, FeatureEdge o)
{
    return vec3Dot(vec3Cross(vec3Sub(e.m_b, e.m_a), vec3Sub(o.m_b, o.m_a)), vec3Sub(o.m_a, e.m_a));
}

// An edge that swept over the obstacle's edge. v0, v1: the volumes at the step's start and end, of opposite sign.
DRAPE_FUNCTION int edgeEdgePassed(FeatureEdge e0, FeatureEdge e1, FeatureEdge o, float v0, float v1, PairBounds bounds,
                                  Contact* contact)
{
    // Lines that become coplanar seldom belong to edges that meet.
    const Vec3 least = vec3Least(vec3Least(e0.m_a, e0.m_b), vec3Least(e1.m_a, e1.m_b));
    const Vec3 most = vec3Most(vec3Most(e0.m_a, e0.m_b), vec3Most(e1.m_a, e1.m_b));
    const float slack = 0.1f * bounds.m_reachSlack;
    if (boxesApart(least, most, vec3Least(o.m_a, o.m_b), vec3Most(o.m_a, o.m_b), slack)) return 0;

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
    if (miss > (inside ? 0.1f * bounds.m_reach : DRAPE_SEAM * bounds.m_extent)) return 0;
    const Vec3 direction = vec3Cross(vec3Sub(e.m_b, e.m_a), vec3Sub(o.m_b, o.m_a));
    const float length = vec3Length(direction);
    if (length <= DRAPE_SEAM * vec3Length(vec3Sub(e.m_b, e.m_a)) * vec3Length(vec3Sub(o.m_b, o.m_a))) return 0;
    const Vec3 normal = vec3Scale(direction, -side / length);
    const float gap1 = vec3Dot(normal, vec3Sub(vec3Mix(e1.m_a, e1.m_b, s), point));
    storeContact(contact, normal, point, vec3(1.0f - s, s, 0.0f),
                 vec3Dot(normal, vec3Sub(vec3Mix(e0.m_a, e0.m_b, s), point)), gap1, time);
    return gap1 < bounds.m_reach;
}

// Edge moving from e0 to e1 against a resting edge with the given normal cone; both closest points inside their edges.
// opposites: third vertices of the cloth's two triangles at this edge, into end, positions at the step's end; origin: of
// the local frame. The first comparisons drop most pairs and need neither division nor root.
DRAPE_FUNCTION int edgeEdgeContact(FeatureEdge e0, FeatureEdge e1, const DRAPE_UINT* opposites,
                                   const DRAPE_GLOBAL float* end, Vec3 origin, FeatureEdge o, NormalCone cone,
                                   PairBounds bounds, Contact* contact)
{
    const Vec3 along = vec3Sub(o.m_b, o.m_a);
    const Vec3 across = vec3Sub(e1.m_b, e1.m_a);
    const Vec3 direction = vec3Cross(across, along);
    const float v0 = edgeEdgeVolume(e0, o);
    const float v1 = vec3Dot(direction, vec3Sub(o.m_a, e1.m_a));
    if ((v0 < 0.0f && v1 > 0.0f) || (v0 > 0.0f && v1 < 0.0f)) return edgeEdgePassed(e0, e1, o, v0, v1, bounds, contact);
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
    Vec3 normal;
    if (distance > DRAPE_SEAM * bounds.m_extent)
    {
        normal = vec3Scale(offset, 1.0f / distance);
        const Vec3 toObstacle = vec3Scale(offset, -1.0f);
        for (int i = 0; i < 2; ++i)
        {
            if (!leansAway(toObstacle, vec3Sub(vec3Load(end, opposites[i]), origin), x1)) return 0;
        }
        if (parallel && !coneAdmits(cone, normal)) return 0;
    }
    else
    {
        if (parallel) return 0;  // touching along a line: the ends report it
        normal = vec3Scale(direction, (v0 < 0.0f ? 1.0f : -1.0f) / drapeSqrt(squared));
    }
    storeContact(contact, normal, point, vec3(1.0f - s, s, 0.0f),
                 vec3Dot(normal, vec3Sub(vec3Mix(e0.m_a, e0.m_b, s), point)), vec3Dot(normal, offset), 1.0f);
    return 1;
}

DRAPE_NAMESPACE_END

#endif
