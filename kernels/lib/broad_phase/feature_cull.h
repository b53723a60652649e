// Drops feature tests of one cloth triangle against a block of obstacle features, one per lane. The kept tests are a
// superset of those that give a contact (pair_contact.h), and little more.
//
// Every comparison is loosened by DRAPE_CULL_SLACK of the pair's size, some thousand roundings. A feature whose shape
// makes a direction worse than that (thin triangles, nearly parallel edges) is kept by its distance alone. Lanes with
// NaN positions are dropped: each result depends on a comparison of theirs that must be true.
//
// Positions are relative to m_origin and err by a rounding of their size. Directions come from differences before that
// shift, which would turn a short edge by as much over its length. The narrow phase has its own frame, which does turn
// features that are short compared with the pair: such features are kept by weaker tests.
#ifndef DRAPE_LIB_FEATURE_CULL_H
#define DRAPE_LIB_FEATURE_CULL_H

#include "../geometry/closest.h"
#include "../geometry/finite_corners.h"
#include "../geometry/rigid_motion.h"
#include "../work_items/lanes.h"
#include "cone_reach.h"

DRAPE_NAMESPACE_BEGIN

// Share of the pair's size by which distances are loosened. A unit normal of a triangle that is not thin errs by less.
#define DRAPE_CULL_SLACK 2e-4f
// A triangle whose doubled area is below this share of its longest edge squared is thin, edges whose directions have a
// sine below it are parallel. Then 3 roundings of a cross product turn it by less than 2e-5.
#define DRAPE_CULL_THIN 0.01f
// Maximum deviation of a contact's offset from the direction that the cones admit, as a share of the pair's size.
// Points on edges whose directions have a small sine s err by up to 3e-7 / s². The offset then errs by s times that.
// The maximum, 5.5e-4, is reached where the point errs by the length of the edge.
#define DRAPE_CULL_NOISE 1e-3f
// Distance of features that count as having met, as a share of the reach; see meetingSettings().
#define DRAPE_CULL_MET 0.02f
// A distance that excludes nothing, m.
#define DRAPE_CULL_ANYWHERE 1e15f

// A cloth triangle over the step relative to the obstacle and to m_origin.
typedef struct CullTriangle
{
    Vec3 m_origin;
    Vec3 m_start[3], m_end[3];  // m
    Vec3 m_normal0, m_normal1;  // unit normals at the step's start and end
    Vec3 m_inward[3];           // unit, in the plane at the end, from edge i to the inside
    Vec3 m_along[3];            // unit, along edge i at the end
    float m_edgeLength[3];      // m, at the end
    float m_height;             // m, the least altitude at the end
    Vec3 m_middle;              // m, of the corners at the end
    float m_radius;             // m, about m_middle
    float m_diameter;           // m, of all six positions
    float m_motion;             // m, of the fastest corner
    int m_thinStart, m_thinEnd;
} CullTriangle;

// Reach of a cull, m. m_slack: loosens every comparison. m_near: distance at the end. m_met: distance at the step's
// start and at its end of features that met in between, as far as the triangle moves. m_before: limit of the distance
// at the start: m_met, or DRAPE_CULL_ANYWHERE if every meeting must be found. m_farthest: the larger of m_near and
// m_met.
typedef struct CullReach
{
    float m_slack, m_near, m_met, m_before, m_farthest;
} CullReach;

// Limits as shares of the reach or of the pair's size, for a triangle's least altitude, or an edge's length times the
// sine between edges. Below them, rounding in the narrow phase's frame turns the feature by more than the cull's
// slack covers, or by so much that a point along it means nothing. The angles are 2 √3 u over the share: 1e-4 and
// 0.02.
#define DRAPE_CULL_SMALL 2.5e-3f
#define DRAPE_CULL_TURNED 2e-3f
#define DRAPE_CULL_SHORT 1e-5f

// height: m, the least altitude.
DRAPE_FUNCTION int cullNormal(const Vec3* p, Vec3* normal, float* height)
{
    const Vec3 e0 = vec3Sub(p[1], p[0]), e1 = vec3Sub(p[2], p[0]), e2 = vec3Sub(p[2], p[1]);
    const Vec3 area = vec3Cross(e0, e1);
    const float length = vec3Length(area);
    const float longest = drapeMax(drapeMax(vec3Dot(e0, e0), vec3Dot(e1, e1)), vec3Dot(e2, e2));
    *normal = vec3Scale(area, drapeRatio(1.0f, length));
    *height = drapeRatio(length, drapeSqrt(longest));
    return !(length > DRAPE_CULL_THIN * longest);
}

// Returns a triangle's normal as a cone, or every direction if its error may exceed the share that the cull's slack
// covers.
DRAPE_FUNCTION NormalCone faceCone(const Vec3* p)
{
    Vec3 normal;
    float height;
    const int thin = cullNormal(p, &normal, &height);
    const int sure = !thin && cornersSum(p) <= DRAPE_FARTHEST;
    return normalCone(normal, sure ? 1.0f : -1.0f);
}

// mode: DRAPE_DISCRETE …; a discrete step has no motion. motion: the obstacle's, null where it rests. Returns the
// triangle's features that are valid, bits as in Triangle::m_owned (see finite_corners.h).
DRAPE_FUNCTION DRAPE_UINT prepareCull(CullTriangle* cull, const DRAPE_GLOBAL float* start,
                                      const DRAPE_GLOBAL float* end, const DRAPE_GLOBAL Triangle* triangle,
                                      DRAPE_UINT mode, const DRAPE_GLOBAL ObstacleMotion* motion)
{
    for (int i = 0; i < 3; ++i)
    {
        cull->m_start[i] = startSeen(motion, vec3Load(start, triangle->m_vertices[i]));
        cull->m_end[i] = vec3Load(end, triangle->m_vertices[i]);
    }
    const DRAPE_UINT valid = replaceInvalidCorners(cull->m_start, cull->m_end);
    for (int i = 0; i < 3 && mode == DRAPE_DISCRETE; ++i)
        cull->m_start[i] = cull->m_end[i];
    cull->m_origin = cull->m_end[0];
    cull->m_diameter = cull->m_motion = 0.0f;
    cull->m_thinStart = cullNormal(cull->m_start, &cull->m_normal0, &cull->m_height);
    cull->m_thinEnd = cullNormal(cull->m_end, &cull->m_normal1, &cull->m_height);
    for (int i = 0; i < 3; ++i)
    {
        const Vec3 edge = vec3Sub(cull->m_end[i == 2 ? 0 : i + 1], cull->m_end[i]);
        cull->m_edgeLength[i] = vec3Length(edge);
        cull->m_diameter = drapeMax(cull->m_diameter, cull->m_edgeLength[i]);
        cull->m_along[i] = vec3Scale(edge, drapeRatio(1.0f, cull->m_edgeLength[i]));
        cull->m_inward[i] = vec3Cross(cull->m_normal1, cull->m_along[i]);
    }
    for (int i = 0; i < 3; ++i)
    {
        cull->m_start[i] = vec3Sub(cull->m_start[i], cull->m_origin);
        cull->m_end[i] = vec3Sub(cull->m_end[i], cull->m_origin);
        cull->m_motion = drapeMax(cull->m_motion, vec3Length(vec3Sub(cull->m_end[i], cull->m_start[i])));
    }
    cull->m_middle = vec3Scale(vec3Add(cull->m_end[1], cull->m_end[2]), 1.0f / 3.0f);
    cull->m_radius =
        drapeMax(vec3Length(cull->m_middle), drapeMax(vec3Length(vec3Sub(cull->m_end[1], cull->m_middle)),
                                                      vec3Length(vec3Sub(cull->m_end[2], cull->m_middle))));
    cull->m_motion *= 1.0f + DRAPE_CULL_SLACK;
    cull->m_diameter += 2.0f * cull->m_motion;
    return valid;
}

// size: m, of the block's features together.
DRAPE_FUNCTION CullReach cullReach(const DRAPE_GROUP_MEMORY CullTriangle* cull, float reach, float size,
                                   DRAPE_UINT mode)
{
    CullReach result;
    result.m_slack = DRAPE_CULL_SLACK * (cull->m_diameter + size + 2.0f * reach);
    result.m_near = reach * 1.001f + result.m_slack;
    result.m_met = cull->m_motion + result.m_slack;
    result.m_before = mode == DRAPE_CONTINUOUS ? DRAPE_CULL_ANYWHERE : result.m_met;
    result.m_farthest = drapeMax(result.m_near, result.m_met);
    return result;
}

// Selects faces of which a corner, an edge or the inside may be near the cloth triangle. Contacts in any direction
// have one reach; beside the face the reach is only as far as the features' cones admit the direction (see
// cone_reach.h). Faces with NaN corners are kept, since a corner may be valid.
DRAPE_FUNCTION LaneMask cullFaces(const DRAPE_GROUP_MEMORY CullTriangle* cull, CullReach reach,
                                  const DRAPE_GLOBAL float* block)
{
    const LanesVec3 a = lanesLoadVec3(block, 0), b = lanesLoadVec3(block, 3), c = lanesLoadVec3(block, 6);
    const LanesVec3 ab = lanesSub(b, a), bc = lanesSub(c, b), ca = lanesSub(a, c);
    const LanesVec3 area = lanesCross(ca, ab);
    const Lanes square = lanesDot(area, area);
    const Lanes longest = lanesMax(lanesMax(lanesDot(ab, ab), lanesDot(bc, bc)), lanesDot(ca, ca));
    // The distance from a corner to the middle is 2/3 of a median, which the longest edge bounds.
    const Lanes around = 0.66667f * lanesSqrt(longest) + (cull->m_radius + 5.0f * reach.m_slack);
    const LanesVec3 corner = lanesSubUniform(lanesSubUniform(a, cull->m_origin), cull->m_middle);
    const LanesVec3 offset =
        lanesVec3(corner.x + (ab.x - ca.x) * (1.0f / 3.0f), corner.y + (ab.y - ca.y) * (1.0f / 3.0f),
                  corner.z + (ab.z - ca.z) * (1.0f / 3.0f));
    const Lanes away = lanesDot(offset, offset);
    const Lanes far = around + reach.m_farthest, met = around + reach.m_met;
    // A direction whose tangent with the normal equals the spread extends sideways at most that share of its length.
    const Lanes wide = around + reach.m_near * lanesMin(lanesLoad(block, 9), lanesSplat(1.0f));
    const LanesVec3 side = lanesCross(offset, area);
    const LaneMask beside = (lanesDot(side, side) > wide * wide * square) & (away > met * met) &
                            (square > DRAPE_CULL_THIN * DRAPE_CULL_THIN * longest * longest);
    const int sure = !(cull->m_thinEnd || cull->m_height < DRAPE_CULL_SMALL * reach.m_near);
    return lanesNot((away > far * far) | (beside & lanesMaskSplat(sure)));
}

// Returns the vertices whose nearest point of the cloth triangle at the step's end is certainly a corner.
DRAPE_FUNCTION LaneMask cullAtNode(const DRAPE_GROUP_MEMORY CullTriangle* cull, LanesVec3 v, float slack)
{
    const Lanes place0 = lanesDotUniform(v, cull->m_along[0]);
    const Lanes place1 = lanesDotUniform(lanesSubUniform(v, cull->m_end[1]), cull->m_along[1]);
    const Lanes place2 = lanesDotUniform(lanesSubUniform(v, cull->m_end[2]), cull->m_along[2]);
    const Lanes before = lanesSplat(-slack);
    return ((place0 < before) & (place2 > lanesSplat(cull->m_edgeLength[2] + slack))) |
           ((place1 < before) & (place0 > lanesSplat(cull->m_edgeLength[0] + slack))) |
           ((place2 < before) & (place1 > lanesSplat(cull->m_edgeLength[1] + slack)));
}

// The cloth face against vertices.
DRAPE_FUNCTION LaneMask cullFaceVertex(const DRAPE_GROUP_MEMORY CullTriangle* cull, CullReach reach,
                                       const DRAPE_GLOBAL float* block)
{
    const LanesVec3 v = lanesSubUniform(lanesLoadVec3(block, 0), cull->m_origin);
    if (cull->m_thinEnd || cull->m_height < DRAPE_CULL_SMALL * reach.m_near)
    {
        const float far = reach.m_farthest + cull->m_diameter;
        return lanesDot(v, v) <= lanesSplat(far * far);
    }
    const LanesVec3 fromStart = lanesSubUniform(v, cull->m_start[0]);
    const Lanes height = lanesDotUniform(v, cull->m_normal1);
    const Lanes before = lanesDotUniform(fromStart, cull->m_normal0);
    const Lanes out0 = -lanesDotUniform(v, cull->m_inward[0]);
    const Lanes out1 = -lanesDotUniform(lanesSubUniform(v, cull->m_end[1]), cull->m_inward[1]);
    const Lanes out2 = -lanesDotUniform(v, cull->m_inward[2]);
    const Lanes most01 = lanesMax(out0, out1), least01 = lanesMin(out0, out1);
    const Lanes outside = lanesMax(most01, out2);
    const Lanes second = lanesMax(least01, lanesMin(most01, out2));
    const Lanes distance = lanesMax(outside, lanesSplat(0.0f));
    const Lanes depth = lanesAbs(height);
    const Lanes squared = distance * distance + depth * depth;

    // Tests the direction from the vertex to the nearest point, or close to it, against the vertex's cone.
    const LanesVec3 axis = lanesLoadVec3(block, 3);
    const Lanes cosine = lanesLoad(block, 6);
    const Lanes lean = lanesSelect(
        out2 >= most01, lanesDotUniform(axis, cull->m_inward[2]),
        lanesSelect(out1 >= out0, lanesDotUniform(axis, cull->m_inward[1]), lanesDotUniform(axis, cull->m_inward[0])));
    const Lanes facing = lanesAbs(height * lanesDotUniform(axis, cull->m_normal1) - distance * lean);
    const LaneMask admitted = facing + 4.0f * reach.m_slack >= cosine * lanesSqrt(squared);
    // A vertex nearest to a node is the node's contact. Otherwise a vertex outside of two edges, at an obtuse angle, is
    // nearest to either.
    const LaneMask atNode = cullAtNode(cull, v, reach.m_slack);
    const LaneMask direction = lanesNot(atNode) & (admitted | (second > lanesSplat(reach.m_slack)));
    const LaneMask near = direction & (squared <= lanesSplat(reach.m_near * reach.m_near));
    const LaneMask met = ((lanesAbs(before) <= lanesSplat(reach.m_before)) | lanesMaskSplat(cull->m_thinStart)) &
                         (squared <= lanesSplat(reach.m_met * reach.m_met));
    return near | met;
}

// Tests cloth node i against faces. Compares squares of distances times the face's area or edge, so that no lane needs
// a root.
DRAPE_FUNCTION LaneMask cullNodeFace(const DRAPE_GROUP_MEMORY CullTriangle* cull, int i, CullReach reach,
                                     const DRAPE_GLOBAL float* block)
{
    const LanesVec3 a = lanesLoadVec3(block, 0), b = lanesLoadVec3(block, 3), c = lanesLoadVec3(block, 6);
    const LanesVec3 corner = lanesSubUniform(a, cull->m_origin);
    const LanesVec3 x1 = lanesFromUniform(cull->m_end[i], corner), x0 = lanesFromUniform(cull->m_start[i], corner);
    const LanesVec3 ab = lanesSub(b, a), bc = lanesSub(c, b), ca = lanesSub(a, c);
    const Lanes squareAB = lanesDot(ab, ab), squareBC = lanesDot(bc, bc), squareCA = lanesDot(ca, ca);
    const Lanes longest = lanesMax(lanesMax(squareAB, squareBC), squareCA);
    const LanesVec3 area = lanesCross(ca, ab);
    const Lanes square = lanesDot(area, area);
    // (x + y)² ≤ 2 (x² + y²)
    const Lanes away = lanesDot(x1, x1);
    const LaneMask around = away <= 2.0f * (longest + reach.m_farthest * reach.m_farthest);
    // Thin, or so small that the products which place a node beside an edge, of |x1|² and the edge, err by 16 u.
    const LaneMask thin = (square <= DRAPE_CULL_THIN * DRAPE_CULL_THIN * longest * longest) |
                          (square * (reach.m_slack * reach.m_slack) <= 1e-12f * longest * away * away);

    const Lanes height = lanesDot(area, x1), before = lanesDot(area, x0);
    const Lanes depth = height * height;
    const LaneMask passed =
        (before * height <= 0.0f) | (lanesMin(depth, before * before) <= reach.m_slack * reach.m_slack * square);
    const LaneMask level = depth <= square * lanesSelect(passed, lanesSplat(reach.m_farthest * reach.m_farthest),
                                                         lanesSplat(reach.m_near * reach.m_near));
    // Maximum distance of the node outside an edge: as far as the edge's or a corner's cone still admits the
    // direction to it, or as far as it can have moved since it passed. Uses (x + y)² ≤ 1.1 x² + 11 y². A bounded
    // spread is less than 6, so that six times the height's rounding are within the slack. An unbounded spread says
    // nothing about the height: level with the face it may be nothing.
    const Lanes spread = lanesLoad(block, 9), most = square * (reach.m_near * reach.m_near);
    const Lanes slope =
        lanesSelect(spread < lanesSplat(DRAPE_ANY_SPREAD), lanesMin(depth * spread * spread, most), most);
    const Lanes moved = lanesSelect(passed, square * (reach.m_met * reach.m_met), lanesSplat(0.0f));
    const Lanes allowed = 1.1f * lanesMax(slope, moved) + 44.0f * reach.m_slack * reach.m_slack * square;
    const Lanes outAB = lanesMax(lanesDot(lanesCross(ab, area), x1), lanesSplat(0.0f));
    const Lanes outBC = lanesMax(lanesDot(lanesCross(bc, area), lanesSub(x1, ab)), lanesSplat(0.0f));
    const Lanes outCA = lanesMax(lanesDot(lanesCross(ca, area), x1), lanesSplat(0.0f));
    const LaneMask inside = (outAB * outAB <= allowed * squareAB) & (outBC * outBC <= allowed * squareBC) &
                            (outCA * outCA <= allowed * squareCA);
    return around & (thin | (level & inside));
}

// Values that the tests of a block of edges share.
typedef struct CullEdges
{
    LanesVec3 m_a, m_along, m_axis;
    Lanes m_cosine;  // cone's loosened cosine, squared with its sign
    Lanes m_length, m_square;
} CullEdges;

DRAPE_FUNCTION CullEdges loadCullEdges(const DRAPE_GROUP_MEMORY CullTriangle* cull, const DRAPE_GLOBAL float* block)
{
    CullEdges edges;
    edges.m_a = lanesSubUniform(lanesLoadVec3(block, 0), cull->m_origin);
    edges.m_along = lanesSub(lanesLoadVec3(block, 3), lanesLoadVec3(block, 0));
    edges.m_axis = lanesLoadVec3(block, 6);
    const Lanes cosine = lanesLoad(block, 9) - DRAPE_CULL_SLACK;
    edges.m_cosine = cosine * lanesAbs(cosine);
    edges.m_square = lanesDot(edges.m_along, edges.m_along);
    edges.m_length = lanesSqrt(edges.m_square);
    return edges;
}

// Cloth edge i against edges.
DRAPE_FUNCTION LaneMask cullEdgeEdge(const DRAPE_GROUP_MEMORY CullTriangle* cull, int i, CullReach reach,
                                     const CullEdges* edges)
{
    const int j = i == 2 ? 0 : i + 1;
    const float acrossLength = cull->m_edgeLength[i];
    const Vec3 across = vec3Scale(cull->m_along[i], acrossLength);
    const LanesVec3 along = edges->m_along, offset = lanesSubUniform(edges->m_a, cull->m_end[i]);
    const LanesVec3 direction = lanesCrossUniform(across, along);
    const Lanes square = lanesDot(direction, direction);
    const Lanes lengths = acrossLength * edges->m_length;

    const Lanes after = lanesDot(direction, offset);
    const LanesVec3 direction0 = lanesCrossUniform(vec3Sub(cull->m_start[j], cull->m_start[i]), along);
    const Lanes before = lanesDot(direction0, lanesSubUniform(edges->m_a, cull->m_start[i]));
    const LaneMask near = after * after <= square * lanesSplat(reach.m_near * reach.m_near);
    const LaneMask met = (after * after <= square * lanesSplat(reach.m_met * reach.m_met)) &
                         (lanesAbs(before) <= reach.m_before * lanesSqrt(lanesDot(direction0, direction0)) +
                                                  (0.1f * reach.m_slack) * lengths);
    const Lanes facing = lanesDot(edges->m_axis, direction);
    const LaneMask admitted = facing * facing >= edges->m_cosine * square;

    // Parameters of the two lines' closest points, times the square. They are loosened by rounding, which also turns
    // the cloth's edge as seen over the gap between the lines. If the edges may have met, they are also loosened by
    // the edges' possible motion since.
    const Lanes s = lanesDot(lanesCross(offset, along), direction);
    const Lanes t = lanesDot(lanesCrossUniform(across, offset), direction);
    const Lanes size = lanesNorm1(offset) + edges->m_length + cull->m_diameter;
    const Lanes loose = edges->m_length * (4e-6f * size * (acrossLength + reach.m_near) +
                                           lanesSelect(met, lanesSplat(reach.m_met * acrossLength), lanesSplat(0.0f)));
    const LaneMask inside =
        (lanesMin(s, square - s) >= -loose * edges->m_length) & (lanesMin(-t, square + t) >= -loose * acrossLength);

    // (x + y)² ≤ 2 (x² + y²)
    const float far = reach.m_farthest + acrossLength;
    const LaneMask around = lanesDot(offset, offset) <= 2.0f * (edges->m_square + far * far);
    const LaneMask parallel = square <= (DRAPE_CULL_THIN * DRAPE_CULL_THIN) * lengths * lengths;
    const Lanes noise = size * size * edges->m_square;
    const LaneMask turned = square <= (DRAPE_CULL_TURNED * DRAPE_CULL_TURNED) * noise;
    const LaneMask shorter = square <= (DRAPE_CULL_SHORT * DRAPE_CULL_SHORT) * noise;
    return around & (parallel | (shorter & near) | (inside & ((near & (admitted | turned)) | met)));
}

DRAPE_NAMESPACE_END

#endif
