// Contacts of a cloth with itself: a node against a face, an edge against an edge, both moving linearly over the
// step.
//
// Candidates are feature pairs of one cloth that share no vertex and whose volumes over the step, grown by half the
// reach, overlap (self_collision.h). A candidate is a contact in two cases: (a) the features met during the step, or
// (b) they did not meet, are within reach at its end and are locally closest. The normal points from the second
// feature to the side from which the first came, or to its end if the two did not meet. Pairs are dropped for
// distance only on proof (provenApart).
//
// A pair's thickness is the cloth's, or half the pair's rest distance if that is less.
// docs/design_notes/contact_geometry.md gives the exact conditions and the frames.
#ifndef DRAPE_LIB_SELF_CONTACT_H
#define DRAPE_LIB_SELF_CONTACT_H

#include "../shared/patch.h"
#include "edge_edge_contact.h"
#include "face_vertex_contact.h"
#include "pair_contact.h"
#include "self_collision.h"

DRAPE_NAMESPACE_BEGIN

// Maximum thickness of a pair, as a share of its distance at rest.
#define DRAPE_REST_SHARE 0.5f

// A self test's kind in FeatureTest::m_motion; its features are in m_cloth and m_lane, the cloth's thickness (m) in
// m_reach.
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

// Slots of self contacts follow all slots of the cloths' contacts with obstacles.
DRAPE_FUNCTION DRAPE_UINT firstSelfSlot(DRAPE_UINT nodes, DRAPE_UINT triangles, DRAPE_UINT edges)
{
    return nodes + triangles + edges;
}

DRAPE_FUNCTION float restDistanceOfNode(const DRAPE_GLOBAL float* rest, DRAPE_UINT node,
                                        const DRAPE_GLOBAL DRAPE_UINT* corners)
{
    const Vec3 p = vec3Load(rest, node);
    FeatureTriangle f;
    for (int i = 0; i < 3; ++i)
        f.m_p[i] = vec3Sub(vec3Load(rest, corners[i]), p);
    const Vec3 origin = vec3(0.0f, 0.0f, 0.0f);
    return vec3Length(featurePoint(f, closestOnFace(origin, f, isThin(f, vec3Length(triangleNormal(f))))));
}

DRAPE_FUNCTION float restDistanceOfEdges(const DRAPE_GLOBAL float* rest, const DRAPE_GLOBAL DRAPE_UINT* first,
                                         const DRAPE_GLOBAL DRAPE_UINT* second)
{
    const Vec3 origin = vec3Load(rest, second[0]), o = vec3(0.0f, 0.0f, 0.0f);
    const Vec3 a = vec3Sub(vec3Load(rest, first[0]), origin), b = vec3Sub(vec3Load(rest, first[1]), origin);
    const Vec3 end = vec3Sub(vec3Load(rest, second[1]), origin);
    float s, t;
    closestOnSegments(a, b, o, end, &s, &t);
    return vec3Length(vec3Sub(vec3Mix(a, b, s), vec3Mix(o, end, t)));
}

// Returns the pair's thickness, m; 0 for features that touch at rest.
DRAPE_FUNCTION float selfThickness(float thickness, float restDistance)
{
    return drapeMin(thickness, DRAPE_REST_SHARE * restDistance);
}

DRAPE_FUNCTION void selfStore(Contact* contact, Vec3 normal, Vec3 point, Vec3 weights, Vec3 before, Vec3 after,
                              float time)
{
    storeContact(contact, normal, point, weights, vec3Dot(normal, before), vec3Dot(normal, after), time);
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

// Tests a node at rest in the frame's origin against a moving face at the step's end. side: the node's side at the
// start, +1 in front of the face.
DRAPE_FUNCTION int selfNodeNear(const ClothView* cloth, const DRAPE_GLOBAL Triangle* triangle, const MovingFace* face,
                                Vec3 node, float side, PairBounds bounds, Contact* contact)
{
    const FeatureTriangle f = face->m_end;
    const FaceArea area = face->m_areaEnd;
    const Vec3 origin = vec3(0.0f, 0.0f, 0.0f);
    const float height = -vec3Dot(area.m_vector, f.m_p[0]);
    if (drapeAbs(height) > area.m_length * bounds.m_reachSlack) return DRAPE_NO_CONTACT;
    const Vec3 weights = closestOnFace(origin, f, area.m_thin);
    const Vec3 point = featurePoint(f, weights), offset = vec3Scale(point, -1.0f);
    const float most =
        drapeMax(drapeMax(vec3Dot(offset, f.m_p[0]), vec3Dot(offset, f.m_p[1])), vec3Dot(offset, f.m_p[2]));
    if (provenApart(offset, 0.0f, most, bounds)) return DRAPE_NO_CONTACT;
    const float distance = vec3Length(point);
    if (pointIsOutOfReach(distance, origin, &f, bounds)) return DRAPE_NO_CONTACT;
    const int inside = weights.x > 0.0f && weights.y > 0.0f && weights.z > 0.0f;
    Vec3 normal;
    if (distance > DRAPE_SEAM * bounds.m_extent)
    {
        const float seam = area.m_thin ? DRAPE_SEAM * bounds.m_extent + 5e-4f * distance : DRAPE_SEAM * distance;
        if (!inside && nearerBeyond(cloth, triangle, node, point, weights, seam)) return DRAPE_NO_CONTACT;
        side = height < 0.0f ? -1.0f : 1.0f;
        normal = inside && !area.m_thin ? vec3Scale(area.m_vector, side * drapeRatio(1.0f, area.m_length))
                                        : vec3Direction(offset, distance);
    }
    else
    {
        if (area.m_length == 0.0f) return DRAPE_NO_CONTACT;  // without a direction: its neighbours report it
        normal = vec3Scale(area.m_vector, side / area.m_length);
    }
    selfStore(contact, normal, point, weights, vec3Scale(featurePoint(face->m_start, weights), -1.0f), offset, 1.0f);
    return DRAPE_IS_CONTACT;
}

// Tests a node against a face of the same cloth. thickness: m, of the cloth.
DRAPE_FUNCTION int selfNodeFace(const SelfView* view, DRAPE_UINT node, DRAPE_UINT triangleIndex, float thickness,
                                Contact* contact)
{
    const ClothView* cloth = &view->m_cloth;
    const DRAPE_GLOBAL Triangle* triangle = cloth->m_triangles + triangleIndex;
    const float own = selfThickness(thickness, restDistanceOfNode(view->m_rest, node, triangle->m_vertices));
    const Vec3 x0 = vec3Load(cloth->m_start, node), x1 = vec3Load(cloth->m_end, node);
    const Vec3 origin = vec3(0.0f, 0.0f, 0.0f);
    MovingFace face;
    if (!(own > 0.0f)) return DRAPE_NO_CONTACT;
    for (int i = 0; i < 3; ++i)
    {
        face.m_start.m_p[i] = vec3Sub(vec3Load(cloth->m_start, triangle->m_vertices[i]), x0);
        face.m_end.m_p[i] = vec3Sub(vec3Load(cloth->m_end, triangle->m_vertices[i]), x1);
    }
    face.m_areaStart = triangleNormal(face.m_start);
    face.m_areaEnd = faceArea(face.m_end);
    const float s0 = -vec3Dot(face.m_areaStart, face.m_start.m_p[0]);
    const float s1 = -vec3Dot(face.m_areaEnd.m_vector, face.m_end.m_p[0]);
    const PairBounds bounds = pairBounds(
        cloth, stepExtent(cloth, triangleExtent(face.m_start), triangleExtent(face.m_end)), own * view->m_reachScale);
    const float side = (cloth->m_mode == DRAPE_DISCRETE ? s1 : s0) < 0.0f ? -1.0f : 1.0f;
    int found = DRAPE_ASK_THE_END;
    if (cloth->m_mode != DRAPE_DISCRETE) found = faceVertexPassed(&face, origin, s0, s1, bounds, contact);
    if (found == DRAPE_ASK_THE_END)
    {
        found = selfNodeNear(cloth, triangle, &face, x1, side, bounds, contact);
    }
    else if (found == DRAPE_IS_CONTACT)
    {
        // Reverses the contact, which was found as the face's with the node.
        const Vec3 weights = vec3(contact->m_weights[0], contact->m_weights[1], contact->m_weights[2]);
        const Vec3 normal = vec3(-contact->m_normal[0], -contact->m_normal[1], -contact->m_normal[2]);
        const Vec3 before = featurePoint(face.m_start, weights), after = featurePoint(face.m_end, weights);
        selfStore(contact, normal, after, weights, vec3Scale(before, -1.0f), vec3Scale(after, -1.0f), contact->m_time);
    }
    return finishContact(found, x1, contact);
}

// Two edges over the step, in the frame of the second one's first end.
typedef struct EdgePair
{
    FeatureEdge m_e0, m_e1, m_o0, m_o1;
    float m_v0, m_v1;  // six times the signed volumes at the step's start and end
} EdgePair;

// Returns the offset from the second edge to the first, at parameters s and t.
DRAPE_FUNCTION Vec3 edgeOffset(FeatureEdge e, FeatureEdge o, float s, float t)
{
    return vec3Sub(vec3Mix(e.m_a, e.m_b, s), vec3Mix(o.m_a, o.m_b, t));
}

DRAPE_FUNCTION int selfEdgesMet(const EdgePair* pair, Meeting meeting, PairBounds bounds, Contact* contact)
{
    const FeatureEdge e = edgeMix(pair->m_e0, pair->m_e1, meeting.m_place);
    const FeatureEdge o = edgeMix(pair->m_o0, pair->m_o1, meeting.m_place);
    float s, t;
    closestOnSegments(e.m_a, e.m_b, o.m_a, o.m_b, &s, &t);
    const Vec3 across = vec3Sub(e.m_b, e.m_a), along = vec3Sub(o.m_b, o.m_a);
    const Vec3 direction = vec3Cross(across, along);
    const float length = vec3Length(direction);
    if (length <= DRAPE_SEAM * vec3Length(across) * vec3Length(along)) return DRAPE_NO_CONTACT;
    const Vec3 before = edgeOffset(pair->m_e0, pair->m_o0, s, t), after = edgeOffset(pair->m_e1, pair->m_o1, s, t);
    const Vec3 normal =
        meetingNormal(direction, length, vec3Sub(after, before), pair->m_v0 < 0.0f ? 1.0f : -1.0f, bounds);
    selfStore(contact, normal, vec3Mix(pair->m_o1.m_a, pair->m_o1.m_b, t), vec3(s, t, 0.0f), before, after,
              meeting.m_time);
    return DRAPE_IS_CONTACT;
}

// Two edges at the step's end. For parallel edges an end is as near as any other point, and belongs to the node's
// contact.
DRAPE_FUNCTION int selfEdgesNear(const EdgePair* pair, PairBounds bounds, Contact* contact)
{
    const FeatureEdge e = pair->m_e1, o = pair->m_o1;
    const Vec3 across = vec3Sub(e.m_b, e.m_a), along = vec3Sub(o.m_b, o.m_a);
    const Vec3 direction = vec3Cross(across, along);
    const float squared = vec3Dot(direction, direction);
    const float v1 = pair->m_v1;
    if (squared <= DRAPE_SEAM * DRAPE_SEAM * vec3Dot(across, across) * vec3Dot(along, along)) return DRAPE_NO_CONTACT;
    if (v1 * v1 > squared * (bounds.m_reachSlack * bounds.m_reachSlack)) return DRAPE_NO_CONTACT;
    float s, t;
    closestOnSegments(e.m_a, e.m_b, o.m_a, o.m_b, &s, &t);
    if (!(s > 0.0f && s < 1.0f && t > 0.0f && t < 1.0f)) return DRAPE_NO_CONTACT;
    const Vec3 offset = edgeOffset(e, o, s, t);
    const float low = drapeMin(vec3Dot(offset, e.m_a), vec3Dot(offset, e.m_b));
    const float high = drapeMax(vec3Dot(offset, o.m_a), vec3Dot(offset, o.m_b));
    if (provenApart(offset, low, high, bounds)) return DRAPE_NO_CONTACT;
    const float distance = vec3Length(offset);
    if (edgesAreOutOfReach(distance, e, o, bounds)) return DRAPE_NO_CONTACT;
    const float before = bounds.m_mode == DRAPE_DISCRETE ? v1 : pair->m_v0;
    const Vec3 normal = distance > DRAPE_SEAM * bounds.m_extent
                            ? vec3Direction(offset, distance)
                            : vec3Scale(vec3Direction(direction, drapeSqrt(squared)), before < 0.0f ? 1.0f : -1.0f);
    selfStore(contact, normal, vec3Mix(o.m_a, o.m_b, t), vec3(s, t, 0.0f), edgeOffset(pair->m_e0, pair->m_o0, s, t),
              offset, 1.0f);
    return DRAPE_IS_CONTACT;
}

DRAPE_FUNCTION int edgesPassedOrNear(const EdgePair* pair, PairBounds bounds, Contact* contact)
{
    if (bounds.m_mode != DRAPE_DISCRETE)
    {
        const float motion = edgeMotion(pair->m_e0, pair->m_e1) + edgeMotion(pair->m_o0, pair->m_o1);
        const int known =
            edgesNearness(pair->m_e0, pair->m_e1, pair->m_o0, pair->m_o1, motion, pair->m_v0, pair->m_v1, bounds);
        if (asksForMeeting(known, bounds))
        {
            if (!bounds.m_searches) return DRAPE_UNDECIDED;
            ++*bounds.m_searches;
            const Vec3 start[4] = {pair->m_e0.m_a, pair->m_e0.m_b, pair->m_o0.m_a, pair->m_o0.m_b};
            const Vec3 end[4] = {pair->m_e1.m_a, pair->m_e1.m_b, pair->m_o1.m_a, pair->m_o1.m_b};
            const Meeting meeting = meetFeatures(DRAPE_EDGES, start, end, motion, bounds);
            if (meeting.m_met && known == DRAPE_MAY_MEET)
            {
                if (selfEdgesMet(pair, meeting, bounds, contact)) return DRAPE_IS_CONTACT;
                if (edgesChangedSides(pair->m_v0, pair->m_v1)) return DRAPE_NO_CONTACT;
            }
        }
    }
    return selfEdgesNear(pair, bounds, contact);
}

DRAPE_FUNCTION FeatureEdge edgeSeen(const DRAPE_GLOBAL float* positions, const DRAPE_GLOBAL Edge* edge, Vec3 origin)
{
    FeatureEdge e;
    e.m_a = vec3Sub(vec3Load(positions, edge->m_vertices[0]), origin);
    e.m_b = vec3Sub(vec3Load(positions, edge->m_vertices[1]), origin);
    return e;
}

DRAPE_FUNCTION float edgeExtent(FeatureEdge e)
{
    return drapeMax(vec3NormMax(e.m_a), vec3NormMax(e.m_b));
}

// Tests two edges of the same cloth, first < second. thickness: m, of the cloth.
DRAPE_FUNCTION int selfEdgeEdge(const SelfView* view, DRAPE_UINT first, DRAPE_UINT second, float thickness,
                                Contact* contact)
{
    const ClothView* cloth = &view->m_cloth;
    const DRAPE_GLOBAL Edge* e = cloth->m_edges + first;
    const DRAPE_GLOBAL Edge* o = cloth->m_edges + second;
    const float own = selfThickness(thickness, restDistanceOfEdges(view->m_rest, e->m_vertices, o->m_vertices));
    const Vec3 origin0 = vec3Load(cloth->m_start, o->m_vertices[0]), origin1 = vec3Load(cloth->m_end, o->m_vertices[0]);
    EdgePair pair;
    if (!(own > 0.0f)) return DRAPE_NO_CONTACT;
    pair.m_e0 = edgeSeen(cloth->m_start, e, origin0);
    pair.m_e1 = edgeSeen(cloth->m_end, e, origin1);
    pair.m_o0 = edgeSeen(cloth->m_start, o, origin0);
    pair.m_o1 = edgeSeen(cloth->m_end, o, origin1);
    pair.m_v0 = edgeEdgeVolume(pair.m_e0, pair.m_o0);
    pair.m_v1 = edgeEdgeVolume(pair.m_e1, pair.m_o1);
    const float extent = stepExtent(cloth, drapeMax(edgeExtent(pair.m_e0), edgeExtent(pair.m_o0)),
                                    drapeMax(edgeExtent(pair.m_e1), edgeExtent(pair.m_o1)));
    return finishContact(edgesPassedOrNear(&pair, pairBounds(cloth, extent, own * view->m_reachScale), contact),
                         origin1, contact);
}

// Sets the features of a self test's contact. firstSlot: firstSelfSlot().
DRAPE_FUNCTION void nameSelfFeatures(Contact* contact, const ClothView* cloth, FeatureTest test, DRAPE_UINT firstSlot)
{
    const int edges = test.m_motion == DRAPE_SELF_TEST_EDGE;
    contact->m_kind = edges ? DRAPE_SELF_EDGE_EDGE : DRAPE_SELF_NODE_FACE;
    contact->m_clothFeature = test.m_cloth;
    contact->m_obstacleFeature = test.m_lane;
    contact->m_slot = firstSlot + test.m_cloth + (edges ? cloth->m_nodeCount + cloth->m_triangleCount : 0u);
}

// Runs a self test. Returns DRAPE_NO_CONTACT, ….
DRAPE_FUNCTION int selfContact(const SelfView* view, FeatureTest test, DRAPE_UINT firstSlot, Contact* contact)
{
    const int edges = test.m_motion == DRAPE_SELF_TEST_EDGE;
    nameSelfFeatures(contact, &view->m_cloth, test, firstSlot);
    return edges ? selfEdgeEdge(view, test.m_cloth, test.m_lane, test.m_reach, contact)
                 : selfNodeFace(view, test.m_cloth, test.m_lane, test.m_reach, contact);
}

DRAPE_NAMESPACE_END

#endif
