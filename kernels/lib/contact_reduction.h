// Which contacts of a cloth feature say nothing that others do not say already.
//
// The solver takes a contact as a plane: n.(sum w_k x_k) may not fall below what the contact's point and thickness ask
// for. Its nodes stay within a radius R, the tube, of their straight ways through the step. A contact j is implied when
// what others hold keeps it there, up to a tolerance. With D the difference of two normals, a node moves by at most
// R |D| + max(0, D.way) against D from the end of its way. So along n_j
//   a contact i lets its own point down by  d_i = gap_i - thickness + sum w_ik (R |D| + max(0, D.way_k))  at most,
//   a node lets itself down by  depth_k, the least of R + max(0, n_j.way_k) and of the d of its own contacts,
//   and up by  height_k = R + max(0, -n_j.way_k).
// j is implied by a share 0 <= s <= 1 of i, and the nodes for the rest, c_k = w_jk - s w_ik, when
//   gap_j - thickness + tolerance >= s d_i + sum over c_k > 0 of c_k depth_k + sum over c_k < 0 of -c_k height_k.
// (Gaps at the end of the way, thickness not subtracted.) s = 0 asks the nodes alone. This is weak duality: any s
// proves.
//
// Deepest first, ties by obstacle feature: a contact is dropped when the nodes, or one of the first DRAPE_KEEPERS kept
// ones, imply it. Contacts with different obstacles are not compared. A contact that met during the step is never
// dropped. One that began nearer than DRAPE_STANDS of the thickness stands for no other, since a solver may give it
// time to recover. A feature's deepest contact stays unless each of its nodes has contacts of its own: so no node is
// without contacts that had any.
//
// A node's dropped contacts are implied up to one tolerance, so those that they stand for up to two.
#ifndef DRAPE_LIB_CONTACT_REDUCTION_H
#define DRAPE_LIB_CONTACT_REDUCTION_H

#include "../shared/contact.h"
#include "../shared/mesh.h"
#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// Share of the thickness up to which a contact is implied by others of its feature and its nodes' contacts.
#define DRAPE_IMPLIED_SHARE 0.01f

// Least gap at the step's start, in thicknesses, of a contact that stands for others.
#define DRAPE_STANDS 0.9f

// The most kept contacts that others of their feature are compared with: n contacts cost n times as many tests.
#define DRAPE_KEEPERS 16

// The most contacts of a node that are asked what they hold; one with more is taken for free within the tube.
#define DRAPE_SUPPORTS 16u

// Both sides of a step. tube: m, cloth slots x obstacle slots, how far nodes may be from their ways; negative where the
// pair's contacts stay as they are.
typedef struct ReductionView
{
    const DRAPE_GLOBAL float* m_start;  // m, x y z per cloth node
    const DRAPE_GLOBAL float* m_end;
    const DRAPE_GLOBAL Triangle* m_triangles;  // of the cloths
    const DRAPE_GLOBAL Edge* m_edges;
    const DRAPE_GLOBAL MeshFirsts* m_cloths;
    const DRAPE_GLOBAL MeshFirsts* m_obstacles;
    DRAPE_UINT m_clothCount;
    DRAPE_UINT m_obstacleCount;
    const DRAPE_GLOBAL float* m_thickness;  // m, as the tube
    const DRAPE_GLOBAL float* m_tube;
} ReductionView;

// Hits by slot: those of slot s are hits[members[m_first[s]]] … before m_first[s + 1], in any order.
typedef struct SlotLists
{
    const DRAPE_GLOBAL Contact* m_hits;
    const DRAPE_GLOBAL DRAPE_UINT* m_members;
    const DRAPE_GLOBAL DRAPE_UINT* m_first;
    DRAPE_UINT m_slots;
    DRAPE_UINT m_count;  // of all hits
} SlotLists;

// A slot's cloth feature: its nodes, their ways and where their own contacts are listed.
typedef struct ReducedFeature
{
    int m_count;  // of nodes
    DRAPE_UINT m_node[3];
    Vec3 m_way[3];
    DRAPE_UINT m_cloth;  // slot of the mesh
    int m_mayEmpty;      // each node of a face or edge has contacts of its own
} ReducedFeature;

// What the nodes allow along one contact's normal.
typedef struct NodeBounds
{
    Vec3 m_normal;
    DRAPE_UINT m_pair;  // of meshes
    float m_depth[3];
    float m_height[3];
    float m_lack;  // by which the nodes alone fail to imply the contact, m
} NodeBounds;

DRAPE_FUNCTION DRAPE_UINT slotEnd(const SlotLists* lists, DRAPE_UINT slot)
{
    if (slot + 1u >= lists->m_slots) return lists->m_count;
    return lists->m_first[slot + 1u] < lists->m_count ? lists->m_first[slot + 1u] : lists->m_count;
}

// First feature of a mesh, of the kind that a contact's side has: DRAPE_NODE_FACE's is a vertex of the cloth and a
// triangle of the obstacle.
DRAPE_FUNCTION DRAPE_UINT firstOf(const DRAPE_GLOBAL MeshFirsts* mesh, DRAPE_UINT kind, int cloth)
{
    if (kind == DRAPE_EDGE_EDGE) return mesh->m_edge;
    return (kind == DRAPE_NODE_FACE) == (cloth != 0) ? mesh->m_vertex : mesh->m_triangle;
}

// The last mesh that begins at or before the feature.
DRAPE_FUNCTION DRAPE_UINT meshOf(const DRAPE_GLOBAL MeshFirsts* meshes, DRAPE_UINT count, DRAPE_UINT kind, int cloth,
                                 DRAPE_UINT feature)
{
    DRAPE_UINT low = 0, high = count;
    while (high - low > 1u)
    {
        const DRAPE_UINT middle = low + (high - low) / 2u;
        if (firstOf(meshes + middle, kind, cloth) <= feature)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// Place of a contact's pair of meshes among the thicknesses.
DRAPE_FUNCTION DRAPE_UINT pairOf(const ReductionView* view, DRAPE_UINT cloth, const DRAPE_GLOBAL Contact* contact)
{
    return cloth * view->m_obstacleCount +
           meshOf(view->m_obstacles, view->m_obstacleCount, contact->m_kind, 0, contact->m_obstacleFeature);
}

DRAPE_FUNCTION ReducedFeature reducedFeature(const ReductionView* view, const SlotLists* lists,
                                             const DRAPE_GLOBAL Contact* contact)
{
    ReducedFeature feature;
    const DRAPE_UINT index = contact->m_clothFeature;
    const DRAPE_GLOBAL DRAPE_UINT* nodes =
        contact->m_kind == DRAPE_FACE_VERTEX ? view->m_triangles[index].m_vertices : view->m_edges[index].m_vertices;
    feature.m_count = contact->m_kind == DRAPE_NODE_FACE ? 1 : contact->m_kind == DRAPE_FACE_VERTEX ? 3 : 2;
    feature.m_cloth = meshOf(view->m_cloths, view->m_clothCount, contact->m_kind, 1, index);
    feature.m_mayEmpty = feature.m_count > 1;
    for (int k = 0; k < feature.m_count; ++k)
    {
        const DRAPE_UINT node = contact->m_kind == DRAPE_NODE_FACE ? index : nodes[k];
        feature.m_node[k] = node;
        feature.m_way[k] = vec3Sub(vec3Load(view->m_end, node), vec3Load(view->m_start, node));
        if (slotEnd(lists, node) <= lists->m_first[node]) feature.m_mayEmpty = 0;
    }
    return feature;
}

DRAPE_FUNCTION Vec3 contactNormal(const DRAPE_GLOBAL Contact* contact)
{
    return vec3(contact->m_normal[0], contact->m_normal[1], contact->m_normal[2]);
}

// d_i of the header: ways are those of the contact's nodes.
DRAPE_FUNCTION float letsDown(const DRAPE_GLOBAL Contact* contact, Vec3 normal, const Vec3* ways, int count,
                              float thickness, float tube)
{
    const Vec3 turn = vec3Sub(normal, contactNormal(contact));
    float down = contact->m_gap1 - thickness + tube * vec3Length(turn);
    for (int k = 0; k < count; ++k)
        down += contact->m_weights[k] * drapeMax(0.0f, vec3Dot(turn, ways[k]));
    return down;
}

// The depth of a node of the feature along the normal.
DRAPE_FUNCTION float nodeDepth(const ReductionView* view, const SlotLists* lists, const ReducedFeature* feature, int k,
                               Vec3 normal, DRAPE_UINT pair)
{
    const float thickness = view->m_thickness[pair], tube = view->m_tube[pair];
    float depth = tube + drapeMax(0.0f, vec3Dot(normal, feature->m_way[k]));
    if (feature->m_count == 1) return depth;
    const DRAPE_UINT first = lists->m_first[feature->m_node[k]], end = slotEnd(lists, feature->m_node[k]);
    if (end > first + DRAPE_SUPPORTS) return depth;
    for (DRAPE_UINT i = first; i < end; ++i)
    {
        const DRAPE_GLOBAL Contact* own = lists->m_hits + lists->m_members[i];
        if (own->m_gap0 < DRAPE_STANDS * thickness || pairOf(view, feature->m_cloth, own) != pair) continue;
        depth = drapeMin(depth, letsDown(own, normal, feature->m_way + k, 1, thickness, tube));
    }
    return depth;
}

DRAPE_FUNCTION float impliedSlack(const DRAPE_GLOBAL Contact* contact, float thickness)
{
    return contact->m_gap1 - thickness + DRAPE_IMPLIED_SHARE * thickness;
}

// Of no contact yet.
DRAPE_FUNCTION NodeBounds noBounds(void)
{
    NodeBounds bounds;
    bounds.m_normal = vec3(0.0f, 0.0f, 0.0f);
    bounds.m_pair = 0;
    bounds.m_lack = 0.0f;
    return bounds;
}

// What the nodes allow along a contact's normal. The contacts within a face share theirs: *bounds is that of the
// contact before, or of none.
DRAPE_FUNCTION void boundNodes(const ReductionView* view, const SlotLists* lists, const ReducedFeature* feature,
                               const DRAPE_GLOBAL Contact* contact, DRAPE_UINT pair, NodeBounds* bounds)
{
    const Vec3 normal = contactNormal(contact), last = bounds->m_normal;
    if (normal.x != last.x || normal.y != last.y || normal.z != last.z || pair != bounds->m_pair)
    {
        bounds->m_normal = normal;
        bounds->m_pair = pair;
        for (int k = 0; k < feature->m_count; ++k)
        {
            bounds->m_depth[k] = nodeDepth(view, lists, feature, k, normal, pair);
            bounds->m_height[k] = view->m_tube[pair] + drapeMax(0.0f, -vec3Dot(normal, feature->m_way[k]));
        }
    }
    bounds->m_lack = -impliedSlack(contact, view->m_thickness[pair]);
    for (int k = 0; k < feature->m_count; ++k)
        bounds->m_lack += contact->m_weights[k] * bounds->m_depth[k];
}

// Whether a contact may be dropped at all.
DRAPE_FUNCTION int isReducible(const ReductionView* view, const DRAPE_GLOBAL Contact* contact, DRAPE_UINT pair)
{
    return view->m_tube[pair] >= 0.0f && contact->m_time == 1.0f;
}

// Whether the keeper, another contact of the feature, and the nodes imply a contact that the nodes alone do not.
DRAPE_FUNCTION int impliedBy(const ReductionView* view, const ReducedFeature* feature, const NodeBounds* bounds,
                             const DRAPE_GLOBAL Contact* contact, DRAPE_UINT pair, const DRAPE_GLOBAL Contact* keeper)
{
    const float thickness = view->m_thickness[pair];
    if (keeper->m_gap0 < DRAPE_STANDS * thickness || pairOf(view, feature->m_cloth, keeper) != pair) return 0;
    float most = 0.0f;  // of what the nodes let the keeper's point down
    for (int k = 0; k < feature->m_count; ++k)
        most += keeper->m_weights[k] * bounds->m_depth[k];
    // What the normals' difference may cost at most. Most keepers need no root and no look at the ways.
    const float tube = view->m_tube[pair], room = most - (keeper->m_gap1 - thickness) - bounds->m_lack;
    const Vec3 turn = vec3Sub(bounds->m_normal, contactNormal(keeper));
    if (!(room >= 0.0f) || tube * tube * vec3Dot(turn, turn) > room * room) return 0;
    const float down = letsDown(keeper, bounds->m_normal, feature->m_way, feature->m_count, thickness, tube);
    const float gain = most - down;  // per unit of the share
    if (!(gain >= bounds->m_lack)) return 0;
    // The largest share that leaves no node less than nothing, then all of it.
    float share = 1.0f, whole = down;
    for (int k = 0; k < feature->m_count; ++k)
    {
        const float own = contact->m_weights[k], its = keeper->m_weights[k];
        if (share * its > own) share = own / its;
        whole += own >= its ? (own - its) * bounds->m_depth[k] : (its - own) * bounds->m_height[k];
    }
    return share * gain >= bounds->m_lack || whole <= impliedSlack(contact, thickness);
}

// The order in which contacts of a slot are looked at.
DRAPE_FUNCTION int isDeeper(const DRAPE_GLOBAL Contact* a, const DRAPE_GLOBAL Contact* b)
{
    if (a->m_gap1 != b->m_gap1) return a->m_gap1 < b->m_gap1;
    return a->m_obstacleFeature < b->m_obstacleFeature;
}

// kept: the count members of a slot, deepest first. Brings those that stay to its front, in the same order, and returns
// their number.
DRAPE_FUNCTION DRAPE_UINT reduceSlot(const ReductionView* view, const SlotLists* lists, DRAPE_GLOBAL DRAPE_UINT* kept,
                                     DRAPE_UINT count)
{
    if (count == 0u) return 0u;
    const ReducedFeature feature = reducedFeature(view, lists, lists->m_hits + kept[0]);
    NodeBounds bounds = noBounds();
    DRAPE_UINT stay = 0;
    for (DRAPE_UINT j = 0; j < count; ++j)
    {
        const DRAPE_UINT member = kept[j];
        const DRAPE_GLOBAL Contact* contact = lists->m_hits + member;
        const DRAPE_UINT pair = pairOf(view, feature.m_cloth, contact);
        int drop = 0;
        if ((j > 0u || feature.m_mayEmpty) && isReducible(view, contact, pair))
        {
            boundNodes(view, lists, &feature, contact, pair, &bounds);
            drop = bounds.m_lack <= 0.0f;
            for (DRAPE_UINT i = 0; !drop && i < stay && i < DRAPE_KEEPERS; ++i)
                drop = impliedBy(view, &feature, &bounds, contact, pair, lists->m_hits + kept[i]);
        }
        if (!drop) kept[stay++] = member;
    }
    return stay;
}

DRAPE_NAMESPACE_END

#endif
