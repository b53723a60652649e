// Solves a step of cloths: substeps, links, contacts and limits, as core/solver/step_solver.h describes.
//
// Each work-group solves one cloth. Links and contacts of one colour share no node, so its work-items visit them side
// by side; colours and passes are separated by barriers. The result is the host's, bit for bit. docs/decisions/ tells
// why a work-group has a whole cloth.
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
    __global SolverNode* m_nodes;
    __global NodeState* m_states;
    __global SolvePlane* m_planes;
    __global ActingContact* m_acting;
    __global SolveAllowance* m_allowances;
} Solve;

// A sweep over contacts: its stage, counted from 1, and where obstacles stand.
typedef struct Sweep
{
    uint m_stage;
    float m_passed;  // share of the step that has passed
    float m_slack;   // m, bound on how far levels lie above those at the step's end
} Sweep;

#define forAll(i, count) for (uint i = get_local_id(0); i < (count); i += get_local_size(0))

// A CPU's group has one work-item: compilers for CPUs copy the code behind each barrier that is not always reached.
static void syncGroup(void)
{
#ifndef DRAPE_CPU
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
#endif
}

// Returns whether a work-item's flag is set in any of the group's.
static int anyInGroup(const int flag, __local uint* shared)
{
    if (get_local_id(0) == 0) *shared = 0;
    syncGroup();
    if (flag) atomic_or(shared, 1u);
    syncGroup();
    const int any = *shared != 0;
    syncGroup();
    return any;
}

// Returns the greatest of the work-items' values, none of which is negative.
static float mostInGroup(const float value, __local uint* shared)
{
    if (get_local_id(0) == 0) *shared = 0;
    syncGroup();
    atomic_max(shared, as_uint(value));
    syncGroup();
    const float most = as_float(*shared);
    syncGroup();
    return most;
}

static void visitBatchLink(const Solve* solve, const uint index)
{
    const SolveLink link = solve->m_links[index];
    const uint a = link.m_nodes[0], b = link.m_nodes[1];
    const Vec3 apart = vec3Sub(solve->m_paths[b].m_start, solve->m_paths[a].m_start);
    visitLink(solve->m_nodes + a, solve->m_nodes + b, apart, link.m_restSquared, link.m_strength);
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
        syncGroup();
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

// Returns an upper bound of a contact's violation, m.
static float excessOf(const Solve* solve, const SolveFeature* feature, const SolvePlane* plane, const float slack)
{
    const Vec3 first = solve->m_nodes[feature->m_nodes[0]].m_displacement;
    Vec3 at = first;
    for (uint k = 1; k < feature->m_nodeCount; ++k)
    {
        const Vec3 way = vec3Sub(solve->m_nodes[feature->m_nodes[k]].m_displacement, first);
        at = vec3AddScaled(at, way, plane->m_weights[k - 1]);
    }
    return plane->m_level + slack - vec3Dot(plane->m_normal, at);
}

static void makeActing(const Solve* solve, const SolveFeature* feature, const uint index)
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

// Renews the plane of a face's contact with a vertex that was not met. Others keep theirs.
static void renew(const Solve* solve, const SolveFeature* feature, const uint index, const float passed,
                  ActingContact* acting)
{
    __global const Contact* found = solve->m_contacts + index;
    if (found->m_kind != DRAPE_FACE_VERTEX || found->m_time < 1.0f) return;
    const FeatureNodes nodes = featureNodes(solve, feature, solve->m_surfaces + solve->m_surfaceOf[index]);
    Vec3 displacements[3];
    for (uint k = 0; k < 3; ++k)
        displacements[k] = solve->m_nodes[nodes.m_nodes[k]].m_displacement;
    const ContactPlane before = foundPlane(found);
    ContactPlane plane;
    if (!renewPlane(acting, &nodes, displacements, passed, &before, &plane)) return;
    __global SolvePlane* bound = solve->m_planes + index;
    bound->m_normal = plane.m_normal;
    bound->m_level = acting->m_row.m_level + solve->m_cloth->m_margin;
    bound->m_weights[0] = plane.m_weights[1];
    bound->m_weights[1] = plane.m_weights[2];
}

// Projects a contact that is violated or pushes. `worst` grows to its violation.
static void projectContact(const Solve* solve, const SolveFeature* feature, const uint index, const Sweep* sweep,
                           float* worst)
{
    __global SolvePlane* plane = solve->m_planes + index;
    if (!plane->m_made) makeActing(solve, feature, index);
    plane->m_made = 1;
    ActingContact acting = solve->m_acting[index];
    if (plane->m_pushing != sweep->m_stage)
    {
        acting.m_row.m_multiplier = 0.0f;
        acting.m_row.m_held = vec3(0.0f, 0.0f, 0.0f);
    }
    if (!(acting.m_row.m_inverseMobility > 0.0f)) return;
    if (acting.m_stage != sweep->m_stage && rowViolation(&acting.m_row, solve->m_nodes, sweep->m_passed) > 0.0f)
    {
        renew(solve, feature, index, sweep->m_passed, &acting);
        acting.m_stage = sweep->m_stage;
    }
    if (acting.m_row.m_inverseMobility > 0.0f && projectRow(&acting.m_row, solve->m_nodes, sweep->m_passed, worst))
    {
        for (uint k = 0; k < feature->m_nodeCount; ++k)
            solve->m_states[feature->m_nodes[k]].m_shifted = 1;
        acting.m_pushed = 1;
        plane->m_pushing = sweep->m_stage;
    }
    solve->m_acting[index] = acting;
}

static void visitFeature(const Solve* solve, const uint index, const Sweep* sweep, float* worst)
{
    const SolveFeature feature = solve->m_features[index];
    for (uint i = feature.m_firstContact; i < feature.m_firstContact + feature.m_contactCount; ++i)
    {
        const SolvePlane plane = solve->m_planes[i];
        if (plane.m_pushing == sweep->m_stage || excessOf(solve, &feature, &plane, sweep->m_slack) > 0.0f)
            projectContact(solve, &feature, i, sweep, worst);
    }
}

// Visits the features of some batches. Returns the worst violation that the work-item met, m.
static float sweepBatches(const Solve* solve, const SolveRange range, const Sweep* sweep)
{
    float worst = 0.0f;
    for (uint i = 0; i < range.m_count; ++i)
    {
        const SolveBatch batch = solve->m_batches[range.m_first + i];
        if (!batch.m_serial)
            for (uint k = batch.m_first + get_local_id(0); k < batch.m_last; k += get_local_size(0))
                visitFeature(solve, k, sweep, &worst);
        else if (get_local_id(0) == 0)
            for (uint k = batch.m_first; k < batch.m_last; ++k)
                visitFeature(solve, k, sweep, &worst);
        syncGroup();
    }
    return worst;
}

static float sweepContacts(const Solve* solve, const Sweep* sweep)
{
    const float first = sweepBatches(solve, solve->m_cloth->m_faceBatches, sweep);
    return drapeMax(first, sweepBatches(solve, solve->m_cloth->m_edgeBatches, sweep));
}

// Sets the bounding planes of a feature's contacts, and marks its nodes.
static void beginFeature(const Solve* solve, const uint index)
{
    const SolveFeature feature = solve->m_features[index];
    const Vec3 first = solve->m_paths[feature.m_nodes[0]].m_start;
    for (uint i = feature.m_firstContact; i < feature.m_firstContact + feature.m_contactCount; ++i)
    {
        const ContactPlane found = foundPlane(solve->m_contacts + i);
        Vec3 start = first;
        for (uint k = 1; k < feature.m_nodeCount; ++k)
            start = vec3AddScaled(start, vec3Sub(solve->m_paths[feature.m_nodes[k]].m_start, first),
                                  found.m_weights[k]);
        SolvePlane plane;
        plane.m_normal = found.m_normal;
        plane.m_level = solve->m_cloth->m_mostThickness + vec3Dot(found.m_normal, vec3Sub(found.m_point, start)) +
                        solve->m_cloth->m_margin;
        plane.m_weights[0] = found.m_weights[1];
        plane.m_weights[1] = found.m_weights[2];
        plane.m_made = plane.m_pushing = 0;
        solve->m_planes[i] = plane;
    }
    for (uint k = 0; k < feature.m_nodeCount; ++k)
        solve->m_allowances[feature.m_nodes[k]].m_hasContact = 1;
}

static void beginStep(const Solve* solve)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    forAll (i, cloth->m_nodes.m_count)
    {
        const NodePath path = solve->m_paths[i];
        solve->m_nodes[i].m_inverseMass = path.m_freeMass;
        nodeBegin(solve->m_nodes + i, solve->m_states + i, path.m_way, solve->m_accelerations[i], cloth->m_perStep,
                  cloth->m_pathShare);
        solve->m_states[i].m_shifted = 0;
        solve->m_allowances[i].m_hasContact = 0;
    }
    syncGroup();
    forAll (i, cloth->m_features.m_count)
        beginFeature(solve, cloth->m_features.m_first + i);
    syncGroup();
}

// Returns whether what the node or its faces may pass between the ends of their paths and their positions meets the
// region.
static int isNearRegion(const Solve* solve, const uint node, __global const SolveRegion* region)
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
static void limitByResting(const Solve* solve, const int withContacts)
{
    const SolveRange regions = solve->m_cloth->m_regions;
    forAll (node, solve->m_cloth->m_nodes.m_count)
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
    syncGroup();
    forAll (node, solve->m_cloth->m_nodes.m_count)
    {
        const SolveAllowance allowance = solve->m_allowances[node];
        if (!solve->m_states[node].m_isFar || allowance.m_end == DRAPE_INFINITY) continue;
        bringBack(solve->m_nodes + node, solve->m_states + node, vec3(0.0f, 0.0f, 0.0f), solve->m_paths[node].m_way,
                  allowance.m_start, allowance.m_end);
    }
    syncGroup();
}

static void limitByMoving(const Solve* solve, __global const SolveRegion* region)
{
    forAll (node, solve->m_cloth->m_nodes.m_count)
        solve->m_allowances[node].m_isNear =
            solve->m_states[node].m_isFar ? isNearRegion(solve, node, region) : 0;
    syncGroup();
    forAll (node, solve->m_cloth->m_nodes.m_count)
    {
        if (!solve->m_allowances[node].m_isNear) continue;
        const Vec3 from = solve->m_paths[node].m_start;
        const Vec3 start = vec3Sub(carriedStart(solve->m_surfaces + region->m_surface, from), from);
        const float end = solve->m_allowances[node].m_hasContact ? region->m_start : region->m_end;
        bringBack(solve->m_nodes + node, solve->m_states + node, start, solve->m_paths[node].m_way, region->m_start,
                  end);
    }
    syncGroup();
}

// Marks the nodes that the limit may bring back. Returns whether there are any.
static int findFarNodes(const Solve* solve, __local uint* shared)
{
    int any = 0;
    forAll (node, solve->m_cloth->m_nodes.m_count)
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
    forAll (node, cloth->m_nodes.m_count)
    {
        if (!solve->m_allowances[node].m_hasContact) continue;
        if (!isFarFromEnd(solve->m_nodes + node, solve->m_paths + node, cloth->m_sure)) continue;
        bringBack(solve->m_nodes + node, solve->m_states + node, vec3(0.0f, 0.0f, 0.0f), solve->m_paths[node].m_way,
                  cloth->m_leastTolerance, cloth->m_leastTolerance);
    }
    syncGroup();
}

static void runSubstep(const Solve* solve, const uint substep, __local uint* shared)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    forAll (i, cloth->m_nodes.m_count)
        nodeAdvance(solve->m_nodes + i, solve->m_states + i, solve->m_accelerations[i], cloth->m_substepTime);
    syncGroup();
    // Limits beside a moving obstacle hold at the step's end alone.
    if (substep > 0 && (cloth->m_rests || substep + 1 == cloth->m_substeps))
    {
        applyLimits(solve, shared);
        forAll (i, cloth->m_nodes.m_count)
            nodeLimitShift(solve->m_nodes + i, solve->m_states + i, cloth->m_perCorrection, cloth->m_perSecond);
        syncGroup();
    }
    Sweep sweep;
    sweep.m_stage = substep + 1;
    sweep.m_passed = (float)(substep + 1) / (float)cloth->m_substeps;
    sweep.m_slack = (1.0f - sweep.m_passed) * cloth->m_retreat;
    for (uint i = 0; i < cloth->m_linkSweeps; ++i)
    {
        sweepLinks(solve);
        sweepContacts(solve, &sweep);
    }
    forAll (i, cloth->m_nodes.m_count)
        nodeEnd(solve->m_nodes + i, solve->m_states + i, cloth->m_perCorrection, cloth->m_kept);
    syncGroup();
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
    sweep.m_slack = 0.0f;
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
    if (worst > cloth->m_fineViolation) sweepBatches(solve, cloth->m_nodeBatches, &sweep);
    if (cloth->m_rests && findFarNodes(solve, shared)) limitByResting(solve, 0);
    return done;
}

// Limits the speeds that a batch's contacts gave. Returns whether one of them ends so near that a surface may have been
// passed.
static int limitSpeeds(const Solve* solve, const SolveRange range)
{
    int near = 0;
    for (uint b = 0; b < range.m_count; ++b)
    {
        const SolveBatch batch = solve->m_batches[range.m_first + b];
        const uint step = batch.m_serial ? 1 : get_local_size(0);
        const uint first = batch.m_serial && get_local_id(0) != 0 ? batch.m_last
                                                                   : batch.m_first + (batch.m_serial ? 0 : get_local_id(0));
        for (uint k = first; k < batch.m_last; k += step)
        {
            const SolveFeature feature = solve->m_features[k];
            for (uint i = feature.m_firstContact; i < feature.m_firstContact + feature.m_contactCount; ++i)
            {
                if (!solve->m_planes[i].m_made) continue;
                const ActingContact acting = solve->m_acting[i];
                if (!acting.m_pushed) continue;
                limitSpeed(&acting, solve->m_states);
                near |= acting.m_distance - rowViolation(&acting.m_row, solve->m_nodes, 1.0f) <
                        solve->m_cloth->m_nearDistance;
            }
        }
        syncGroup();
    }
    return near;
}

// A work-group solves the cloth of its number, whatever its size.
__kernel void solveCloths(DRAPE_SOLVE_CLOTHS)
{
    __local uint shared;
    Solve solve;
    __global const SolveCloth* cloth = (__global const SolveCloth*)(input + layout.m_cloths) + get_group_id(0);
    const uint firstNode = cloth->m_nodes.m_first;
    solve.m_cloth = cloth;
    solve.m_paths = (__global const NodePath*)(input + layout.m_paths) + firstNode;
    solve.m_accelerations = (__global const Vec3*)(input + layout.m_accelerations) + firstNode;
    solve.m_batches = (__global const SolveBatch*)(input + layout.m_batches);
    solve.m_features = (__global const SolveFeature*)(input + layout.m_features);
    solve.m_surfaceOf = (__global const uint*)(input + layout.m_surfaceOf);
    solve.m_surfaces = (__global const SolveSurface*)(input + layout.m_surfaces);
    solve.m_regions = (__global const SolveRegion*)(input + layout.m_regions);
    solve.m_links = (__global const SolveLink*)(topology + layout.m_links);
    solve.m_faceLists = (__global const uint*)(topology + layout.m_faceLists) + cloth->m_faceLists;
    solve.m_facesOfNode = (__global const uint*)(topology + layout.m_facesOfNode);
    solve.m_faces = (__global const int*)(topology + layout.m_faces);
    solve.m_contacts = contacts;
    solve.m_nodes = (__global SolverNode*)(work + layout.m_nodes) + firstNode;
    solve.m_states = (__global NodeState*)(work + layout.m_states) + firstNode;
    solve.m_planes = (__global SolvePlane*)(work + layout.m_planes);
    solve.m_acting = (__global ActingContact*)(work + layout.m_acting);
    solve.m_allowances = (__global SolveAllowance*)(work + layout.m_allowances) + firstNode;

    beginStep(&solve);
    for (uint i = 0; i < cloth->m_substeps; ++i)
        runSubstep(&solve, i, &shared);
    forAll (i, cloth->m_nodes.m_count)
        nodeRemember(solve.m_nodes + i, solve.m_states + i);
    syncGroup();
    applyLimits(&solve, &shared);
    const uint sweeps = cloth->m_features.m_count > 0 ? closeContacts(&solve, &shared) : 0;
    forAll (i, cloth->m_nodes.m_count)
        nodeAddShift(solve.m_nodes + i, solve.m_states + i, cloth->m_perShift);
    syncGroup();
    int near = limitSpeeds(&solve, cloth->m_faceBatches);
    near |= limitSpeeds(&solve, cloth->m_edgeBatches);
    near = anyInGroup(near, &shared);
    if (get_local_id(0) > 0) return;
    __global SolveResult* result = (__global SolveResult*)(work + layout.m_results) + get_group_id(0);
    result->m_mayHavePassed = near;
    result->m_closingSweeps = sweeps;
}
