// Contacts of single features: a cloth node against an obstacle face, a cloth face against an obstacle vertex, a
// cloth edge against an obstacle edge. The cloth moves linearly over the step, the obstacle rests.
//
// A contact is reported in two cases: (a) the features met during the step, or (b) they did not meet, are within
// reach at the step's end and are locally closest. The normal points to the side from which the cloth's point came,
// or to its side at the end if the two did not meet. Pairs are dropped for distance only on proof (provenApart).
//
// Positions are in a local frame: the caller has subtracted a vertex of the obstacle's triangle.
// docs/design_notes/contact_geometry.md gives the exact conditions.
#ifndef DRAPE_LIB_FEATURE_CONTACT_H
#define DRAPE_LIB_FEATURE_CONTACT_H

#include "../shared/contact.h"
#include "../shared/mesh.h"
#include "face_area.h"

DRAPE_NAMESPACE_BEGIN

// Relative size of a distance at which its direction is rounding noise. Also the width of the seam between
// neighbouring features in which a path that hits both, or by rounding neither, counts as a hit.
#define DRAPE_SEAM 1e-5f

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

// Returns whether boxes do not meet, for points that can only meet at one instant. low/high: the boxes' corners.
DRAPE_FUNCTION int boxesApart(Vec3 lowA, Vec3 highA, Vec3 lowB, Vec3 highB, float slack)
{
    return lowA.x - highB.x > slack || lowB.x - highA.x > slack || lowA.y - highB.y > slack ||
           lowB.y - highA.y > slack || lowA.z - highB.z > slack || lowB.z - highA.z > slack;
}

DRAPE_FUNCTION Vec3 vec3Least(Vec3 a, Vec3 b)
{
    return vec3(drapeMin(a.x, b.x), drapeMin(a.y, b.y), drapeMin(a.z, b.z));
}
DRAPE_FUNCTION Vec3 vec3Most(Vec3 a, Vec3 b)
{
    return vec3(drapeMax(a.x, b.x), drapeMax(a.y, b.y), drapeMax(a.z, b.z));
}

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

typedef struct RestingFace
{
    FeatureTriangle m_corners;
    FaceArea m_area;
} RestingFace;

// A moving face at the step's start and end.
typedef struct MovingFace
{
    FeatureTriangle m_start, m_end;
    Vec3 m_areaStart;  // computed by triangleNormal()
    FaceArea m_areaEnd;
} MovingFace;

// Bounds common to a pair of triangles. extent: largest coordinate of all their positions, m. reach: m.
typedef struct PairBounds
{
    float m_extent;
    float m_reach;
    float m_reachSlack;  // reach grown by more than the rounding of a distance and its normal
    DRAPE_UINT m_mode;   // DRAPE_DISCRETE …
    // Counts the pairs for which the continuous test was needed and run; null: it must not run.
    DRAPE_UINT* m_searches;
} PairBounds;

// Results of a feature test: no contact, a contact, or undecided because only the continuous test can decide and must
// not run.
#define DRAPE_NO_CONTACT 0
#define DRAPE_IS_CONTACT 1
#define DRAPE_UNDECIDED 2

// Returns whether the support gap along n proves a distance above the reach. lowA: least n·a over one set; highB:
// greatest n·b over the other. With u = 2^-24, three products, two sums and the frame's shift err by at most 12 u |n|₁
// extent.
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

// Returns whether q, a point of the edge, is nearer to the point than the face beyond the edge. Their offset must not
// lean towards that face's third vertex by more than the seam's width, m.
DRAPE_FUNCTION int leansAway(Vec3 offset, Vec3 opposite, Vec3 q, float seam)
{
    const Vec3 inward = vec3Sub(opposite, q);
    return vec3Dot(offset, inward) <= seam * vec3Length(inward);
}

DRAPE_NAMESPACE_END

#endif
