// The fifteen feature tests of a candidate: three nodes × face, face × three vertices, three edges × three edges. Each
// feature pair is tested only in the pair of triangles that own both features.
#ifndef DRAPE_LIB_PAIR_CONTACT_H
#define DRAPE_LIB_PAIR_CONTACT_H

#include "contact_slot.h"
#include "feature_contact.h"

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

// The positions of one candidate, relative to the first vertex of the obstacle's triangle.
typedef struct PairGeometry
{
    Vec3 m_origin;
    Vec3 m_cloth0[3];
    Vec3 m_cloth1[3];
    Vec3 m_obstacle[3];
} PairGeometry;

DRAPE_FUNCTION void loadPair(PairGeometry* pair, const ClothView* cloth, const DRAPE_GLOBAL Triangle* clothTriangle,
                             const ObstacleView* obstacle, const DRAPE_GLOBAL Triangle* obstacleTriangle)
{
    pair->m_origin = vec3Load(obstacle->m_positions, obstacleTriangle->m_vertices[0]);
    for (int i = 0; i < 3; ++i)
    {
        const DRAPE_UINT node = clothTriangle->m_vertices[i];
        pair->m_cloth0[i] = vec3Sub(vec3Load(cloth->m_start, node), pair->m_origin);
        pair->m_cloth1[i] = vec3Sub(vec3Load(cloth->m_end, node), pair->m_origin);
        pair->m_obstacle[i] =
            vec3Sub(vec3Load(obstacle->m_positions, obstacleTriangle->m_vertices[i]), pair->m_origin);
    }
}

DRAPE_FUNCTION FeatureTriangle featureTriangle(const Vec3* p)
{
    FeatureTriangle f;
    f.m_a = p[0];
    f.m_b = p[1];
    f.m_c = p[2];
    return f;
}

DRAPE_FUNCTION FeatureEdge featureEdge(const Vec3* p, int i)
{
    FeatureEdge e;
    e.m_a = p[i];
    e.m_b = p[i == 2 ? 0 : i + 1];
    return e;
}

// Third vertex, at the step's end, of the triangle on the other side of edge i; the triangle's own at a boundary.
DRAPE_FUNCTION Vec3 clothBeyond(const PairGeometry* pair, const ClothView* cloth, const DRAPE_GLOBAL Triangle* triangle,
                                int i)
{
    const DRAPE_UINT own = triangle->m_vertices[i == 0 ? 2 : i - 1];
    const DRAPE_GLOBAL Edge* edge = cloth->m_edges + triangle->m_edges[i];
    const DRAPE_UINT other = edge->m_opposite[0] == own ? edge->m_opposite[1] : edge->m_opposite[0];
    return vec3Sub(vec3Load(cloth->m_end, other), pair->m_origin);
}

DRAPE_FUNCTION int pairNodeFace(int i, const PairGeometry* pair, const ClothView* cloth, const ObstacleView* obstacle,
                                Candidate candidate, float reach, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* triangle = cloth->m_triangles + candidate.m_cloth;
    if (!(triangle->m_owned & DRAPE_OWNS_VERTEX(i))) return 0;
    contact->m_kind = DRAPE_NODE_FACE;
    contact->m_clothFeature = triangle->m_vertices[i];
    contact->m_obstacleFeature = candidate.m_obstacle;
    contact->m_slot = contact->m_clothFeature;
    return nodeFaceContact(pair->m_cloth0[i], pair->m_cloth1[i], featureTriangle(pair->m_obstacle),
                           obstacle->m_triangles + candidate.m_obstacle, obstacle->m_vertexCones, obstacle->m_edgeCones,
                           reach, contact);
}

DRAPE_FUNCTION int pairFaceVertex(int i, const PairGeometry* pair, const ClothView* cloth, const ObstacleView* obstacle,
                                  Candidate candidate, float reach, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* clothTriangle = cloth->m_triangles + candidate.m_cloth;
    const DRAPE_GLOBAL Triangle* triangle = obstacle->m_triangles + candidate.m_obstacle;
    if (!(triangle->m_owned & DRAPE_OWNS_VERTEX(i))) return 0;
    FeatureTriangle beyond;
    beyond.m_a = clothBeyond(pair, cloth, clothTriangle, 0);
    beyond.m_b = clothBeyond(pair, cloth, clothTriangle, 1);
    beyond.m_c = clothBeyond(pair, cloth, clothTriangle, 2);
    contact->m_kind = DRAPE_FACE_VERTEX;
    contact->m_clothFeature = candidate.m_cloth;
    contact->m_obstacleFeature = triangle->m_vertices[i];
    contact->m_slot = cloth->m_nodeCount + contact->m_clothFeature;
    return faceVertexContact(featureTriangle(pair->m_cloth0), featureTriangle(pair->m_cloth1), beyond,
                             pair->m_obstacle[i], obstacle->m_vertexCones[triangle->m_vertices[i]], reach, contact);
}

DRAPE_FUNCTION int pairEdgeEdge(int i, int j, const PairGeometry* pair, const ClothView* cloth,
                                const ObstacleView* obstacle, Candidate candidate, float reach, Contact* contact)
{
    const DRAPE_GLOBAL Triangle* clothTriangle = cloth->m_triangles + candidate.m_cloth;
    const DRAPE_GLOBAL Triangle* triangle = obstacle->m_triangles + candidate.m_obstacle;
    if (!(clothTriangle->m_owned & DRAPE_OWNS_EDGE(i)) || !(triangle->m_owned & DRAPE_OWNS_EDGE(j))) return 0;
    const Vec3 own = pair->m_cloth1[i == 0 ? 2 : i - 1];
    contact->m_kind = DRAPE_EDGE_EDGE;
    contact->m_clothFeature = clothTriangle->m_edges[i];
    contact->m_obstacleFeature = triangle->m_edges[j];
    contact->m_slot = cloth->m_nodeCount + cloth->m_triangleCount + contact->m_clothFeature;
    return edgeEdgeContact(featureEdge(pair->m_cloth0, i), featureEdge(pair->m_cloth1, i), own,
                           clothBeyond(pair, cloth, clothTriangle, i), featureEdge(pair->m_obstacle, j),
                           obstacle->m_edgeCones[triangle->m_edges[j]], reach, contact);
}

// Makes the stored weights follow the cloth edge's own direction, which its owner may walk backwards.
DRAPE_FUNCTION void orientEdgeWeights(const ClothView* cloth, Candidate candidate, int i, Contact* contact)
{
    const DRAPE_GLOBAL Edge* edge = cloth->m_edges + contact->m_clothFeature;
    if (edge->m_vertices[0] == cloth->m_triangles[candidate.m_cloth].m_vertices[i]) return;
    const float first = contact->m_weights[0];
    contact->m_weights[0] = contact->m_weights[1];
    contact->m_weights[1] = first;
}

// Runs one of the candidate's feature tests, 0 ≤ test < DRAPE_FEATURE_TESTS. Returns whether it gives a contact; reach in m.
DRAPE_FUNCTION int pairContact(int test, const PairGeometry* pair, const ClothView* cloth, const ObstacleView* obstacle,
                               Candidate candidate, float reach, Contact* contact)
{
    int found;
    if (test < 3)
    {
        found = pairNodeFace(test, pair, cloth, obstacle, candidate, reach, contact);
    }
    else if (test < 6)
    {
        found = pairFaceVertex(test - 3, pair, cloth, obstacle, candidate, reach, contact);
    }
    else
    {
        const int i = (test - 6) / 3;
        found = pairEdgeEdge(i, (test - 6) % 3, pair, cloth, obstacle, candidate, reach, contact);
        if (found) orientEdgeWeights(cloth, candidate, i, contact);
    }
    if (!found || !drapeIsFinite(contact->m_gap1)) return 0;
    contact->m_point[0] += pair->m_origin.x;
    contact->m_point[1] += pair->m_origin.y;
    contact->m_point[2] += pair->m_origin.z;
    const Vec3 normal = vec3(contact->m_normal[0], contact->m_normal[1], contact->m_normal[2]);
    contact->m_slot = contact->m_slot * DRAPE_CONTACT_DIRECTIONS + contactDirection(normal);
    return 1;
}

DRAPE_NAMESPACE_END

#endif
