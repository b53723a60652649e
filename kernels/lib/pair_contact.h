// The fifteen feature tests of a candidate: three nodes × face, face × three vertices, three edges × three edges. Each
// feature pair is tested only in the pair of triangles that own both features.
#ifndef DRAPE_LIB_PAIR_CONTACT_H
#define DRAPE_LIB_PAIR_CONTACT_H

#include "dop.h"
#include "edge_edge_contact.h"
#include "face_vertex_contact.h"
#include "finite_corners.h"
#include "node_face_contact.h"

DRAPE_NAMESPACE_BEGIN

#define DRAPE_FEATURE_TESTS 15

typedef struct ClothView
{
    const DRAPE_GLOBAL float* m_start;  // m, x y z per node
    const DRAPE_GLOBAL float* m_end;
    const DRAPE_GLOBAL Triangle* m_triangles;
    const DRAPE_GLOBAL Edge* m_edges;
    DRAPE_UINT m_nodeCount;
    DRAPE_UINT m_triangleCount;
} ClothView;

typedef struct ObstacleView
{
    const DRAPE_GLOBAL float* m_positions;  // m, x y z per vertex
    const DRAPE_GLOBAL Triangle* m_triangles;
    const DRAPE_GLOBAL NormalCone* m_vertexCones;
    const DRAPE_GLOBAL NormalCone* m_edgeCones;
} ObstacleView;

// The positions of one candidate, relative to the first vertex of the obstacle's triangle, and what its tests share.
typedef struct PairGeometry
{
    Vec3 m_origin;
    MovingFace m_face;
    RestingFace m_resting;
    PairBounds m_bounds;
    DRAPE_UINT m_validTests;  // bits of those that may be run
} PairGeometry;

// The tests that this pair of triangles owns, as bits.
DRAPE_FUNCTION DRAPE_UINT ownedTests(DRAPE_UINT clothOwned, DRAPE_UINT obstacleOwned)
{
    const DRAPE_UINT obstacleEdges = obstacleOwned >> 3;
    DRAPE_UINT tests = (clothOwned & 7u) | ((obstacleOwned & 7u) << 3);
    for (int i = 0; i < 3; ++i)
    {
        if (clothOwned & DRAPE_OWNS_EDGE(i)) tests |= obstacleEdges << (6 + 3 * i);
    }
    return tests;
}

// The tests without a NaN or infinite position, given the valid features of both triangles.
DRAPE_FUNCTION DRAPE_UINT validTests(DRAPE_UINT clothValid, DRAPE_UINT obstacleValid)
{
    DRAPE_UINT tests = ownedTests(clothValid, obstacleValid);
    if (obstacleValid != DRAPE_ALL_FEATURES) tests &= ~7u;      // node-face
    if (clothValid != DRAPE_ALL_FEATURES) tests &= ~(7u << 3);  // face-vertex
    return tests;
}

DRAPE_FUNCTION void loadPair(PairGeometry* pair, const ClothView* cloth, const DRAPE_GLOBAL Triangle* clothTriangle,
                             const ObstacleView* obstacle, const DRAPE_GLOBAL Triangle* obstacleTriangle)
{
    Vec3* start = pair->m_face.m_start.m_p;
    Vec3* end = pair->m_face.m_end.m_p;
    Vec3* corners = pair->m_resting.m_corners.m_p;
    for (int i = 0; i < 3; ++i)
    {
        start[i] = vec3Load(cloth->m_start, clothTriangle->m_vertices[i]);
        end[i] = vec3Load(cloth->m_end, clothTriangle->m_vertices[i]);
        corners[i] = vec3Load(obstacle->m_positions, obstacleTriangle->m_vertices[i]);
    }
    const DRAPE_UINT clothValid = replaceInvalidCorners(start, end);
    const DRAPE_UINT obstacleValid = replaceInvalidCorners(corners, corners);
    pair->m_validTests = validTests(clothValid, obstacleValid);
    pair->m_origin = corners[0];
    for (int i = 0; i < 3; ++i)
    {
        start[i] = vec3Sub(start[i], pair->m_origin);
        end[i] = vec3Sub(end[i], pair->m_origin);
        corners[i] = vec3Sub(corners[i], pair->m_origin);
    }
}

// Least and greatest n·(p - base) over the candidate's cloth at the step's start and end.
DRAPE_FUNCTION void clothInterval(const PairGeometry* pair, Vec3 n, Vec3 base, float* low, float* high)
{
    *low = DRAPE_INFINITY;
    *high = -DRAPE_INFINITY;
    for (int i = 0; i < 3; ++i)
    {
        const float s0 = vec3Dot(n, vec3Sub(pair->m_face.m_start.m_p[i], base));
        const float s1 = vec3Dot(n, vec3Sub(pair->m_face.m_end.m_p[i], base));
        *low = drapeMin(*low, drapeMin(s0, s1));
        *high = drapeMax(*high, drapeMax(s0, s1));
    }
}

// Prepares the tests; returns false when the obstacle's or the cloth's plane proves the whole pair out of reach.
DRAPE_FUNCTION int preparePair(PairGeometry* pair, float reach)
{
    const FeatureTriangle resting = pair->m_resting.m_corners;
    const FeatureTriangle start = pair->m_face.m_start, end = pair->m_face.m_end;
    const float extent = drapeMax(drapeMax(triangleExtent(start), triangleExtent(end)), triangleExtent(resting));
    const float slack = reach * 1.001f + DRAPE_SEAM * extent;
    pair->m_bounds.m_extent = extent;
    pair->m_bounds.m_reach = reach;
    pair->m_bounds.m_reachSlack = slack;
    float low, high;

    const Vec3 area = triangleNormal(resting);
    const float areaLength = vec3Length(area);
    clothInterval(pair, area, resting.m_p[0], &low, &high);
    if (low > areaLength * slack || -high > areaLength * slack) return 0;

    const Vec3 endArea = triangleNormal(end);
    const float endLength = vec3Length(endArea);
    clothInterval(pair, endArea, end.m_p[0], &low, &high);
    const float d0 = vec3Dot(endArea, vec3Sub(resting.m_p[0], end.m_p[0]));
    const float d1 = vec3Dot(endArea, vec3Sub(resting.m_p[1], end.m_p[0]));
    const float d2 = vec3Dot(endArea, vec3Sub(resting.m_p[2], end.m_p[0]));
    if (drapeMin(drapeMin(d0, d1), d2) - high > endLength * slack) return 0;
    if (low - drapeMax(drapeMax(d0, d1), d2) > endLength * slack) return 0;

    pair->m_resting.m_area = area;
    pair->m_resting.m_areaLength = areaLength;
    pair->m_face.m_areaStart = triangleNormal(start);
    pair->m_face.m_areaEnd = endArea;
    pair->m_face.m_areaEndLength = endLength;
    return 1;
}

// Third vertex of the triangle on the other side of edge i; the triangle's own at a boundary.
DRAPE_FUNCTION DRAPE_UINT vertexBeyond(const ClothView* cloth, const DRAPE_GLOBAL Triangle* triangle, int i)
{
    const DRAPE_UINT own = triangle->m_vertices[i == 0 ? 2 : i - 1];
    const DRAPE_GLOBAL Edge* edge = cloth->m_edges + triangle->m_edges[i];
    return edge->m_opposite[0] == own ? edge->m_opposite[1] : edge->m_opposite[0];
}

DRAPE_FUNCTION int pairNodeFace(int i, const PairGeometry* pair, const ClothView* cloth, const ObstacleView* obstacle,
                                Candidate candidate, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* triangle = cloth->m_triangles + candidate.m_cloth;
    contact->m_kind = DRAPE_NODE_FACE;
    contact->m_clothFeature = triangle->m_vertices[i];
    contact->m_obstacleFeature = candidate.m_obstacle;
    contact->m_slot = contact->m_clothFeature;
    return nodeFaceContact(pair->m_face.m_start.m_p[i], pair->m_face.m_end.m_p[i], &pair->m_resting,
                           obstacle->m_triangles + candidate.m_obstacle, obstacle->m_vertexCones, obstacle->m_edgeCones,
                           pair->m_bounds, contact);
}

DRAPE_FUNCTION int pairFaceVertex(int i, const PairGeometry* pair, const ClothView* cloth, const ObstacleView* obstacle,
                                  Candidate candidate, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* clothTriangle = cloth->m_triangles + candidate.m_cloth;
    const DRAPE_GLOBAL Triangle* triangle = obstacle->m_triangles + candidate.m_obstacle;
    DRAPE_UINT beyond[3];
    for (int edge = 0; edge < 3; ++edge)
        beyond[edge] = vertexBeyond(cloth, clothTriangle, edge);
    contact->m_kind = DRAPE_FACE_VERTEX;
    contact->m_clothFeature = candidate.m_cloth;
    contact->m_obstacleFeature = triangle->m_vertices[i];
    contact->m_slot = cloth->m_nodeCount + contact->m_clothFeature;
    return faceVertexContact(&pair->m_face, beyond, cloth->m_start, cloth->m_end, pair->m_origin,
                             pair->m_resting.m_corners.m_p[i], obstacle->m_vertexCones[triangle->m_vertices[i]],
                             pair->m_bounds, contact);
}

DRAPE_FUNCTION int pairEdgeEdge(int i, int j, const PairGeometry* pair, const ClothView* cloth,
                                const ObstacleView* obstacle, Candidate candidate, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* clothTriangle = cloth->m_triangles + candidate.m_cloth;
    const DRAPE_GLOBAL Triangle* triangle = obstacle->m_triangles + candidate.m_obstacle;
    contact->m_kind = DRAPE_EDGE_EDGE;
    contact->m_clothFeature = clothTriangle->m_edges[i];
    contact->m_obstacleFeature = triangle->m_edges[j];
    contact->m_slot = cloth->m_nodeCount + cloth->m_triangleCount + contact->m_clothFeature;
    return edgeEdgeContact(triangleEdge(&pair->m_face.m_start, i), triangleEdge(&pair->m_face.m_end, i),
                           triangleEdge(&pair->m_resting.m_corners, j), obstacle->m_edgeCones[triangle->m_edges[j]],
                           pair->m_bounds, contact);
}

// Runs one of the candidate's feature tests, 0 ≤ test < DRAPE_FEATURE_TESTS. Returns whether it gives a contact.
DRAPE_FUNCTION int pairContact(int test, const PairGeometry* pair, const ClothView* cloth, const ObstacleView* obstacle,
                               Candidate candidate, Contact* contact)
{
    int found;
    if (!(pair->m_validTests & (1u << test))) return 0;
    if (test < 3)
    {
        found = pairNodeFace(test, pair, cloth, obstacle, candidate, contact);
    }
    else if (test < 6)
    {
        found = pairFaceVertex(test - 3, pair, cloth, obstacle, candidate, contact);
    }
    else
    {
        // The owner of an edge walks it in its own direction, so the weights are in the order of its nodes.
        found = pairEdgeEdge((test - 6) / 3, (test - 6) % 3, pair, cloth, obstacle, candidate, contact);
    }
    if (!found || !drapeIsFinite(contact->m_gap1)) return 0;
    contact->m_point[0] += pair->m_origin.x;
    contact->m_point[1] += pair->m_origin.y;
    contact->m_point[2] += pair->m_origin.z;
    return 1;
}

DRAPE_NAMESPACE_END

#endif
