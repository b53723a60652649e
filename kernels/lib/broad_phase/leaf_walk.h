// Finds collisions of a mesh with itself: pairs of its triangles by a traversal of its hierarchy for every leaf, and
// their vertex-face and edge-edge pairs whose own volumes overlap. The traversal also serves two meshes.
//
// Every unordered pair of a mesh's own triangles is found from the leaf that comes first. Every feature has one owner
// among the triangles, so a pair of features is found once, in the pair of their owners. Features that share a vertex
// are left out.
#ifndef DRAPE_LIB_SELF_COLLISION_H
#define DRAPE_LIB_SELF_COLLISION_H

#include "../ccd/ccd.h"
#include "../geometry/dop.h"

DRAPE_NAMESPACE_BEGIN

// Pairs that a traversal returns.
#define DRAPE_WALK_OTHER 0u       // with every leaf of another mesh
#define DRAPE_WALK_SELF 1u        // with later leaves of the same mesh
#define DRAPE_WALK_SELF_APART 2u  // later leaves of the same mesh, without triangles that share a vertex

// One side of a walk. Leaves lie first among the nodes, one triangle each, in their order (see bvh_layout.h).
typedef struct WalkSide
{
    const DRAPE_GLOBAL BvhNode* m_nodes;
    const DRAPE_GLOBAL DRAPE_UINT* m_order;
    const DRAPE_GLOBAL Triangle* m_triangles;
} WalkSide;

typedef struct LeafWalk
{
    DRAPE_UINT m_stack[DRAPE_STACK_DEPTH];
    DRAPE_UINT m_depth;
    DRAPE_UINT m_leaf;
    DRAPE_UINT m_tooDeep;
} LeafWalk;

DRAPE_FUNCTION void leafWalkStart(LeafWalk* walk, DRAPE_UINT leaf, DRAPE_UINT root)
{
    walk->m_stack[0] = root;
    walk->m_depth = 1;
    walk->m_leaf = leaf;
    walk->m_tooDeep = 0;
}

DRAPE_FUNCTION int trianglesShareVertex(const DRAPE_GLOBAL Triangle* a, const DRAPE_GLOBAL Triangle* b)
{
    int shared = 0;
    for (int i = 0; i < 3; ++i)
    {
        const DRAPE_UINT v = a->m_vertices[i];
        shared |= (v == b->m_vertices[0]) | (v == b->m_vertices[1]) | (v == b->m_vertices[2]);
    }
    return shared;
}

// Advances to the next pair of the leaf of side a with a leaf of tree b whose volume overlaps. lastLeaf: the last leaf
// below each node of b; read for traversals of a mesh with itself. Returns whether there is one.
DRAPE_FUNCTION int leafWalkNext(LeafWalk* walk, const WalkSide* a, const WalkSide* b, DRAPE_UINT kind,
                                const DRAPE_GLOBAL DRAPE_UINT* lastLeaf, Candidate* pair)
{
    while (walk->m_depth > 0)
    {
        const DRAPE_UINT index = walk->m_stack[--walk->m_depth];
        const DRAPE_GLOBAL BvhNode* node = b->m_nodes + index;
        if (kind != DRAPE_WALK_OTHER && lastLeaf[index] <= walk->m_leaf) continue;
        if (!nodesOverlap(a->m_nodes + walk->m_leaf, node)) continue;
        if (node->m_count == 0)
        {
            pair->m_cloth = a->m_order[walk->m_leaf];
            pair->m_obstacle = b->m_order[index];
            if (kind == DRAPE_WALK_SELF_APART &&
                trianglesShareVertex(a->m_triangles + pair->m_cloth, b->m_triangles + pair->m_obstacle))
                continue;
            return 1;
        }
        if (walk->m_depth + node->m_count > DRAPE_STACK_DEPTH)
        {
            walk->m_tooDeep = 1;
            return 0;
        }
        for (DRAPE_UINT child = 0; child < node->m_count; ++child)
            walk->m_stack[walk->m_depth++] = node->m_first + child;
    }
    return 0;
}

// Computes the volume of a vertex over the step, grown by the radius (m, ≥ 0). Empty for an invalid vertex.
DRAPE_FUNCTION void vertexVolume(Dop* dop, const DRAPE_GLOBAL float* start, const DRAPE_GLOBAL float* end,
                                 DRAPE_UINT vertex, float radius)
{
    const Vec3 p0 = vec3Load(start, vertex), p1 = vec3Load(end, vertex);
    dopClear(dop);
    if (!positionIsValid(p0) || !positionIsValid(p1)) return;
    dopAddPoint(dop, p0, radius);
    dopAddPoint(dop, p1, radius);
}

// The one to three vertices of a vertex, edge or face; its volume merges theirs.
typedef struct FeatureVertices
{
    DRAPE_UINT m_vertices[3];
    int m_count;
} FeatureVertices;

DRAPE_FUNCTION void featureInterval(const DRAPE_GLOBAL Dop* volumes, const FeatureVertices* feature, int direction,
                                    float* low, float* high)
{
    *low = volumes[feature->m_vertices[0]].m_low[direction];
    *high = volumes[feature->m_vertices[0]].m_high[direction];
    for (int i = 1; i < feature->m_count; ++i)
    {
        *low = drapeMin(*low, volumes[feature->m_vertices[i]].m_low[direction]);
        *high = drapeMax(*high, volumes[feature->m_vertices[i]].m_high[direction]);
    }
}

DRAPE_FUNCTION int featureIsValid(const DRAPE_GLOBAL Dop* volumes, const FeatureVertices* feature)
{
    int valid = 1;
    for (int i = 0; i < feature->m_count; ++i)
        valid &= volumes[feature->m_vertices[i]].m_low[0] <= volumes[feature->m_vertices[i]].m_high[0];
    return valid;
}

// Returns whether the features are not proved apart and all vertices are valid.
DRAPE_FUNCTION int featuresOverlap(const DRAPE_GLOBAL Dop* volumes, const FeatureVertices* a, const FeatureVertices* b)
{
    if (!featureIsValid(volumes, a) || !featureIsValid(volumes, b)) return 0;
    for (int i = 0; i < DRAPE_DOP_DIRECTIONS; ++i)
    {
        float lowA, highA, lowB, highB;
        featureInterval(volumes, a, i, &lowA, &highA);
        featureInterval(volumes, b, i, &lowB, &highB);
        if (lowA > highB || lowB > highA) return 0;
    }
    return 1;
}

DRAPE_FUNCTION FeatureVertices edgeOf(const DRAPE_GLOBAL Triangle* triangle, int i)
{
    FeatureVertices edge;
    edge.m_vertices[0] = triangle->m_vertices[i];
    edge.m_vertices[1] = triangle->m_vertices[i == 2 ? 0 : i + 1];
    edge.m_vertices[2] = edge.m_vertices[1];
    edge.m_count = 2;
    return edge;
}

DRAPE_FUNCTION FeatureVertices faceOf(const DRAPE_GLOBAL Triangle* triangle)
{
    FeatureVertices face;
    for (int i = 0; i < 3; ++i)
        face.m_vertices[i] = triangle->m_vertices[i];
    face.m_count = 3;
    return face;
}

// Feature pairs that a pair of triangles owns: at most three vertices of each against the other's face, and nine
// pairs of edges.
typedef struct FeaturePairs
{
    FeaturePair m_vertexFace[6];
    FeaturePair m_edges[9];
    DRAPE_UINT m_vertexFaceCount;
    DRAPE_UINT m_edgesCount;
} FeaturePairs;

// Adds pairs of the vertices that triangle `owner` owns with the face of triangle `other`.
DRAPE_FUNCTION void addVertexFacePairs(FeaturePairs* pairs, const DRAPE_GLOBAL Triangle* triangles, DRAPE_UINT owner,
                                       DRAPE_UINT other, const DRAPE_GLOBAL Dop* volumes)
{
    const FeatureVertices face = faceOf(triangles + other);
    for (int i = 0; i < 3; ++i)
    {
        FeatureVertices vertex;
        const DRAPE_UINT v = triangles[owner].m_vertices[i];
        vertex.m_vertices[0] = vertex.m_vertices[1] = vertex.m_vertices[2] = v;
        vertex.m_count = 1;
        if (!(triangles[owner].m_owned & DRAPE_OWNS_VERTEX(i))) continue;
        if (v == face.m_vertices[0] || v == face.m_vertices[1] || v == face.m_vertices[2]) continue;
        if (!featuresOverlap(volumes, &vertex, &face)) continue;
        pairs->m_vertexFace[pairs->m_vertexFaceCount].m_a = v;
        pairs->m_vertexFace[pairs->m_vertexFaceCount++].m_b = other;
    }
}

DRAPE_FUNCTION void addEdgePairs(FeaturePairs* pairs, const DRAPE_GLOBAL Triangle* a, const DRAPE_GLOBAL Triangle* b,
                                 const DRAPE_GLOBAL Dop* volumes)
{
    for (int i = 0; i < 3; ++i)
    {
        const FeatureVertices first = edgeOf(a, i);
        if (!(a->m_owned & DRAPE_OWNS_EDGE(i))) continue;
        for (int j = 0; j < 3; ++j)
        {
            const FeatureVertices second = edgeOf(b, j);
            const int shared =
                (first.m_vertices[0] == second.m_vertices[0]) | (first.m_vertices[0] == second.m_vertices[1]) |
                (first.m_vertices[1] == second.m_vertices[0]) | (first.m_vertices[1] == second.m_vertices[1]);
            if (shared || !(b->m_owned & DRAPE_OWNS_EDGE(j))) continue;
            if (!featuresOverlap(volumes, &first, &second)) continue;
            // Keeps the same order whichever triangle comes first.
            pairs->m_edges[pairs->m_edgesCount].m_a = a->m_edges[i] < b->m_edges[j] ? a->m_edges[i] : b->m_edges[j];
            pairs->m_edges[pairs->m_edgesCount++].m_b = a->m_edges[i] < b->m_edges[j] ? b->m_edges[j] : a->m_edges[i];
        }
    }
}

DRAPE_FUNCTION void collectFeaturePairs(FeaturePairs* pairs, const DRAPE_GLOBAL Triangle* triangles, Candidate pair,
                                        const DRAPE_GLOBAL Dop* volumes)
{
    pairs->m_vertexFaceCount = 0;
    pairs->m_edgesCount = 0;
    addVertexFacePairs(pairs, triangles, pair.m_cloth, pair.m_obstacle, volumes);
    addVertexFacePairs(pairs, triangles, pair.m_obstacle, pair.m_cloth, volumes);
    addEdgePairs(pairs, triangles + pair.m_cloth, triangles + pair.m_obstacle, volumes);
}

DRAPE_FUNCTION CcdResult ccdOfVertices(DRAPE_UINT kind, const DRAPE_UINT vertices[4], const DRAPE_GLOBAL float* start,
                                       const DRAPE_GLOBAL float* end, CcdSettings settings)
{
    Vec3 p0[4], p1[4];
    for (int i = 0; i < 4; ++i)
    {
        p0[i] = vec3Load(start, vertices[i]);
        p1[i] = vec3Load(end, vertices[i]);
    }
    return ccdOfKind(kind, p0, p1, settings);
}

// Computes the four vertices of a pair of features, in the order of a CcdQuery.
DRAPE_FUNCTION void featurePairVertices(DRAPE_UINT kind, FeaturePair pair, const DRAPE_GLOBAL Triangle* triangles,
                                        const DRAPE_GLOBAL Edge* edges, DRAPE_UINT vertices[4])
{
    if (kind == DRAPE_VERTEX_FACE)
    {
        vertices[0] = pair.m_a;
        for (int i = 0; i < 3; ++i)
            vertices[1 + i] = triangles[pair.m_b].m_vertices[i];
        return;
    }
    vertices[0] = edges[pair.m_a].m_vertices[0];
    vertices[1] = edges[pair.m_a].m_vertices[1];
    vertices[2] = edges[pair.m_b].m_vertices[0];
    vertices[3] = edges[pair.m_b].m_vertices[1];
}

// Returns whether the pair touches during the step.
DRAPE_FUNCTION int featurePairHit(DRAPE_UINT kind, FeaturePair pair, const DRAPE_GLOBAL Triangle* triangles,
                                  const DRAPE_GLOBAL Edge* edges, const DRAPE_GLOBAL float* start,
                                  const DRAPE_GLOBAL float* end, CcdSettings settings, FeatureHit* hit)
{
    DRAPE_UINT vertices[4];
    featurePairVertices(kind, pair, triangles, edges, vertices);
    const CcdResult result = ccdOfVertices(kind, vertices, start, end, settings);
    hit->m_kind = kind;
    hit->m_a = pair.m_a;
    hit->m_b = pair.m_b;
    hit->m_time = result.m_time;
    return result.m_hit != 0u;
}

DRAPE_NAMESPACE_END

#endif
