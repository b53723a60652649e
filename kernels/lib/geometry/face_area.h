// Computes the area vector of a face and its closest point to a position, for thin faces too.
//
// The cross product of two edges of length L turns by up to 2 u L² / area, u = 2^-24, and a closest point computed
// from such products slides along the face as far. A thin face therefore uses its longest edge and the third corner's
// offset from it. Their cross product errs by 3 u only, and a height over the face's plane by a few u of the pair's
// extent. If that offset itself is rounding noise, the face has no side and acts as its three edges.
#ifndef DRAPE_LIB_FACE_AREA_H
#define DRAPE_LIB_FACE_AREA_H

#include "closest.h"

DRAPE_NAMESPACE_BEGIN

// A face whose doubled area is below this share of the squares of its first and last edge is thin. Above it a plane
// errs by u over the share, 3e-6 of the extent, less than DRAPE_SEAM.
#define DRAPE_THIN 0.02f
// Height of a thin face, as a share of its largest coordinate, that is noise: 8 u. Each corner errs by u.
#define DRAPE_THIN_NOISE 4.8e-7f

#include "../any_width/one.h"
#include "../any_width/face.h"
#include "../any_width/end.h"

// A face by its longest edge, from the end that is nearer to the third corner. No variable indexes the corners: on a
// GPU that would move them out of the registers.
typedef struct LongFace
{
    int m_turn;     // the corner at which the edge begins in the face's order
    int m_swapped;  // true if the third corner is nearer to the edge's other end
    Vec3 m_near;    // m, that end
    Vec3 m_along;   // from there to the edge's far end
    Vec3 m_side;    // from there to the third corner
    float m_place;  // the third corner's position along the edge, as a fraction of it
    Vec3 m_rise;    // the third corner's offset from the edge; 0 where it is noise
} LongFace;

DRAPE_FUNCTION Vec3 vec3Choose(int i, Vec3 first, Vec3 second, Vec3 third)
{
    if (i == 0) return first;
    return i == 1 ? second : third;
}

DRAPE_FUNCTION float partAlong(Vec3 offset, Vec3 edge)
{
    return drapeRatio(vec3Dot(offset, edge), vec3Dot(edge, edge));
}

DRAPE_FUNCTION LongFace longFace(FeatureTriangle f)
{
    LongFace face;
    const Vec3 ab = vec3Sub(f.m_p[1], f.m_p[0]), bc = vec3Sub(f.m_p[2], f.m_p[1]), ca = vec3Sub(f.m_p[0], f.m_p[2]);
    const float squareAB = vec3Dot(ab, ab), squareBC = vec3Dot(bc, bc), squareCA = vec3Dot(ca, ca);
    face.m_turn = squareBC > squareAB ? 1 : 0;
    if (squareCA > drapeMax(squareAB, squareBC)) face.m_turn = 2;
    const Vec3 begin = vec3Choose(face.m_turn, f.m_p[0], f.m_p[1], f.m_p[2]);
    const Vec3 end = vec3Choose(face.m_turn, f.m_p[1], f.m_p[2], f.m_p[0]);
    const Vec3 third = vec3Choose(face.m_turn, f.m_p[2], f.m_p[0], f.m_p[1]);
    const Vec3 toBegin = vec3Sub(begin, third), toEnd = vec3Sub(end, third);
    face.m_swapped = vec3Dot(toEnd, toEnd) < vec3Dot(toBegin, toBegin);
    face.m_near = face.m_swapped ? end : begin;
    face.m_along = vec3Sub(face.m_swapped ? begin : end, face.m_near);
    face.m_side = vec3Sub(third, face.m_near);
    face.m_place = partAlong(face.m_side, face.m_along);
    face.m_rise = vec3AddScaled(face.m_side, face.m_along, -face.m_place);
    if (vec3NormMax(face.m_rise) <= DRAPE_THIN_NOISE * triangleExtent(f)) face.m_rise = vec3(0.0f, 0.0f, 0.0f);
    return face;
}

DRAPE_COLD_FUNCTION Vec3 thinArea(FeatureTriangle f)
{
    const LongFace face = longFace(f);
    return face.m_swapped ? vec3Cross(face.m_rise, face.m_along) : vec3Cross(face.m_along, face.m_rise);
}

DRAPE_FUNCTION FaceArea faceArea(FeatureTriangle f)
{
    FaceArea area = plainArea(f);
    if (area.m_thin)
    {
        area.m_vector = thinArea(f);
        area.m_length = areaLengthOf(area.m_vector);
    }
    return area;
}

// The best of several points of a face.
typedef struct NearPoint
{
    float m_square;  // squared distance, m²
    Vec3 m_weights;
} NearPoint;

// Tests the closest point on the edge from a to b, whose corners' weights are the unit vectors unitA and unitB.
DRAPE_FUNCTION void tryEdge(NearPoint* best, Vec3 p, Vec3 a, Vec3 b, Vec3 unitA, Vec3 unitB)
{
    const Vec3 edge = vec3Sub(b, a), toPoint = vec3Sub(p, a);
    const float place = drapeClamp01(partAlong(toPoint, edge));
    const Vec3 offset = place == 1.0f ? vec3Sub(p, b) : vec3AddScaled(toPoint, edge, -place);
    const float square = vec3Dot(offset, offset);
    if (!(square < best->m_square)) return;
    best->m_square = square;
    best->m_weights = vec3AddScaled(vec3Scale(unitA, 1.0f - place), unitB, place);
}

// Computes closestOnTriangle() for a thin face: the nearest of the closest points on the edges and of the foot
// inside.
DRAPE_COLD_FUNCTION Vec3 closestOnThin(Vec3 p, FeatureTriangle f)
{
    const Vec3 x = vec3(1.0f, 0.0f, 0.0f), y = vec3(0.0f, 1.0f, 0.0f), z = vec3(0.0f, 0.0f, 1.0f);
    NearPoint best;
    best.m_square = 1.0f / 0.0f;
    best.m_weights = x;
    tryEdge(&best, p, f.m_p[0], f.m_p[1], x, y);
    tryEdge(&best, p, f.m_p[1], f.m_p[2], y, z);
    tryEdge(&best, p, f.m_p[2], f.m_p[0], z, x);

    const LongFace face = longFace(f);
    const Vec3 toPoint = vec3Sub(p, face.m_near);
    const float place = partAlong(toPoint, face.m_along);
    const float third = partAlong(vec3AddScaled(toPoint, face.m_along, -place), face.m_rise);
    const float far = place - third * face.m_place;
    const float near = 1.0f - third - far;
    if (!(third > 0.0f && far > 0.0f && near > 0.0f)) return best.m_weights;
    const Vec3 offset = vec3AddScaled(vec3AddScaled(toPoint, face.m_along, -far), face.m_side, -third);
    if (vec3Dot(offset, offset) > best.m_square) return best.m_weights;
    const float begin = face.m_swapped ? far : near, end = face.m_swapped ? near : far;
    return vec3Choose(face.m_turn, vec3(begin, end, third), vec3(third, begin, end), vec3(end, third, begin));
}

// Returns weights as closestOnTriangle() does. thin: see faceArea().
DRAPE_FUNCTION Vec3 closestOnFace(Vec3 p, FeatureTriangle f, int thin)
{
    return thin ? closestOnThin(p, f) : closestOnTriangle(p, f.m_p[0], f.m_p[1], f.m_p[2]);
}

DRAPE_NAMESPACE_END

#endif
