// Contacts of a pair of triangles: the tests of the features that both own, and which of them may give a contact.
//
// Steps find pairs of features and need none of this. It serves tests, benchmarks and the study, which go by pairs of
// triangles. C++ and OpenCL C.
#ifndef DRAPE_REFERENCE_PAIR_TESTS_H
#define DRAPE_REFERENCE_PAIR_TESTS_H

#include "../kernels/lib/geometry/finite_corners.h"
#include "../kernels/lib/narrow_phase/pair_contact.h"

DRAPE_NAMESPACE_BEGIN

#define DRAPE_FEATURE_TESTS 15

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
