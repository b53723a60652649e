// Contacts of a cloth with itself: a node against a face, an edge against an edge, both moving linearly over the
// step.
//
// Candidates are feature pairs of one cloth that share no vertex and whose volumes over the step, grown by half the
// reach, overlap (leaf_walk.h). A candidate is a contact in two cases: (a) the features met during the step, or
// (b) they did not meet, are within reach at its end and are locally closest. The normal points from the second
// feature to the side from which the first came, or to its end if the two did not meet. Pairs are dropped for
// distance only on proof (provenApart).
//
// A pair's thickness is the cloth's, or half the pair's rest distance if that is less.
// docs/design_notes/contact_geometry.md gives the exact conditions and the frames.
#ifndef DRAPE_LIB_SELF_CONTACT_H
#define DRAPE_LIB_SELF_CONTACT_H

#include "../../shared/patch.h"
#include "../broad_phase/leaf_walk.h"
#include "../narrow_phase/edge_edge_contact.h"
#include "../narrow_phase/face_vertex_contact.h"
#include "../narrow_phase/pair_contact.h"

DRAPE_NAMESPACE_BEGIN

// Maximum thickness of a pair, as a share of its distance at rest.
#define DRAPE_REST_SHARE 0.5f

// A self test's kind, in FeatureTest::m_motion.
#define DRAPE_SELF_TEST_NODE 0u
#define DRAPE_SELF_TEST_EDGE 1u

// The cloth and its positions at rest, x y z per node, m. reachScale: contacts reach to thickness × reachScale.
typedef struct SelfView
{
    ClothView m_cloth;
    const DRAPE_GLOBAL float* m_rest;
    float m_reachScale;
} SelfView;

DRAPE_FUNCTION SelfView selfView(ClothView cloth, const DRAPE_GLOBAL float* rest, float reachScale)
{
    SelfView view;
    view.m_cloth = cloth;
    view.m_rest = rest;
    view.m_reachScale = reachScale;
    return view;
}

#include "../any_width/one.h"
#include "../any_width/self_pair.h"
#include "../any_width/end.h"

DRAPE_FUNCTION float restDistanceOfNode(const DRAPE_GLOBAL float* rest, DRAPE_UINT node,
                                        const DRAPE_GLOBAL DRAPE_UINT* corners)
{
    const Vec3 p = vec3Load(rest, node);
    FeatureTriangle f;
    int thin;
    for (int i = 0; i < 3; ++i)
        f.m_p[i] = vec3Sub(vec3Load(rest, corners[i]), p);
    return distanceToFace(f, &thin);
}

// Loads the ends of two edges.
DRAPE_FUNCTION void loadEdges(Vec3* ends, const DRAPE_GLOBAL float* positions, const DRAPE_GLOBAL DRAPE_UINT* first,
                              const DRAPE_GLOBAL DRAPE_UINT* second)
{
    for (int i = 0; i < 2; ++i)
    {
        ends[i] = vec3Load(positions, first[i]);
        ends[2 + i] = vec3Load(positions, second[i]);
    }
}

DRAPE_FUNCTION float restDistanceOfEdges(const DRAPE_GLOBAL float* rest, const DRAPE_GLOBAL DRAPE_UINT* first,
                                         const DRAPE_GLOBAL DRAPE_UINT* second)
{
    Vec3 ends[4];
    loadEdges(ends, rest, first, second);
    return distanceOfEdges(edgesFrom(ends));
}

// Returns whether the face beyond one of the edges on which the nearest point lies is nearer: the contact then
// belongs to that face. The frame is the node's, so the offset from the point to the node is its opposite.
DRAPE_FUNCTION int nearerBeyond(const ClothView* cloth, const DRAPE_GLOBAL Triangle* triangle, Vec3 node, Vec3 point,
                                Vec3 weights, float seam)
{
    const int away[3] = {weights.z == 0.0f, weights.x == 0.0f, weights.y == 0.0f};  // on edge i
    for (int i = 0; i < 3; ++i)
    {
        const DRAPE_UINT neighbour = vertexBeyond(cloth, triangle, i);
        const Vec3 end = vec3Load(cloth->m_end, neighbour);
        if (!away[i] || neighbour == triangle->m_vertices[i == 0 ? 2 : i - 1]) continue;
        if (!positionIsValid(end) || !positionIsValid(vec3Load(cloth->m_start, neighbour))) continue;
        if (!leansAway(vec3Scale(point, -1.0f), vec3Sub(end, node), point, seam)) return 1;
    }
    return 0;
}

// Stores the contact of a node near to a face, unless the face beyond is nearer. node: the origin of the frame.
DRAPE_FUNCTION int acceptSelfNode(const NearContact* near, const ClothView* cloth,
                                  const DRAPE_GLOBAL Triangle* triangle, Vec3 node, Contact* contact)
{
    if (near->m_asks && nearerBeyond(cloth, triangle, node, near->m_point, near->m_weights, near->m_seam))
        return DRAPE_NO_CONTACT;
    storeNear(near, near->m_point, near->m_weights, contact);
    return DRAPE_IS_CONTACT;
}

// Tests a node against a face of the same cloth. thickness: m, of the cloth.
DRAPE_FUNCTION int selfNodeFace(const SelfView* view, DRAPE_UINT node, DRAPE_UINT triangleIndex, float thickness,
                                Contact* contact)
{
    const ClothView* cloth = &view->m_cloth;
    const DRAPE_GLOBAL Triangle* triangle = cloth->m_triangles + triangleIndex;
    const Vec3 x0 = vec3Load(cloth->m_start, node), x1 = vec3Load(cloth->m_end, node);
    const float own = selfThickness(thickness, restDistanceOfNode(view->m_rest, node, triangle->m_vertices));
    Vec3 start[3], end[3];
    if (!(own > 0.0f)) return DRAPE_NO_CONTACT;
    for (int i = 0; i < 3; ++i)
    {
        start[i] = vec3Load(cloth->m_start, triangle->m_vertices[i]);
        end[i] = vec3Load(cloth->m_end, triangle->m_vertices[i]);
    }
    const MovingFace face = movingFace(start, end, x0, x1, own * view->m_reachScale, cloth->m_mode, cloth->m_searches);
    const NearestOfFace nearest = nearestOfFace(&face);
    NearContact near;
    int found = faceVertexPassed(&face, &nearest, contact);
    if (found == DRAPE_ASK_THE_END)
    {
        found = selfNodeNear(&face, &nearest, &near) ? acceptSelfNode(&near, cloth, triangle, x1, contact)
                                                     : DRAPE_NO_CONTACT;
    }
    else if (found == DRAPE_IS_CONTACT)
    {
        // Reverses the contact, which was found as the face's with the node.
        const Vec3 weights = vec3(contact->m_weights[0], contact->m_weights[1], contact->m_weights[2]);
        const Vec3 normal = vec3(-contact->m_normal[0], -contact->m_normal[1], -contact->m_normal[2]);
        storeContact(contact, normal, featurePoint(face.m_end, weights), weights, contact->m_gap0, contact->m_gap1,
                     contact->m_time);
    }
    return finishContact(found, x1, contact);
}

// Tests two edges of the same cloth, first < second. thickness: m, of the cloth.
DRAPE_FUNCTION int selfEdgeEdge(const SelfView* view, DRAPE_UINT first, DRAPE_UINT second, float thickness,
                                Contact* contact)
{
    const ClothView* cloth = &view->m_cloth;
    const DRAPE_GLOBAL DRAPE_UINT* e = cloth->m_edges[first].m_vertices;
    const DRAPE_GLOBAL DRAPE_UINT* o = cloth->m_edges[second].m_vertices;
    const float own = selfThickness(thickness, restDistanceOfEdges(view->m_rest, e, o));
    Vec3 start[4], end[4];
    if (!(own > 0.0f)) return DRAPE_NO_CONTACT;
    loadEdges(start, cloth->m_start, e, o);
    loadEdges(end, cloth->m_end, e, o);
    const EdgePair pair = edgePair(start, end, own * view->m_reachScale, cloth->m_mode, cloth->m_searches);
    NearContact near;
    int found = edgesPassed(&pair, 0, contact);
    if (found == DRAPE_ASK_THE_END)
    {
        found = selfEdgesNear(&pair, &near) ? DRAPE_IS_CONTACT : DRAPE_NO_CONTACT;
        if (found) storeNear(&near, near.m_point, near.m_weights, contact);
    }
    return finishContact(found, end[2], contact);
}

// Sets the features of a self test's contact. firstFeature: see featureCountOf().
DRAPE_FUNCTION void nameSelfFeatures(Contact* contact, const ClothView* cloth, FeatureTest test,
                                     DRAPE_UINT firstFeature)
{
    const int edges = test.m_motion == DRAPE_SELF_TEST_EDGE;
    contact->m_kind = edges ? DRAPE_SELF_EDGE_EDGE : DRAPE_SELF_NODE_FACE;
    contact->m_clothFeature = test.m_cloth;
    contact->m_obstacleFeature = test.m_lane;
    contact->m_featureIndex = firstFeature + featureIndexOf(edges ? DRAPE_EDGE_EDGE : DRAPE_NODE_FACE, test.m_cloth,
                                                            cloth->m_nodeCount, cloth->m_triangleCount);
}

// Runs a self test. Returns DRAPE_NO_CONTACT, ….
DRAPE_FUNCTION int selfContact(const SelfView* view, FeatureTest test, DRAPE_UINT firstFeature, Contact* contact)
{
    const int edges = test.m_motion == DRAPE_SELF_TEST_EDGE;
    nameSelfFeatures(contact, &view->m_cloth, test, firstFeature);
    return edges ? selfEdgeEdge(view, test.m_cloth, test.m_lane, test.m_reach, contact)
                 : selfNodeFace(view, test.m_cloth, test.m_lane, test.m_reach, contact);
}

DRAPE_NAMESPACE_END

#endif
