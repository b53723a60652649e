// Decides whether two triangles of any meshes intersect, or come within a radius. For callers that need no contact:
// the pair is transformed into its own frame, by one of its vertices and a power of two. Neither the distance from
// the origin nor the unit of length then matters.
//
// Guarantee: a pair that truly intersects (is truly within the radius) is never rejected. A pair that misses by less
// than about 1e-6 of its extent (7e-5 for distances) may be reported. Pairs with positions that are not finite are
// rejected.
#ifndef DRAPE_LIB_TRIANGLE_PAIR_H
#define DRAPE_LIB_TRIANGLE_PAIR_H

#include "../../shared/query.h"
#include "../geometry/local_frame.h"
#include "triangle_triangle.h"

DRAPE_NAMESPACE_BEGIN

// Answers as bits.
#define DRAPE_PAIR_MEETS 1u
#define DRAPE_PAIR_NEAR 2u

typedef struct TrianglePair
{
    FeatureTriangle m_a, m_b;
    float m_scale;  // scale of the frame, prescale included
    float m_extent;
} TrianglePair;

// a, b: three corners each, in any frame. Returns whether all are finite.
DRAPE_FUNCTION int localPair(TrianglePair* pair, const Vec3 a[3], const Vec3 b[3])
{
    const Vec3 origin = vec3Prescaled(b[0]);
    int finite = 1;
    for (int i = 0; i < 3; ++i)
    {
        finite = finite && vec3IsFinite(a[i]) && vec3IsFinite(b[i]);
        pair->m_a.m_p[i] = vec3Sub(vec3Prescaled(a[i]), origin);
        pair->m_b.m_p[i] = vec3Sub(vec3Prescaled(b[i]), origin);
    }
    if (!finite) return 0;
    const float scale = localScale(drapeMax(triangleExtent(pair->m_a), triangleExtent(pair->m_b)));
    for (int i = 0; i < 3; ++i)
    {
        pair->m_a.m_p[i] = vec3Scale(pair->m_a.m_p[i], scale);
        pair->m_b.m_p[i] = vec3Scale(pair->m_b.m_p[i], scale);
    }
    pair->m_scale = scale * DRAPE_PRESCALE;
    pair->m_extent = drapeMax(triangleExtent(pair->m_a), triangleExtent(pair->m_b));
    return 1;
}

// Returns whether p and the face come within the bounds' reach, unless it is proved that they do not.
DRAPE_FUNCTION int vertexFaceNear(Vec3 p, FeatureTriangle face, PairBounds bounds)
{
    const Vec3 weights = closestOnTriangle(p, face.m_p[0], face.m_p[1], face.m_p[2]);
    const Vec3 n = vec3Sub(p, featurePoint(face, weights));
    const float high = drapeMax(drapeMax(vec3Dot(n, face.m_p[0]), vec3Dot(n, face.m_p[1])), vec3Dot(n, face.m_p[2]));
    return !provenApart(n, vec3Dot(n, p), high, bounds);
}

DRAPE_FUNCTION int edgeEdgeNear(FeatureEdge a, FeatureEdge b, PairBounds bounds)
{
    float s, t;
    closestOnSegments(a.m_a, a.m_b, b.m_a, b.m_b, &s, &t);
    const Vec3 n = vec3Sub(vec3Mix(a.m_a, a.m_b, s), vec3Mix(b.m_a, b.m_b, t));
    const float low = drapeMin(vec3Dot(n, a.m_a), vec3Dot(n, a.m_b));
    const float high = drapeMax(vec3Dot(n, b.m_a), vec3Dot(n, b.m_b));
    return !provenApart(n, low, high, bounds);
}

// Returns whether some vertex and face, or two edges, are within reach. Triangles that do not intersect are nearest
// there.
DRAPE_FUNCTION int featuresNear(const TrianglePair* pair, PairBounds bounds)
{
    for (int i = 0; i < 3; ++i)
    {
        if (vertexFaceNear(pair->m_a.m_p[i], pair->m_b, bounds)) return 1;
        if (vertexFaceNear(pair->m_b.m_p[i], pair->m_a, bounds)) return 1;
        const FeatureEdge edge = triangleEdge(&pair->m_a, i);
        for (int j = 0; j < 3; ++j)
        {
            if (edgeEdgeNear(edge, triangleEdge(&pair->m_b, j), bounds)) return 1;
        }
    }
    return 0;
}

// Returns DRAPE_PAIR_MEETS and DRAPE_PAIR_NEAR, for a radius in the corners' unit; without DRAPE_PAIR_NEAR for a
// negative one.
DRAPE_FUNCTION DRAPE_UINT trianglePairTest(const Vec3 a[3], const Vec3 b[3], float radius)
{
    TrianglePair pair;
    if (!localPair(&pair, a, b)) return 0u;
    const DRAPE_UINT meets = trianglesIntersect(pair.m_a, pair.m_b) ? DRAPE_PAIR_MEETS : 0u;
    if (radius < 0.0f) return meets;
    PairBounds bounds;
    bounds.m_extent = pair.m_extent;
    bounds.m_reach = radius * pair.m_scale;
    bounds.m_reachSlack = bounds.m_reach;
    return meets || featuresNear(&pair, bounds) ? meets | DRAPE_PAIR_NEAR : 0u;
}

// Answers for two triangles of meshes. A triangle with an invalid corner (positionIsValid) is in no pair: its volume
// is that of its other corners, so its pairs would be arbitrary.
DRAPE_FUNCTION PairAnswer trianglePairAnswer(Candidate pair, const DRAPE_GLOBAL float* positionsA,
                                             const DRAPE_GLOBAL Triangle* trianglesA,
                                             const DRAPE_GLOBAL float* positionsB,
                                             const DRAPE_GLOBAL Triangle* trianglesB, float radius)
{
    Vec3 a[3], b[3];
    int valid = 1;
    for (int i = 0; i < 3; ++i)
    {
        a[i] = vec3Load(positionsA, trianglesA[pair.m_cloth].m_vertices[i]);
        b[i] = vec3Load(positionsB, trianglesB[pair.m_obstacle].m_vertices[i]);
        valid = valid && positionIsValid(a[i]) && positionIsValid(b[i]);
    }
    PairAnswer answer;
    answer.m_a = pair.m_cloth;
    answer.m_b = pair.m_obstacle;
    answer.m_bits = valid ? trianglePairTest(a, b, radius) : 0u;
    return answer;
}

DRAPE_NAMESPACE_END

#endif
