// Contacts of feature pairs, from their positions in memory; feature_contact.h defines a contact.
//
// Contacts depend on the two features alone: however a pair of features is found, its numbers are equal. The frame's
// origin is the obstacle feature's first position.
#ifndef DRAPE_LIB_PAIR_CONTACT_H
#define DRAPE_LIB_PAIR_CONTACT_H

#include "edge_edge_contact.h"
#include "face_vertex_contact.h"
#include "../geometry/finite_corners.h"
#include "node_face_contact.h"
#include "../geometry/segment.h"
#include "../step_data/cloth_reads.h"

DRAPE_NAMESPACE_BEGIN

#define DRAPE_FEATURE_TESTS 15

// A position that is NaN or infinite, at the step's start or end, gives a gap that is not finite: no contact.
DRAPE_FUNCTION int finishContact(int found, Vec3 origin, Contact* contact)
{
    if (found != DRAPE_IS_CONTACT) return found;
    if (!drapeIsFinite(contact->m_gap0) || !drapeIsFinite(contact->m_gap1)) return DRAPE_NO_CONTACT;
    contact->m_point[0] += origin.x;
    contact->m_point[1] += origin.y;
    contact->m_point[2] += origin.z;
    return DRAPE_IS_CONTACT;
}

// Sets the features of a contact of the kind. cloth: node, triangle or edge.
DRAPE_FUNCTION void nameFeatures(Contact* contact, const ClothView* view, DRAPE_UINT kind, DRAPE_UINT cloth,
                                 DRAPE_UINT obstacle)
{
    contact->m_kind = kind;
    contact->m_clothFeature = cloth;
    contact->m_obstacleFeature = obstacle;
    contact->m_featureIndex = cloth + (kind == DRAPE_NODE_FACE ? 0u : view->m_nodeCount) +
                              (kind == DRAPE_EDGE_EDGE ? view->m_triangleCount : 0u);
}

// Tests node i of the cloth triangle against the obstacle's triangle with corners a, b, c.
DRAPE_FUNCTION int pairNodeFace(int i, const ClothView* cloth, DRAPE_UINT clothTriangle, Vec3 a, Vec3 b, Vec3 c,
                                const ObstacleView* obstacle, DRAPE_UINT obstacleTriangle, float reach,
                                Contact* contact)
{
    const DRAPE_UINT node = cloth->m_triangles[clothTriangle].m_vertices[i];
    const NodeFace pair = nodeFace(nodeStart(cloth, node), vec3Load(cloth->m_end, node), a, b, c, reach, cloth->m_mode,
                                   cloth->m_searches);
    nameFeatures(contact, cloth, DRAPE_NODE_FACE, node, obstacleTriangle);
    return finishContact(nodeFaceContact(&pair, obstacle, obstacleTriangle, contact), a, contact);
}

// Tests the cloth triangle against the obstacle's vertex.
DRAPE_FUNCTION int pairFaceVertex(const ClothView* cloth, DRAPE_UINT clothTriangle, Vec3 vertex, NormalCone cone,
                                  DRAPE_UINT obstacleVertex, float reach, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* triangle = cloth->m_triangles + clothTriangle;
    Vec3 start[3], end[3];
    for (int i = 0; i < 3; ++i)
    {
        start[i] = nodeStart(cloth, triangle->m_vertices[i]);
        end[i] = vec3Load(cloth->m_end, triangle->m_vertices[i]);
    }
    const MovingFace face = movingFace(start, end, vertex, vertex, reach, cloth->m_mode, cloth->m_searches);
    nameFeatures(contact, cloth, DRAPE_FACE_VERTEX, clothTriangle, obstacleVertex);
    const int found = faceVertexContact(&face, cone, cloth, triangle, vertex, contact);
    if (found == DRAPE_IS_CONTACT && isSegment(triangle)) joinCorners(contact->m_weights);
    return finishContact(found, vertex, contact);
}

// Tests edge i of the cloth triangle against the obstacle's edge from a to b. The owner of an edge traverses it in its
// own direction, so the weights are in the order of its nodes.
DRAPE_FUNCTION int pairEdgeEdge(int i, const ClothView* cloth, DRAPE_UINT clothTriangle, Vec3 a, Vec3 b,
                                NormalCone cone, DRAPE_UINT obstacleEdge, float reach, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* triangle = cloth->m_triangles + clothTriangle;
    const DRAPE_UINT first = triangle->m_vertices[i], second = triangle->m_vertices[i == 2 ? 0 : i + 1];
    const Vec3 start[4] = {nodeStart(cloth, first), nodeStart(cloth, second), a, b};
    const Vec3 end[4] = {vec3Load(cloth->m_end, first), vec3Load(cloth->m_end, second), a, b};
    const EdgePair pair = edgePair(start, end, reach, cloth->m_mode, cloth->m_searches);
    nameFeatures(contact, cloth, DRAPE_EDGE_EDGE, triangle->m_edges[i], obstacleEdge);
    return finishContact(edgeEdgeContact(&pair, cone, contact), a, contact);
}

// Returns the tests that a pair of triangles owns, as bits: three nodes × face, face × three vertices, three edges ×
// three edges. Each feature pair is tested only in the pair of triangles that own both features.
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

// Returns the tests without an invalid position, given the valid features of both triangles.
DRAPE_FUNCTION DRAPE_UINT validTests(DRAPE_UINT clothValid, DRAPE_UINT obstacleValid)
{
    DRAPE_UINT tests = ownedTests(clothValid, obstacleValid);
    if (obstacleValid != DRAPE_ALL_FEATURES) tests &= ~7u;      // node-face
    if (clothValid != DRAPE_ALL_FEATURES) tests &= ~(7u << 3);  // face-vertex
    return tests;
}

// Runs one of the candidate's feature tests, 0 ≤ test < DRAPE_FEATURE_TESTS. Returns DRAPE_NO_CONTACT, ….
DRAPE_FUNCTION int pairContact(int test, const ClothView* cloth, const ObstacleView* obstacle, Candidate candidate,
                               float reach, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* triangle = obstacle->m_triangles + candidate.m_obstacle;
    if (test < 3)
    {
        return pairNodeFace(test, cloth, candidate.m_cloth, vec3Load(obstacle->m_positions, triangle->m_vertices[0]),
                            vec3Load(obstacle->m_positions, triangle->m_vertices[1]),
                            vec3Load(obstacle->m_positions, triangle->m_vertices[2]), obstacle, candidate.m_obstacle,
                            reach, contact);
    }
    const int corner = test < 6 ? test - 3 : (test - 6) % 3;
    const DRAPE_UINT vertex = triangle->m_vertices[corner];
    const Vec3 a = vec3Load(obstacle->m_positions, vertex);
    if (test < 6)
    {
        return pairFaceVertex(cloth, candidate.m_cloth, a, obstacle->m_vertexCones[vertex], vertex, reach, contact);
    }
    const Vec3 b = vec3Load(obstacle->m_positions, triangle->m_vertices[corner == 2 ? 0 : corner + 1]);
    const DRAPE_UINT edge = triangle->m_edges[corner];
    return pairEdgeEdge((test - 6) / 3, cloth, candidate.m_cloth, a, b, obstacle->m_edgeCones[edge], edge, reach,
                        contact);
}

// The positions of a candidate, relative to the first vertex of the obstacle's triangle. Corners that are invalid are
// replaced (finite_corners.h); m_tests: those without an invalid position, as bits.
typedef struct PairTriangles
{
    FeatureTriangle m_start, m_end, m_resting;
    DRAPE_UINT m_tests;
} PairTriangles;

DRAPE_FUNCTION void loadPair(PairTriangles* pair, const ClothView* cloth, const ObstacleView* obstacle,
                             Candidate candidate)
{
    const DRAPE_GLOBAL Triangle* clothTriangle = cloth->m_triangles + candidate.m_cloth;
    const DRAPE_GLOBAL Triangle* obstacleTriangle = obstacle->m_triangles + candidate.m_obstacle;
    for (int i = 0; i < 3; ++i)
    {
        pair->m_start.m_p[i] = nodeStart(cloth, clothTriangle->m_vertices[i]);
        pair->m_end.m_p[i] = vec3Load(cloth->m_end, clothTriangle->m_vertices[i]);
        pair->m_resting.m_p[i] = vec3Load(obstacle->m_positions, obstacleTriangle->m_vertices[i]);
    }
    const DRAPE_UINT clothValid = replaceInvalidCorners(pair->m_start.m_p, pair->m_end.m_p);
    pair->m_tests = validTests(clothValid, replaceInvalidCorners(pair->m_resting.m_p, pair->m_resting.m_p));
    const Vec3 origin = pair->m_resting.m_p[0];
    for (int i = 0; i < 3; ++i)
    {
        pair->m_start.m_p[i] = vec3Sub(pair->m_start.m_p[i], origin);
        pair->m_end.m_p[i] = vec3Sub(pair->m_end.m_p[i], origin);
        pair->m_resting.m_p[i] = vec3Sub(pair->m_resting.m_p[i], origin);
    }
}

// Proves that a pair of triangles is out of reach by the planes of the two, where the cloth's is taken at the step's
// end. The slack is far above any rounding: a pair dropped here gives no contact. A plane proves nothing if its normal
// is too short for a float's full precision.
DRAPE_FUNCTION int pairApart(const PairTriangles* pair, float reach)
{
    const FeatureTriangle start = pair->m_start, end = pair->m_end, resting = pair->m_resting;
    const float extent = drapeMax(drapeMax(triangleExtent(start), triangleExtent(end)), triangleExtent(resting));
    const float slack = reach * 1.01f + 1e-3f * extent;
    const Vec3 normals[2] = {triangleNormal(resting), triangleNormal(end)};
    for (int k = 0; k < 2; ++k)
    {
        const Vec3 n = normals[k];
        float low = DRAPE_INFINITY, high = -DRAPE_INFINITY, lowResting = DRAPE_INFINITY, highResting = -DRAPE_INFINITY;
        for (int i = 0; i < 3; ++i)
        {
            const float s0 = vec3Dot(n, start.m_p[i]), s1 = vec3Dot(n, end.m_p[i]), r = vec3Dot(n, resting.m_p[i]);
            low = drapeMin(low, drapeMin(s0, s1));
            high = drapeMax(high, drapeMax(s0, s1));
            lowResting = drapeMin(lowResting, r);
            highResting = drapeMax(highResting, r);
        }
        const float gap = drapeMax(low - highResting, lowResting - high);
        const float length = areaLengthOf(n);
        if (length > 0.0f && gap > length * slack) return 1;
    }
    return 0;
}

// Returns the tests of a pair of triangles that may give a contact, as bits: none if the triangles are certainly apart.
DRAPE_FUNCTION DRAPE_UINT testsOfPair(const ClothView* cloth, const ObstacleView* obstacle, Candidate candidate,
                                      float reach)
{
    PairTriangles pair;
    loadPair(&pair, cloth, obstacle, candidate);
    if (pairApart(&pair, reach)) return 0;
    return pair.m_tests & ownedTests(cloth->m_triangles[candidate.m_cloth].m_owned,
                                     obstacle->m_triangles[candidate.m_obstacle].m_owned);
}

DRAPE_NAMESPACE_END

#endif
