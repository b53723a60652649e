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

// A loop over a feature's nodes. A GPU goes through three, which unroll, so that arrays stay in registers: of those
// that a feature has not weight, way, depth and height are 0.
#if defined(__OPENCL_VERSION__) && !defined(DRAPE_CPU)
#define DRAPE_EACH_NODE(k, count) DRAPE_UNROLL for (int k = 0; k < 3; ++k)
#else
#define DRAPE_EACH_NODE(k, count) for (int k = 0; k < (count); ++k)
#endif

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

// What is asked of a contact.
typedef struct ReducedContact
{
    Vec3 m_normal;
    float m_gap0;
    float m_gap1;
    float m_weights[3];
    DRAPE_UINT m_pair;  // of meshes
} ReducedContact;

// What the nodes allow along one contact's normal.
typedef struct NodeBounds
{
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

// kind, index: of the slot's contacts, and of the cloth feature that they share.
DRAPE_FUNCTION ReducedFeature reducedFeature(const ReductionView* view, const SlotLists* lists, DRAPE_UINT kind,
                                             DRAPE_UINT index)
{
    ReducedFeature feature;
    const DRAPE_GLOBAL DRAPE_UINT* nodes =
        kind == DRAPE_FACE_VERTEX ? view->m_triangles[index].m_vertices : view->m_edges[index].m_vertices;
    feature.m_count = kind == DRAPE_NODE_FACE ? 1 : kind == DRAPE_FACE_VERTEX ? 3 : 2;
    feature.m_cloth = meshOf(view->m_cloths, view->m_clothCount, kind, 1, index);
    feature.m_mayEmpty = feature.m_count > 1;
    DRAPE_EACH_NODE(k, feature.m_count)
    {
        const int has = k < feature.m_count;
        const DRAPE_UINT node = kind == DRAPE_NODE_FACE ? index : nodes[has ? k : 0];
        feature.m_node[k] = node;
        feature.m_way[k] =
            has ? vec3Sub(vec3Load(view->m_end, node), vec3Load(view->m_start, node)) : vec3(0.0f, 0.0f, 0.0f);
        if (slotEnd(lists, node) <= lists->m_first[node]) feature.m_mayEmpty = 0;
    }
    return feature;
}

DRAPE_FUNCTION ReducedContact reducedContact(const ReductionView* view, DRAPE_UINT cloth,
                                             const DRAPE_GLOBAL Contact* contact)
{
    ReducedContact reduced;
    reduced.m_normal = vec3(contact->m_normal[0], contact->m_normal[1], contact->m_normal[2]);
    reduced.m_gap0 = contact->m_gap0;
    reduced.m_gap1 = contact->m_gap1;
    for (int k = 0; k < 3; ++k)
        reduced.m_weights[k] = contact->m_weights[k];
    reduced.m_pair = pairOf(view, cloth, contact);
    return reduced;
}

// Whether a contact may be dropped at all. time: its own.
DRAPE_FUNCTION int isReducible(const ReductionView* view, const ReducedContact* contact, float time)
{
    return view->m_tube[contact->m_pair] >= 0.0f && time == 1.0f;
}

// Whether one stands for another.
DRAPE_FUNCTION int standsFor(const ReducedContact* keeper, const ReducedContact* contact, float thickness)
{
    return keeper->m_gap0 >= DRAPE_STANDS * thickness && keeper->m_pair == contact->m_pair;
}

// d_i of the header but for its nodes' ways. turn: from the contact's normal to the one along which it is asked.
DRAPE_FUNCTION float letsDownAtRest(const ReducedContact* contact, Vec3 turn, float thickness, float tube)
{
    return contact->m_gap1 - thickness + tube * vec3Length(turn);
}

// d_i of the header: ways are those of the contact's nodes.
DRAPE_FUNCTION float letsDown(const ReducedContact* contact, Vec3 normal, const Vec3* ways, int count, float thickness,
                              float tube)
{
    const Vec3 turn = vec3Sub(normal, contact->m_normal);
    float down = letsDownAtRest(contact, turn, thickness, tube);
    DRAPE_EACH_NODE(k, count) down += contact->m_weights[k] * drapeMax(0.0f, vec3Dot(turn, ways[k]));
    return down;
}

// How far a node goes down along a contact's normal, and up, where no contact of its own holds it.
DRAPE_FUNCTION float freeDepth(Vec3 normal, Vec3 way, float tube)
{
    return tube + drapeMax(0.0f, vec3Dot(normal, way));
}

DRAPE_FUNCTION float nodeHeight(Vec3 normal, Vec3 way, float tube)
{
    return tube + drapeMax(0.0f, -vec3Dot(normal, way));
}

// The depth where a contact of its own may hold it, of which it is `depth` so far.
DRAPE_FUNCTION float heldDepth(const ReductionView* view, const ReducedContact* contact, const ReducedContact* own,
                               Vec3 way, float depth)
{
    const float thickness = view->m_thickness[contact->m_pair], tube = view->m_tube[contact->m_pair];
    if (!standsFor(own, contact, thickness)) return depth;
    const Vec3 turn = vec3Sub(contact->m_normal, own->m_normal);
    const float down = letsDownAtRest(own, turn, thickness, tube);
    return drapeMin(depth, down + own->m_weights[0] * drapeMax(0.0f, vec3Dot(turn, way)));
}

// How many of a node's contacts are asked, and where they begin.
DRAPE_FUNCTION DRAPE_UINT supportsOf(const SlotLists* lists, DRAPE_UINT node, DRAPE_UINT* first)
{
    const DRAPE_UINT end = slotEnd(lists, node);
    *first = lists->m_first[node];
    return end > *first && end <= *first + DRAPE_SUPPORTS ? end - *first : 0u;
}

// The depth of a node of the feature along a contact's normal.
DRAPE_FUNCTION float nodeDepth(const ReductionView* view, const SlotLists* lists, const ReducedFeature* feature, int k,
                               const ReducedContact* contact)
{
    float depth = freeDepth(contact->m_normal, feature->m_way[k], view->m_tube[contact->m_pair]);
    if (feature->m_count == 1) return depth;
    DRAPE_UINT first;
    const DRAPE_UINT supports = supportsOf(lists, feature->m_node[k], &first);
    for (DRAPE_UINT i = first; i < first + supports; ++i)
    {
        const ReducedContact own = reducedContact(view, feature->m_cloth, lists->m_hits + lists->m_members[i]);
        depth = heldDepth(view, contact, &own, feature->m_way[k], depth);
    }
    return depth;
}

DRAPE_FUNCTION float impliedSlack(const ReducedContact* contact, float thickness)
{
    return contact->m_gap1 - thickness + DRAPE_IMPLIED_SHARE * thickness;
}

// By how much nodes of these depths fail to imply a contact, m.
DRAPE_FUNCTION float lackOf(const ReducedContact* contact, int count, const float* depth, float thickness)
{
    float lack = -impliedSlack(contact, thickness);
    DRAPE_EACH_NODE(k, count) lack += contact->m_weights[k] * depth[k];
    return lack;
}

// What the nodes allow along a contact's normal. The contacts within a face share theirs: *bounds is that of *before,
// or of none where that is null.
DRAPE_FUNCTION void boundNodes(const ReductionView* view, const SlotLists* lists, const ReducedFeature* feature,
                               const ReducedContact* contact, const ReducedContact* before, NodeBounds* bounds)
{
    const Vec3 normal = contact->m_normal;
    if (!before || normal.x != before->m_normal.x || normal.y != before->m_normal.y || normal.z != before->m_normal.z ||
        contact->m_pair != before->m_pair)
    {
        DRAPE_EACH_NODE(k, feature->m_count)
        {
            const int has = k < feature->m_count;
            bounds->m_depth[k] = has ? nodeDepth(view, lists, feature, k, contact) : 0.0f;
            bounds->m_height[k] = has ? nodeHeight(normal, feature->m_way[k], view->m_tube[contact->m_pair]) : 0.0f;
        }
    }
    bounds->m_lack = lackOf(contact, feature->m_count, bounds->m_depth, view->m_thickness[contact->m_pair]);
}

// Whether the keeper, another contact of the feature, and nodes of these depths may imply a contact that the nodes
// alone do not, as far as told without a root and a look at the ways: most keepers do not. Where they may, most gets
// how far the nodes let the keeper's point down.
DRAPE_FUNCTION int mayImply(const ReductionView* view, int count, const float* depth, float lack,
                            const ReducedContact* contact, const ReducedContact* keeper, float* most)
{
    const float thickness = view->m_thickness[contact->m_pair], tube = view->m_tube[contact->m_pair];
    float letDown = 0.0f;
    if (!standsFor(keeper, contact, thickness)) return 0;
    DRAPE_EACH_NODE(k, count) letDown += keeper->m_weights[k] * depth[k];
    *most = letDown;
    // What the normals' difference may cost at most.
    const float room = letDown - (keeper->m_gap1 - thickness) - lack;
    const Vec3 turn = vec3Sub(contact->m_normal, keeper->m_normal);
    return room >= 0.0f && tube * tube * vec3Dot(turn, turn) <= room * room;
}

// Whether they do. ways: of the feature's nodes, count of them.
DRAPE_FUNCTION int impliedBy(const ReductionView* view, const Vec3* ways, int count, const NodeBounds* bounds,
                             const ReducedContact* contact, const ReducedContact* keeper)
{
    const float thickness = view->m_thickness[contact->m_pair], tube = view->m_tube[contact->m_pair];
    float most;
    if (!mayImply(view, count, bounds->m_depth, bounds->m_lack, contact, keeper, &most)) return 0;
    const float down = letsDown(keeper, contact->m_normal, ways, count, thickness, tube);
    const float gain = most - down;  // per unit of the share
    if (!(gain >= bounds->m_lack)) return 0;
    // The largest share that leaves no node less than nothing, then all of it.
    float share = 1.0f, whole = down;
    DRAPE_EACH_NODE(k, count)
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
    const DRAPE_GLOBAL Contact* any = lists->m_hits + kept[0];
    const ReducedFeature feature = reducedFeature(view, lists, any->m_kind, any->m_clothFeature);
    ReducedContact keepers[DRAPE_KEEPERS];  // the first that stay
    NodeBounds bounds;
    ReducedContact before;  // whose the bounds are
    const ReducedContact* last = 0;
    DRAPE_UINT stay = 0;
    for (DRAPE_UINT j = 0; j < count; ++j)
    {
        const DRAPE_UINT member = kept[j];
        const ReducedContact contact = reducedContact(view, feature.m_cloth, lists->m_hits + member);
        int drop = 0;
        if ((j > 0u || feature.m_mayEmpty) && isReducible(view, &contact, lists->m_hits[member].m_time))
        {
            boundNodes(view, lists, &feature, &contact, last, &bounds);
            before = contact;
            last = &before;
            drop = bounds.m_lack <= 0.0f;
            for (DRAPE_UINT i = 0; !drop && i < stay && i < DRAPE_KEEPERS; ++i)
                drop = impliedBy(view, feature.m_way, feature.m_count, &bounds, &contact, keepers + i);
        }
        if (drop) continue;
        if (stay < DRAPE_KEEPERS) keepers[stay] = contact;
        kept[stay++] = member;
    }
    return stay;
}

DRAPE_NAMESPACE_END

#endif
