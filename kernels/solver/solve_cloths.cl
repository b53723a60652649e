// Solves a step of cloths: substeps, links, contacts and limits, as core/solver/step_solver.h describes.
//
// Each work-group solves one cloth. Links and contacts of one colour share no node, so its work-items visit them side
// by side; colours and passes are separated by barriers. The result is the host's, bit for bit. docs/decisions/ tells
// why a work-group has a whole cloth.
#define DRAPE_NODE_SPACE __local
#include "../lib/acting_contact.h"
#include "../lib/link_row.h"
#include "../lib/motion_limit.h"
#include "../lib/rigid_motion.h"
#include "solver_bindings.h"

// The cloth of a work-group and its arrays. Nodes count from the cloth's first node.
typedef struct Solve
{
    __global const SolveCloth* m_cloth;
    __global const NodePath* m_paths;
    __global const Vec3* m_accelerations;
    __global const SolveBatch* m_batches;
    __global const SolveFeature* m_features;
    __global const uint* m_surfaceOf;
    __global const SolveSurface* m_surfaces;
    __global const SolveRegion* m_regions;
    __global const SolveLink* m_links;
    __global const uint* m_faceLists;
    __global const uint* m_facesOfNode;
    __global const int* m_faces;
    __global const Contact* m_contacts;
    __local SolverNode* m_nodes;
    __local uint* m_pushingBatches;  // by contact batch, the stage in which one of its contacts pushed last
    __global NodeState* m_states;
    __global SolvePlane* m_planes;
    __global ActingContact* m_acting;
    __global SolveAllowance* m_allowances;
    __global SolveSpan* m_spans;
    __global SolveFeatureState* m_featureStates;
    __global uint* m_lists;  // by feature, contacts that may act, in the place of the feature's contacts
} Solve;

// A sweep over contacts: its stage, counted from 1, and where obstacles stand.
typedef struct Sweep
{
    uint m_stage;
    float m_passed;       // share of the step that has passed
    float m_tolerated;    // m, violation that a projection leaves
    float m_slack;        // m, bound on how far levels lie above those at the step's end
    float m_relaxation;   // share of a violation that a projection corrects
    uint m_actingSweeps;  // over the contacts of a level that act, after its edges
} Sweep;

// Batches whose pushes are recorded; those beyond count as pushing.
#define DRAPE_RECORDED_BATCHES 256

// Least clearance of contacts that are not listed, as a share of the greatest thickness, and as a multiple of the
// nodes' motion since contacts were listed before.
#define DRAPE_LISTED_SHARE 0.01f
#define DRAPE_LISTED_MOTION 2.0f

#define forAll(i, count) for (uint i = get_local_id(0); i < (count); i += get_local_size(0))

// Waits until the group's work-items have written what others read: nodes, in local memory. A CPU's group has one
// work-item, since compilers for CPUs copy the code behind each barrier that is not always reached.
static void syncNodes(void)
{
#ifndef DRAPE_CPU
    barrier(CLK_LOCAL_MEM_FENCE);
#endif
}

// Waits for global memory, too. Data of a feature in global memory needs no wait between sweeps: the same work-item
// visits the feature in all of them.
static void syncAll(void)
{
#ifndef DRAPE_CPU
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
#endif
}

// Returns whether a work-item's flag is set in any of the group's.
static int anyInGroup(const int flag, __local uint* shared)
{
    if (get_local_id(0) == 0) *shared = 0;
    syncNodes();
    if (flag) atomic_or(shared, 1u);
    syncNodes();
    const int any = *shared != 0;
    syncNodes();
    return any;
}

// Returns the greatest of the work-items' values, none of which is negative.
static float mostInGroup(const float value, __local uint* shared)
{
    if (get_local_id(0) == 0) *shared = 0;
    syncNodes();
    atomic_max(shared, as_uint(value));
    syncNodes();
    const float most = as_float(*shared);
    syncNodes();
    return most;
}

static Vec3 xyz(const float4 v)
{
    return vec3(v.x, v.y, v.z);
}

static SolverNode loadNode(const Solve* solve, const uint node)
{
    const float4 v = ((__local const float4*)solve->m_nodes)[node];
    SolverNode loaded;
    loaded.m_displacement = xyz(v);
    loaded.m_inverseMass = v.w;
    return loaded;
}

static void storeNode(const Solve* solve, const uint node, const SolverNode* value)
{
    const Vec3 d = value->m_displacement;
    ((__local float4*)solve->m_nodes)[node] = (float4)(d.x, d.y, d.z, value->m_inverseMass);
}

static Vec3 displacementOf(const Solve* solve, const uint node)
{
    return xyz(((__local const float4*)solve->m_nodes)[node]);
}

static SolvePlane loadPlane(const Solve* solve, const uint index)
{
    __global const float4* words = (__global const float4*)(solve->m_planes + index);
    const float4 first = words[0], second = words[1];
    SolvePlane plane;
    plane.m_normal = xyz(first);
    plane.m_level = first.w;
    plane.m_weights[0] = second.x;
    plane.m_weights[1] = second.y;
    plane.m_flags = as_uint(second.z);
    plane.m_pushing = as_uint(second.w);
    return plane;
}

static SolveFeature loadFeature(const Solve* solve, const uint index)
{
    __global const uint4* words = (__global const uint4*)(solve->m_features + index);
    const uint4 first = words[0], second = words[1];
    SolveFeature feature;
    feature.m_nodes[0] = first.x;
    feature.m_nodes[1] = first.y;
    feature.m_nodes[2] = first.z;
    feature.m_nodeCount = first.w;
    feature.m_firstContact = second.x;
    feature.m_contactCount = second.y;
    return feature;
}

static void visitBatchLink(const Solve* solve, const uint index)
{
    const uint4 link = ((__global const uint4*)solve->m_links)[index];
    const float4 span = ((__global const float4*)solve->m_spans)[index];
    SolverNode a = loadNode(solve, link.x), b = loadNode(solve, link.y);
    visitLink(&a, &b, xyz(span), span.w, as_float(link.w));
    storeNode(solve, link.x, &a);
    storeNode(solve, link.y, &b);
}

static void sweepLinks(const Solve* solve)
{
    const SolveRange range = solve->m_cloth->m_linkBatches;
    for (uint i = 0; i < range.m_count; ++i)
    {
        const SolveBatch batch = solve->m_batches[range.m_first + i];
        if (!batch.m_serial)
            for (uint k = batch.m_first + get_local_id(0); k < batch.m_last; k += get_local_size(0))
                visitBatchLink(solve, k);
        else if (get_local_id(0) == 0)
            for (uint k = batch.m_first; k < batch.m_last; ++k)
                visitBatchLink(solve, k);
        syncNodes();
    }
}

static ContactPlane foundPlane(__global const Contact* contact)
{
    ContactPlane plane;
    plane.m_normal = vec3Load(contact->m_normal, 0);
    plane.m_point = vec3Load(contact->m_point, 0);
    for (int k = 0; k < 3; ++k)
        plane.m_weights[k] = contact->m_weights[k];
    return plane;
}

static Vec3 carriedStart(__global const SolveSurface* surface, const Vec3 start)
{
    return surface->m_moves ? mapPoint(surface->m_map, start) : start;
}

static FeatureNodes featureNodes(const Solve* solve, const SolveFeature* feature, __global const SolveSurface* surface)
{
    FeatureNodes nodes;
    nodes.m_count = feature->m_nodeCount;
    nodes.m_moves = surface->m_moves;
    for (uint k = 0; k < 3; ++k)
    {
        // Entries beyond the last node repeat it, and nothing reads them.
        const uint node = feature->m_nodes[k < feature->m_nodeCount ? k : 0];
        __global const NodePath* path = solve->m_paths + node;
        nodes.m_nodes[k] = node;
        nodes.m_starts[k] = path->m_start;
        nodes.m_carried[k] = carriedStart(surface, path->m_start);
        nodes.m_ends[k] = vec3Add(path->m_start, path->m_way);
        nodes.m_inverseMasses[k] = path->m_inverseMass;
    }
    return nodes;
}

// The nodes' displacements of a feature; entries beyond the last node repeat the first.
typedef struct Displacements
{
    Vec3 m_nodes[3];
} Displacements;

static Displacements displacementsOf(const Solve* solve, const SolveFeature* feature)
{
    Displacements at;
    at.m_nodes[0] = displacementOf(solve, feature->m_nodes[0]);
    at.m_nodes[1] = feature->m_nodeCount > 1 ? displacementOf(solve, feature->m_nodes[1]) : at.m_nodes[0];
    at.m_nodes[2] = feature->m_nodeCount > 2 ? displacementOf(solve, feature->m_nodes[2]) : at.m_nodes[0];
    return at;
}

// Returns an upper bound of a contact's violation once the obstacle stands at the step's end, m.
static float excessOf(const SolvePlane* plane, const Displacements* at)
{
    const Vec3 first = at->m_nodes[0];
    const Vec3 second = vec3Scale(vec3Sub(at->m_nodes[1], first), plane->m_weights[0]);
    const Vec3 third = vec3Scale(vec3Sub(at->m_nodes[2], first), plane->m_weights[1]);
    return plane->m_level - vec3Dot(plane->m_normal, vec3Add(first, vec3Add(second, third)));
}

DRAPE_RARE_FUNCTION void makeActing(const Solve* solve, const SolveFeature* feature, const uint index)
{
    __global const SolveSurface* surface = solve->m_surfaces + solve->m_surfaceOf[index];
    const FeatureNodes nodes = featureNodes(solve, feature, surface);
    const ContactPlane plane = foundPlane(solve->m_contacts + index);
    ContactSettings settings;
    settings.m_thickness = surface->m_thickness;
    settings.m_friction = surface->m_friction;
    settings.m_hardness = solve->m_cloth->m_hardness;
    settings.m_perSecond = solve->m_cloth->m_perSecond;
    solve->m_acting[index] = actingContact(&nodes, &plane, &settings, contactGaps(&nodes, &plane, &settings));
}

// Renews the plane of a contact that turns.
DRAPE_RARE_FUNCTION void renew(const Solve* solve, const SolveFeature* feature, const uint index, const Sweep* sweep)
{
    ActingContact acting = solve->m_acting[index];
    const FeatureNodes nodes = featureNodes(solve, feature, solve->m_surfaces + solve->m_surfaceOf[index]);
    Vec3 displacements[3];
    for (uint k = 0; k < 3; ++k)
        displacements[k] = solve->m_nodes[nodes.m_nodes[k]].m_displacement;
    const ContactPlane before = foundPlane(solve->m_contacts + index);
    ContactPlane plane;
    acting.m_stage = sweep->m_stage;
    const int turned = renewPlane(&acting, &nodes, displacements, sweep->m_passed, &before, &plane);
    solve->m_acting[index] = acting;
    if (!turned) return;
    __global SolvePlane* bound = solve->m_planes + index;
    bound->m_normal = plane.m_normal;
    bound->m_level = acting.m_row.m_level + solve->m_cloth->m_margin;
    bound->m_weights[0] = plane.m_weights[1];
    bound->m_weights[1] = plane.m_weights[2];
}

// Loads what pushes need of a contact, as vectors: all but the nodes.
static ActingContact loadActing(const Solve* solve, const uint index)
{
    __global const float4* words = (__global const float4*)(solve->m_acting + index);
    const float4 normal = words[0], carried = words[1], held = words[2], weights = words[3], shares = words[4];
    const float4 rest = words[6];
    ActingContact acting;
    acting.m_row.m_normal = xyz(normal);
    acting.m_row.m_level = normal.w;
    acting.m_row.m_carried = xyz(carried);
    acting.m_row.m_advance = carried.w;
    acting.m_row.m_held = xyz(held);
    acting.m_row.m_multiplier = held.w;
    acting.m_row.m_weights[0] = weights.x;
    acting.m_row.m_weights[1] = weights.y;
    acting.m_row.m_weights[2] = weights.z;
    acting.m_row.m_friction = weights.w;
    acting.m_row.m_shares[0] = shares.x;
    acting.m_row.m_shares[1] = shares.y;
    acting.m_row.m_shares[2] = shares.z;
    acting.m_row.m_inverseMobility = shares.w;
    acting.m_row.m_mended = rest.x;
    acting.m_stage = as_uint(rest.w);
    return acting;
}

static Vec3 rowWay(const ActingContact* acting, const uint count, const Displacements* at)
{
    Vec3 way = vec3Scale(at->m_nodes[0], acting->m_row.m_weights[0]);
    if (count > 1) way = vec3AddScaled(way, at->m_nodes[1], acting->m_row.m_weights[1]);
    if (count > 2) way = vec3AddScaled(way, at->m_nodes[2], acting->m_row.m_weights[2]);
    return way;
}

static void storeShift(const Solve* solve, const uint node, const Vec3 displacement)
{
    // The inverse mass beside it stays.
    solve->m_nodes[node].m_displacement = displacement;
    solve->m_states[node].m_shifted = 1;
}

// Projects a contact that is violated or pushes. `worst` grows to its violation. Returns whether it moved its nodes,
// whose displacements are in *at.
static int projectContact(const Solve* solve, const SolveFeature* feature, const uint index, const SolvePlane* plane,
                          const Sweep* sweep, Displacements* at, float* worst)
{
    const uint count = feature->m_nodeCount;
    __global uint* flags = &solve->m_planes[index].m_flags;
    if (!(plane->m_flags & DRAPE_PLANE_MADE))
    {
        makeActing(solve, feature, index);
        *flags = plane->m_flags | DRAPE_PLANE_MADE;
    }
    ActingContact acting = loadActing(solve, index);
    if (!(acting.m_row.m_inverseMobility > 0.0f)) return 0;
    Vec3 way = rowWay(&acting, count, at);
    if ((plane->m_flags & DRAPE_PLANE_TURNS) && acting.m_stage != sweep->m_stage &&
        acting.m_row.m_level - (1.0f - sweep->m_passed) * acting.m_row.m_advance - vec3Dot(acting.m_row.m_normal, way) >
            0.0f)
    {
        renew(solve, feature, index, sweep);
        acting = loadActing(solve, index);
        way = rowWay(&acting, count, at);
        if (!(acting.m_row.m_inverseMobility > 0.0f)) return 0;
    }
    if (plane->m_pushing != sweep->m_stage)
    {
        acting.m_row.m_multiplier = 0.0f;
        acting.m_row.m_held = vec3(0.0f, 0.0f, 0.0f);
    }
    Vec3 shift;
    if (!pushRow(&acting.m_row, way, sweep->m_passed, sweep->m_tolerated, sweep->m_relaxation, worst, &shift)) return 0;
    const Vec3 held = acting.m_row.m_held;
    ((__global float4*)(solve->m_acting + index))[2] = (float4)(held.x, held.y, held.z, acting.m_row.m_multiplier);
    solve->m_acting[index].m_pushed = 1;
    solve->m_planes[index].m_pushing = sweep->m_stage;
    at->m_nodes[0] = vec3AddScaled(at->m_nodes[0], shift, acting.m_row.m_shares[0]);
    storeShift(solve, feature->m_nodes[0], at->m_nodes[0]);
    if (count > 1)
    {
        at->m_nodes[1] = vec3AddScaled(at->m_nodes[1], shift, acting.m_row.m_shares[1]);
        storeShift(solve, feature->m_nodes[1], at->m_nodes[1]);
    }
    if (count > 2)
    {
        at->m_nodes[2] = vec3AddScaled(at->m_nodes[2], shift, acting.m_row.m_shares[2]);
        storeShift(solve, feature->m_nodes[2], at->m_nodes[2]);
    }
    if (count < 2) at->m_nodes[1] = at->m_nodes[0];
    if (count < 3) at->m_nodes[2] = at->m_nodes[0];
    return 1;
}

// Lists the contacts of a feature that may act while its nodes move little.
DRAPE_RARE_FUNCTION SolveFeatureState listContacts(const Solve* solve, const SolveFeature* feature,
                                                   const Displacements* at, const Sweep* sweep, const float moved)
{
    const float near =
        drapeMax(DRAPE_LISTED_SHARE * solve->m_cloth->m_mostThickness, DRAPE_LISTED_MOTION * moved) + sweep->m_slack;
    SolveFeatureState state;
    for (int k = 0; k < 3; ++k)
        state.m_references[k] = at->m_nodes[k];
    state.m_clearance = DRAPE_INFINITY;
    state.m_listCount = state.m_unused = 0;
    for (uint i = feature->m_firstContact; i < feature->m_firstContact + feature->m_contactCount; ++i)
    {
        const SolvePlane plane = loadPlane(solve, i);
        const float clearance = -excessOf(&plane, at);
        if (clearance >= near && plane.m_pushing != sweep->m_stage)
            state.m_clearance = drapeMin(state.m_clearance, clearance);
        else
            solve->m_lists[feature->m_firstContact + state.m_listCount++] = i;
    }
    return state;
}

// Returns whether contacts beyond the list may be violated. moved2: m², square of the greatest motion of a node since.
static int isListOld(const Solve* solve, const SolveFeatureState* state, const Displacements* at, const Sweep* sweep,
                     float* moved2)
{
    *moved2 = 0.0f;
    for (int k = 0; k < 3; ++k)
    {
        const Vec3 way = vec3Sub(at->m_nodes[k], state->m_references[k]);
        *moved2 = drapeMax(*moved2, vec3Dot(way, way));
    }
    const float free = state->m_clearance - sweep->m_slack - solve->m_cloth->m_margin;
    return !(free > 0.0f) || !(*moved2 < free * free);
}

static SolveFeatureState loadState(const Solve* solve, const uint index)
{
    __global const float4* words = (__global const float4*)(solve->m_featureStates + index);
    const float4 first = words[0], second = words[1], third = words[2];
    SolveFeatureState state;
    state.m_references[0] = xyz(first);
    state.m_references[1] = vec3(first.w, second.x, second.y);
    state.m_references[2] = vec3(second.z, second.w, third.x);
    state.m_clearance = third.y;
    state.m_listCount = as_uint(third.z);
    return state;
}

// Visits the contacts of a feature in order: those that push and those that may be violated. Returns whether one
// pushed.
static int visitFeature(const Solve* solve, const uint index, const Sweep* sweep, float* worst)
{
    const SolveFeature feature = loadFeature(solve, index);
    SolveFeatureState state = loadState(solve, index);
    Displacements at = displacementsOf(solve, &feature);
    float moved2;
    int old = isListOld(solve, &state, &at, sweep, &moved2);
    if (state.m_listCount == 0 && !old) return 0;
    int pushed = 0;
    uint done = feature.m_firstContact;  // contacts before it are
    for (uint i = 0; i < state.m_listCount || old;)
    {
        if (old)
        {
            state = listContacts(solve, &feature, &at, sweep, drapeSqrt(moved2));
            solve->m_featureStates[index] = state;
            old = 0;
            i = 0;
            continue;
        }
        const uint contact = solve->m_lists[feature.m_firstContact + i++];
        if (contact < done) continue;
        done = contact + 1;
        const SolvePlane plane = loadPlane(solve, contact);
        if (plane.m_pushing != sweep->m_stage && !(excessOf(&plane, &at) + sweep->m_slack > 0.0f)) continue;
        if (!projectContact(solve, &feature, contact, &plane, sweep, &at, worst)) continue;
        pushed = 1;
        old = isListOld(solve, &state, &at, sweep, &moved2);
    }
    return pushed;
}

// Projects the contacts of a feature that act in this stage, in order.
static void visitActing(const Solve* solve, const uint index, const Sweep* sweep)
{
    const SolveFeatureState state = loadState(solve, index);
    if (state.m_listCount == 0) return;
    const SolveFeature feature = loadFeature(solve, index);
    Displacements at = displacementsOf(solve, &feature);
    float worst = 0.0f;
    for (uint i = 0; i < state.m_listCount; ++i)
    {
        const uint contact = solve->m_lists[feature.m_firstContact + i];
        SolvePlane plane = loadPlane(solve, contact);
        if (plane.m_pushing != sweep->m_stage) continue;
        plane.m_flags &= ~DRAPE_PLANE_TURNS;
        projectContact(solve, &feature, contact, &plane, sweep, &at, &worst);
    }
}

static int visitFeatureOf(const Solve* solve, const uint index, const Sweep* sweep, const int acting, float* worst)
{
    if (!acting) return visitFeature(solve, index, sweep, worst);
    visitActing(solve, index, sweep);
    return 0;
}

// Visits the features of a batch, or only their contacts that act. `worst` grows to the worst violation that the
// work-item met, m.
DRAPE_RARE_FUNCTION void sweepBatch(const Solve* solve, const uint index, const Sweep* sweep, const int acting,
                                    float* worst)
{
    const uint recorded = index - solve->m_cloth->m_faceBatches.m_first;
    if (acting && recorded < DRAPE_RECORDED_BATCHES && solve->m_pushingBatches[recorded] != sweep->m_stage) return;
    const SolveBatch batch = solve->m_batches[index];
    int pushed = 0;
    if (!batch.m_serial)
        for (uint k = batch.m_first + get_local_id(0); k < batch.m_last; k += get_local_size(0))
            pushed |= visitFeatureOf(solve, k, sweep, acting, worst);
    else if (get_local_id(0) == 0)
        for (uint k = batch.m_first; k < batch.m_last; ++k)
            pushed |= visitFeatureOf(solve, k, sweep, acting, worst);
    if (pushed && recorded < DRAPE_RECORDED_BATCHES) solve->m_pushingBatches[recorded] = sweep->m_stage;
    syncNodes();
}

static void sweepBatches(const Solve* solve, const SolveRange range, const Sweep* sweep, float* worst)
{
    for (uint i = range.m_first; i < range.m_first + range.m_count; ++i)
        sweepBatch(solve, i, sweep, 0, worst);
}

// Visits the batches of a level.
static void sweepLevel(const Solve* solve, const SolveRange range, const uint level, const Sweep* sweep,
                       const int acting, float* worst)
{
    for (uint i = range.m_first; i < range.m_first + range.m_count; ++i)
        if (solve->m_batches[i].m_level == level) sweepBatch(solve, i, sweep, acting, worst);
}

// Returns the worst violation that the work-item met, m.
static float sweepContacts(const Solve* solve, const Sweep* sweep)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    float worst = 0.0f, met = 0.0f;
    sweepBatches(solve, cloth->m_faceBatches, sweep, &worst);
    for (uint level = 0; level < cloth->m_levels; ++level)
    {
        sweepLevel(solve, cloth->m_edgeBatches, level, sweep, 0, &worst);
        for (uint i = 0; i < sweep->m_actingSweeps; ++i)
        {
            sweepLevel(solve, cloth->m_faceBatches, level, sweep, 1, &met);
            sweepLevel(solve, cloth->m_edgeBatches, level, sweep, 1, &met);
        }
    }
    return worst;
}

// Sets the bounding planes of a feature's contacts, and marks its nodes.
static void beginFeature(const Solve* solve, const uint index)
{
    const SolveFeature feature = loadFeature(solve, index);
    const Vec3 first = solve->m_paths[feature.m_nodes[0]].m_start;
    for (uint i = feature.m_firstContact; i < feature.m_firstContact + feature.m_contactCount; ++i)
    {
        const ContactPlane found = foundPlane(solve->m_contacts + i);
        Vec3 start = first;
        for (uint k = 1; k < feature.m_nodeCount; ++k)
            start =
                vec3AddScaled(start, vec3Sub(solve->m_paths[feature.m_nodes[k]].m_start, first), found.m_weights[k]);
        SolvePlane plane;
        plane.m_normal = found.m_normal;
        plane.m_level = solve->m_cloth->m_mostThickness + vec3Dot(found.m_normal, vec3Sub(found.m_point, start)) +
                        solve->m_cloth->m_margin;
        plane.m_weights[0] = found.m_weights[1];
        plane.m_weights[1] = found.m_weights[2];
        __global const Contact* contact = solve->m_contacts + i;
        const int turns = contact->m_kind == DRAPE_FACE_VERTEX && !(contact->m_time < 1.0f);
        plane.m_flags = turns ? DRAPE_PLANE_TURNS : 0;
        plane.m_pushing = 0;
        solve->m_planes[i] = plane;
    }
    for (uint k = 0; k < feature.m_nodeCount; ++k)
        solve->m_allowances[feature.m_nodes[k]].m_hasContact = 1;
    for (int k = 0; k < 3; ++k)
        solve->m_featureStates[index].m_references[k] = vec3(0.0f, 0.0f, 0.0f);
    solve->m_featureStates[index].m_clearance = -1.0f;  // the first visit lists the contacts
    solve->m_featureStates[index].m_listCount = 0;
}

static void beginStep(const Solve* solve)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    forAll(i, cloth->m_nodes.m_count)
    {
        const NodePath path = solve->m_paths[i];
        solve->m_nodes[i].m_inverseMass = path.m_freeMass;
        nodeBegin(solve->m_nodes + i, solve->m_states + i, path.m_way, solve->m_accelerations[i], cloth->m_perStep,
                  cloth->m_pathShare);
        solve->m_states[i].m_shifted = 0;
        solve->m_allowances[i].m_hasContact = 0;
    }
    syncAll();
    forAll(i, cloth->m_features.m_count) beginFeature(solve, cloth->m_features.m_first + i);
    forAll(i, cloth->m_links.m_count)
    {
        const uint link = cloth->m_links.m_first + i;
        const SolveLink joined = solve->m_links[link];
        solve->m_spans[link].m_apart =
            vec3Sub(solve->m_paths[joined.m_nodes[1]].m_start, solve->m_paths[joined.m_nodes[0]].m_start);
        solve->m_spans[link].m_restSquared = joined.m_restSquared;
    }
    syncAll();
}

// Returns whether what the node or its faces may pass between the ends of their paths and their positions meets the
// region.
DRAPE_RARE_FUNCTION int isNearRegion(const Solve* solve, const uint node, __global const SolveRegion* region)
{
    Box box, own = pointBox(vec3Add(solve->m_paths[node].m_start, solve->m_paths[node].m_way));
    box.m_low = region->m_low;
    box.m_high = region->m_high;
    growByPassed(&own, solve->m_nodes + node, solve->m_paths + node);
    int near = boxesMeet(&own, &box);
    __global const uint* list = solve->m_faceLists + node;
    for (uint i = list[0]; i < list[1] && !near; ++i)
    {
        __global const int* face = solve->m_faces + 3 * solve->m_facesOfNode[i];
        Box passed = pointBox(vec3Add(solve->m_paths[face[0]].m_start, solve->m_paths[face[0]].m_way));
        for (int k = 0; k < 3; ++k)
            growByPassed(&passed, solve->m_nodes + face[k], solve->m_paths + face[k]);
        near = boxesMeet(&passed, &box);
    }
    return near;
}

// Limits far nodes by the obstacles that rest. withContacts: whether nodes with contacts are among them.
DRAPE_RARE_FUNCTION void limitByResting(const Solve* solve, const int withContacts)
{
    const SolveRange regions = solve->m_cloth->m_regions;
    forAll(node, solve->m_cloth->m_nodes.m_count)
    {
        if (!solve->m_states[node].m_isFar) continue;
        __global SolveAllowance* allowance = solve->m_allowances + node;
        float start = DRAPE_INFINITY, end = DRAPE_INFINITY;
        for (uint i = regions.m_first; i < regions.m_first + regions.m_count; ++i)
        {
            __global const SolveRegion* region = solve->m_regions + i;
            if (region->m_moves) continue;
            const int hasContact = allowance->m_hasContact;
            if (hasContact ? !withContacts : !isNearRegion(solve, node, region)) continue;
            start = drapeMin(start, region->m_start);
            end = drapeMin(end, hasContact ? region->m_start : region->m_end);
        }
        allowance->m_start = start;
        allowance->m_end = end;
    }
    syncNodes();
    forAll(node, solve->m_cloth->m_nodes.m_count)
    {
        const SolveAllowance allowance = solve->m_allowances[node];
        if (!solve->m_states[node].m_isFar || allowance.m_end == DRAPE_INFINITY) continue;
        bringBack(solve->m_nodes + node, solve->m_states + node, vec3(0.0f, 0.0f, 0.0f), solve->m_paths[node].m_way,
                  allowance.m_start, allowance.m_end);
    }
    syncNodes();
}

DRAPE_RARE_FUNCTION void limitByMoving(const Solve* solve, __global const SolveRegion* region)
{
    forAll(node, solve->m_cloth->m_nodes.m_count) solve->m_allowances[node].m_isNear =
        solve->m_states[node].m_isFar ? isNearRegion(solve, node, region) : 0;
    syncNodes();
    forAll(node, solve->m_cloth->m_nodes.m_count)
    {
        if (!solve->m_allowances[node].m_isNear) continue;
        const Vec3 from = solve->m_paths[node].m_start;
        const Vec3 start = vec3Sub(carriedStart(solve->m_surfaces + region->m_surface, from), from);
        const float end = solve->m_allowances[node].m_hasContact ? region->m_start : region->m_end;
        bringBack(solve->m_nodes + node, solve->m_states + node, start, solve->m_paths[node].m_way, region->m_start,
                  end);
    }
    syncNodes();
}

// Marks the nodes that the limit may bring back. Returns whether there are any.
DRAPE_RARE_FUNCTION int findFarNodes(const Solve* solve, __local uint* shared)
{
    int any = 0;
    forAll(node, solve->m_cloth->m_nodes.m_count)
    {
        const int far = isFarFromEnd(solve->m_nodes + node, solve->m_paths + node, solve->m_cloth->m_sure);
        solve->m_states[node].m_isFar = far;
        any |= far;
    }
    return anyInGroup(any, shared);
}

// See MotionLimit::apply().
static void applyLimits(const Solve* solve, __local uint* shared)
{
    const SolveRange regions = solve->m_cloth->m_regions;
    if (regions.m_count == 0 || !findFarNodes(solve, shared)) return;
    limitByResting(solve, 1);
    for (uint i = regions.m_first; i < regions.m_first + regions.m_count; ++i)
        if (solve->m_regions[i].m_moves) limitByMoving(solve, solve->m_regions + i);
}

// See MotionLimit::keepNear().
static void keepNear(const Solve* solve)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    forAll(node, cloth->m_nodes.m_count)
    {
        if (!solve->m_allowances[node].m_hasContact) continue;
        if (!isFarFromEnd(solve->m_nodes + node, solve->m_paths + node, cloth->m_sure)) continue;
        bringBack(solve->m_nodes + node, solve->m_states + node, vec3(0.0f, 0.0f, 0.0f), solve->m_paths[node].m_way,
                  cloth->m_leastTolerance, cloth->m_leastTolerance);
    }
    syncNodes();
}

static void runSubstep(const Solve* solve, const uint substep, __local uint* shared)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    forAll(i, cloth->m_nodes.m_count)
        nodeAdvance(solve->m_nodes + i, solve->m_states + i, solve->m_accelerations[i], cloth->m_substepTime);
    syncNodes();
    // Limits beside a moving obstacle hold at the step's end alone.
    if (substep > 0 && (cloth->m_rests || substep + 1 == cloth->m_substeps))
    {
        applyLimits(solve, shared);
        forAll(i, cloth->m_nodes.m_count)
            nodeLimitShift(solve->m_nodes + i, solve->m_states + i, cloth->m_perCorrection, cloth->m_perSecond);
        syncNodes();
    }
    Sweep sweep;
    sweep.m_stage = substep + 1;
    sweep.m_passed = (float)(substep + 1) / (float)cloth->m_substeps;
    sweep.m_slack = (1.0f - sweep.m_passed) * cloth->m_retreat;
    sweep.m_tolerated = 0.0f;
    sweep.m_relaxation = DRAPE_TURN_RELAXATION;
    sweep.m_actingSweeps = cloth->m_actingSweeps;
    for (uint i = 0; i < cloth->m_linkSweeps; ++i)
    {
        sweepLinks(solve);
        sweepContacts(solve, &sweep);
    }
    forAll(i, cloth->m_nodes.m_count)
        nodeEnd(solve->m_nodes + i, solve->m_states + i, cloth->m_perCorrection, cloth->m_kept);
    syncNodes();
}

// Returns whether the cloth needs another closing sweep after `done` sweeps.
static int isOpen(__global const SolveCloth* cloth, const uint done, const float worst)
{
    if (done < cloth->m_leastClosing) return worst > cloth->m_fineViolation;
    return done < cloth->m_mostClosing && worst > cloth->m_mostViolation;
}

// Sweeps until no contact is violated by more than the tolerances. Returns the number of sweeps.
static uint closeContacts(const Solve* solve, __local uint* shared)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    Sweep sweep;
    sweep.m_stage = cloth->m_substeps + 1;
    sweep.m_passed = 1.0f;
    sweep.m_tolerated = cloth->m_tolerated;
    sweep.m_slack = 0.0f;
    sweep.m_relaxation = 1.0f;
    sweep.m_actingSweeps = 0;
    float worst = mostInGroup(sweepContacts(solve, &sweep), shared);
    uint done = 1;
    for (; isOpen(cloth, done, worst); ++done)
    {
        if (cloth->m_rests)
            keepNear(solve);
        else
            applyLimits(solve, shared);
        worst = mostInGroup(sweepContacts(solve, &sweep), shared);
    }
    // Nodes go last: see StepSolver::close().
    float met = 0.0f;
    if (worst > cloth->m_fineViolation) sweepBatches(solve, cloth->m_nodeBatches, &sweep, &met);
    if (cloth->m_rests && findFarNodes(solve, shared)) limitByResting(solve, 0);
    return done;
}

// Limits the speeds that a batch's contacts gave. Returns whether one of them ends so near that a surface may have been
// passed.
DRAPE_RARE_FUNCTION int limitSpeeds(const Solve* solve, const SolveRange range)
{
    int near = 0;
    for (uint b = 0; b < range.m_count; ++b)
    {
        const SolveBatch batch = solve->m_batches[range.m_first + b];
        const uint step = batch.m_serial ? 1 : get_local_size(0);
        const uint first = batch.m_serial && get_local_id(0) != 0
                               ? batch.m_last
                               : batch.m_first + (batch.m_serial ? 0 : get_local_id(0));
        for (uint k = first; k < batch.m_last; k += step)
        {
            const SolveFeature feature = loadFeature(solve, k);
            for (uint i = feature.m_firstContact; i < feature.m_firstContact + feature.m_contactCount; ++i)
            {
                if (!(solve->m_planes[i].m_flags & DRAPE_PLANE_MADE)) continue;
                const ActingContact acting = solve->m_acting[i];
                if (!acting.m_pushed) continue;
                limitSpeed(&acting, solve->m_states);
                near |= acting.m_distance - rowViolation(&acting.m_row, solve->m_nodes, 1.0f) <
                        solve->m_cloth->m_nearDistance;
            }
        }
        syncAll();
    }
    return near;
}

// Solves the cloth of the work-group's number, whatever the group's size.
DRAPE_RARE_FUNCTION void solveCloth(const SolveLayout* layout, __global const SolveInputWord* input,
                                    __global const SolveTopologyWord* topology, __global const Contact* contacts,
                                    __global SolveWorkWord* work, __local SolverNode* nodes,
                                    __local uint* pushingBatches, __local uint* shared)
{
    Solve solve;
    __global const SolveCloth* cloth = (__global const SolveCloth*)(input + layout->m_cloths) + get_group_id(0);
    const uint firstNode = cloth->m_nodes.m_first;
    solve.m_cloth = cloth;
    solve.m_paths = (__global const NodePath*)(input + layout->m_paths) + firstNode;
    solve.m_accelerations = (__global const Vec3*)(input + layout->m_accelerations) + firstNode;
    solve.m_batches = (__global const SolveBatch*)(input + layout->m_batches);
    solve.m_features = (__global const SolveFeature*)(input + layout->m_features);
    solve.m_surfaceOf = (__global const uint*)(input + layout->m_surfaceOf);
    solve.m_surfaces = (__global const SolveSurface*)(input + layout->m_surfaces);
    solve.m_regions = (__global const SolveRegion*)(input + layout->m_regions);
    solve.m_links = (__global const SolveLink*)(topology + layout->m_links);
    solve.m_faceLists = (__global const uint*)(topology + layout->m_faceLists) + cloth->m_faceLists;
    solve.m_facesOfNode = (__global const uint*)(topology + layout->m_facesOfNode);
    solve.m_faces = (__global const int*)(topology + layout->m_faces);
    solve.m_contacts = contacts;
    solve.m_nodes = nodes;
    solve.m_pushingBatches = pushingBatches;
    forAll(i, DRAPE_RECORDED_BATCHES) pushingBatches[i] = 0;
    solve.m_states = (__global NodeState*)(work + layout->m_states) + firstNode;
    solve.m_planes = (__global SolvePlane*)(work + layout->m_planes);
    solve.m_acting = (__global ActingContact*)(work + layout->m_acting);
    solve.m_allowances = (__global SolveAllowance*)(work + layout->m_allowances) + firstNode;
    solve.m_spans = (__global SolveSpan*)(work + layout->m_spans);
    solve.m_featureStates = (__global SolveFeatureState*)(work + layout->m_featureStates);
    solve.m_lists = (__global uint*)(work + layout->m_lists);

    beginStep(&solve);
    for (uint i = 0; i < cloth->m_substeps; ++i)
        runSubstep(&solve, i, shared);
    // See StepSolver::settle().
    const int settles = cloth->m_rests && cloth->m_features.m_count > 0;
    forAll(i, cloth->m_nodes.m_count)
    {
        if (settles && solve.m_paths[i].m_inverseMass > 0.0f)
            nodeSettle(solve.m_nodes + i, solve.m_states + i, solve.m_accelerations[i], cloth->m_perStep);
        nodeRemember(solve.m_nodes + i, solve.m_states + i);
    }
    syncNodes();
    applyLimits(&solve, shared);
    const uint sweeps = cloth->m_features.m_count > 0 ? closeContacts(&solve, shared) : 0;
    syncAll();
    forAll(i, cloth->m_nodes.m_count) nodeAddShift(solve.m_nodes + i, solve.m_states + i, cloth->m_perShift);
    syncAll();
    __global SolverNode* ends = (__global SolverNode*)(work + layout->m_nodes) + firstNode;
    forAll(i, cloth->m_nodes.m_count) ends[i] = nodes[i];
    int near = limitSpeeds(&solve, cloth->m_faceBatches);
    near |= limitSpeeds(&solve, cloth->m_edgeBatches);
    near = anyInGroup(near, shared);
    if (get_local_id(0) > 0) return;
    __global SolveResult* result = (__global SolveResult*)(work + layout->m_results) + get_group_id(0);
    result->m_mayHavePassed = near;
    result->m_closingSweeps = sweeps;
}

// One text for both sizes of groups.
#ifdef DRAPE_CPU
#define DRAPE_GROUP_SIZE(gpu) DRAPE_SOLVE_CPU_GROUP
#else
#define DRAPE_GROUP_SIZE(gpu) gpu
#endif
#define DRAPE_SOLVE(name, group)                                                                                \
    __kernel __attribute__((reqd_work_group_size(DRAPE_GROUP_SIZE(group), 1, 1))) void name(DRAPE_SOLVE_CLOTHS) \
    {                                                                                                           \
        __local uint shared, pushingBatches[DRAPE_RECORDED_BATCHES];                                            \
        solveCloth(&layout, input, topology, contacts, work, nodes, pushingBatches, &shared);                   \
    }
DRAPE_SOLVE(solveCloths, DRAPE_SOLVE_GROUP)
DRAPE_SOLVE(solveSmallCloths, DRAPE_SOLVE_SMALL_GROUP)
