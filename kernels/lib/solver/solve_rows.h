// Rows of a group's contacts, and pushes of single contacts (core/solver/host/contact_group.h).
#ifndef DRAPE_LIB_SOLVE_ROWS_H
#define DRAPE_LIB_SOLVE_ROWS_H

#include "acting_contact.h"
#include "../geometry/rigid_motion.h"
#include "solve_view.h"

// A sweep over contacts: its phase, counted from 1, and where obstacles stand.
typedef struct Sweep
{
    uint m_phase;
    float m_passed;      // share of the step that has passed
    float m_tolerated;   // m, violation that a projection leaves
    float m_slack;       // m, bound on how far levels lie above those at the step's end
    float m_relaxation;  // share of a violation that a projection corrects
    uint m_round;        // see nextRound()
    uint m_pending;      // the word that says whether a contact is due in this round
    float m_worst;       // m, worst violation that the work-item met
} Sweep;

DRAPE_HOT_FUNCTION void beginSweep(const Solve* solve, const uint substep, const int closes, Sweep* sweep)
{
    sweep->m_phase = substep + 1;
    sweep->m_passed = closes ? 1.0f : (float)(substep + 1) / (float)solve->m_cloth->m_substeps;
    sweep->m_tolerated = closes ? solve->m_cloth->m_tolerated : 0.0f;
    sweep->m_slack = (1.0f - sweep->m_passed) * solve->m_cloth->m_retreat;
    sweep->m_relaxation = closes ? 1.0f : DRAPE_TURN_RELAXATION;
    sweep->m_worst = 0.0f;
}

// Begins sweeps in a substep. The rounds go on.
DRAPE_HOT_FUNCTION void beginSubstep(const Solve* solve, const uint substep, Sweep* sweep)
{
    beginSweep(solve, substep, 0, sweep);
}

// Begins a sweep that closes the contacts.
DRAPE_HOT_FUNCTION void beginClosing(const Solve* solve, Sweep* sweep)
{
    beginSweep(solve, solve->m_cloth->m_substeps, 1, sweep);
}

DRAPE_HOT_FUNCTION SolveContact loadContact(const Solve* solve, const uint index)
{
    __global const float4* words = (__global const float4*)(solve->m_sorted + index);
    const float4 first = words[0], second = words[1], third = words[2];
    SolveContact contact;
    contact.m_normal = xyz(first);
    contact.m_level = first.w;
    contact.m_weights[0] = second.x;
    contact.m_weights[1] = second.y;
    contact.m_flags = as_uint(second.z);
    contact.m_pushing = as_uint(second.w);
    contact.m_nodes[0] = as_uint(third.x);
    contact.m_nodes[1] = as_uint(third.y);
    contact.m_nodes[2] = as_uint(third.z);
    contact.m_rank = as_uint(third.w);
    return contact;
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

static uint firstOf(__global const MeshOffsets* mesh, const uint kind)
{
    if (kind == DRAPE_NODE_FACE) return mesh->m_triangle;
    return kind == DRAPE_FACE_VERTEX ? mesh->m_vertex : mesh->m_edge;
}

// Returns the surface of a contact's obstacle.
static __global const SolveSurface* surfaceOf(const Solve* solve, __global const Contact* contact)
{
    const SolveRange range = solve->m_cloth->m_surfaces;
    __global const SolveSurface* first = solve->m_surfaces + range.m_first;
    if (range.m_count == 1) return first;
    // The last obstacle that begins with the feature or before it. Obstacles without such features begin where the next
    // one does.
    uint low = 0, high = solve->m_obstacleCount;
    while (high - low > 1)
    {
        const uint middle = (low + high) / 2;
        if (firstOf(solve->m_obstacles + middle, contact->m_kind) <= contact->m_obstacleFeature)
            low = middle;
        else
            high = middle;
    }
    uint least = 0, most = range.m_count;
    while (most - least > 1)
    {
        const uint middle = (least + most) / 2;
        if (first[middle].m_obstacle <= low)
            least = middle;
        else
            most = middle;
    }
    return first + least;
}

static Vec3 carriedStart(__global const SolveSurface* surface, const Vec3 start)
{
    return surface->m_moves ? mapPoint(surface->m_map, start) : start;
}

static FeatureNodes featureNodes(const Solve* solve, const SolveContact* contact, __global const SolveSurface* surface)
{
    FeatureNodes nodes;
    nodes.m_count = DRAPE_CONTACT_COUNT(contact->m_flags);
    nodes.m_moves = surface->m_moves;
    for (uint k = 0; k < 3; ++k)
    {
        __global const NodePath* path = solve->m_paths + contact->m_nodes[k];
        nodes.m_nodes[k] = contact->m_nodes[k];
        nodes.m_starts[k] = path->m_start;
        nodes.m_carried[k] = carriedStart(surface, path->m_start);
        nodes.m_ends[k] = vec3Add(path->m_start, path->m_vector);
        nodes.m_inverseMasses[k] = path->m_inverseMass;
    }
    return nodes;
}

// The nodes' displacements of a feature; entries beyond the last node repeat the first.
typedef struct Displacements
{
    Vec3 m_nodes[3];
} Displacements;

DRAPE_HOT_FUNCTION Displacements displacementsOf(const Solve* solve, const SolveContact* contact)
{
    Displacements at;
    for (int k = 0; k < 3; ++k)
        at.m_nodes[k] = loadNode(solve, contact->m_nodes[k]).m_displacement;
    return at;
}

// Returns an upper bound of a contact's violation once the obstacle stands at the step's end, m.
DRAPE_HOT_FUNCTION float excessOf(const SolveContact* contact, const Displacements* at)
{
    const Vec3 first = at->m_nodes[0];
    const Vec3 second = vec3Scale(vec3Sub(at->m_nodes[1], first), contact->m_weights[0]);
    const Vec3 third = vec3Scale(vec3Sub(at->m_nodes[2], first), contact->m_weights[1]);
    return contact->m_level - vec3Dot(contact->m_normal, vec3Add(first, vec3Add(second, third)));
}

// Makes the row of a contact.
DRAPE_RARE_FUNCTION void makeActing(const Solve* solve, const uint index, const SolveContact* contact)
{
    __global const Contact* found = solve->m_contacts + solve->m_order[index];
    __global const SolveSurface* surface = surfaceOf(solve, found);
    const FeatureNodes nodes = featureNodes(solve, contact, surface);
    const ContactPlane plane = foundPlane(found);
    ContactSettings settings;
    settings.m_thickness = surface->m_thickness;
    settings.m_friction = surface->m_friction;
    settings.m_hardness = solve->m_cloth->m_hardness;
    settings.m_perSecond = solve->m_cloth->m_perSecond;
    solve->m_acting[index] = actingContact(&nodes, &plane, &settings, contactGaps(&nodes, &plane, &settings));
    solve->m_sorted[index].m_flags = contact->m_flags | DRAPE_CONTACT_MADE;
}

// Renews the plane of a contact that turns.
DRAPE_RARE_FUNCTION void renew(const Solve* solve, const uint index, const SolveContact* contact, const uint phase,
                               const float passed)
{
    ActingContact acting = solve->m_acting[index];
    __global const Contact* found = solve->m_contacts + solve->m_order[index];
    const FeatureNodes nodes = featureNodes(solve, contact, surfaceOf(solve, found));
    const Displacements at = displacementsOf(solve, contact);
    const ContactPlane before = foundPlane(found);
    ContactPlane plane;
    acting.m_phase = phase;
    const int turned = renewPlane(&acting, &nodes, at.m_nodes, passed, &before, &plane);
    solve->m_acting[index] = acting;
    if (!turned) return;
    __global SolveContact* bound = solve->m_sorted + index;
    bound->m_normal = plane.m_normal;
    bound->m_level = acting.m_row.m_level + solve->m_cloth->m_margin;
    bound->m_weights[0] = plane.m_weights[1];
    bound->m_weights[1] = plane.m_weights[2];
}

// Loads what pushes need of a contact, as vectors: all but the nodes.
DRAPE_HOT_FUNCTION ActingContact loadActing(const Solve* solve, const uint index)
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
    acting.m_phase = as_uint(rest.w);
    return acting;
}

DRAPE_HOT_FUNCTION Vec3 rowDisplacementOf(const ActingContact* acting, const uint count, const Displacements* at)
{
    Vec3 displacement = vec3Scale(at->m_nodes[0], acting->m_row.m_weights[0]);
    if (count > 1) displacement = vec3AddScaled(displacement, at->m_nodes[1], acting->m_row.m_weights[1]);
    if (count > 2) displacement = vec3AddScaled(displacement, at->m_nodes[2], acting->m_row.m_weights[2]);
    return displacement;
}

// Loads the row of a contact. Its pushes begin anew in each phase.
DRAPE_HOT_FUNCTION ActingContact loadRow(const Solve* solve, const uint index, const SolveContact* contact,
                                         const uint phase)
{
    ActingContact acting = loadActing(solve, index);
    if (contact->m_pushing != phase)
    {
        acting.m_row.m_multiplier = 0.0f;
        acting.m_row.m_held = vec3(0.0f, 0.0f, 0.0f);
    }
    return acting;
}

// Makes the row of a contact if it has none, and loads it.
DRAPE_HOT_FUNCTION ActingContact openRow(const Solve* solve, const uint index, const SolveContact* contact,
                                         const uint phase)
{
    if (!(contact->m_flags & DRAPE_CONTACT_MADE))
    {
        const Solve view = *solve;
        const SolveContact copy = *contact;
        makeActing(&view, index, &copy);
    }
    return loadRow(solve, index, contact, phase);
}

// Pushes the nodes of a contact with an open row. Returns whether there was anything to do.
DRAPE_HOT_FUNCTION int pushContact(const Solve* solve, const uint index, const SolveContact* contact,
                                   ActingContact* acting, Sweep* sweep)
{
    const uint count = DRAPE_CONTACT_COUNT(contact->m_flags);
    const Displacements at = displacementsOf(solve, contact);
    Vec3 shift;
    if (!pushRow(&acting->m_row, rowDisplacementOf(acting, count, &at), sweep->m_passed, sweep->m_tolerated,
                 sweep->m_relaxation, &sweep->m_worst, &shift))
        return 0;
    const Vec3 held = acting->m_row.m_held;
    ((__global float4*)(solve->m_acting + index))[2] = (float4)(held.x, held.y, held.z, acting->m_row.m_multiplier);
    for (uint k = 0; k < count; ++k)
        nodeAt(solve, contact->m_nodes[k])->m_displacement =
            vec3AddScaled(at.m_nodes[k], shift, acting->m_row.m_shares[k]);  // the inverse mass beside it stays
    if (contact->m_pushing == sweep->m_phase) return 1;
    for (uint k = 0; k < count; ++k)
        solve->m_states[contact->m_nodes[k]].m_shifted |= DRAPE_NODE_SHIFTED | DRAPE_NODE_PUSHED;
    solve->m_acting[index].m_pushed = 1;
    solve->m_sorted[index].m_pushing = sweep->m_phase;
    return 1;
}

// Projects a contact that is violated or pushes, with an open row. Returns whether it pushed.
DRAPE_HOT_FUNCTION int projectContact(const Solve* solve, const uint index, const SolveContact* contact,
                                      ActingContact* acting, Sweep* sweep)
{
    if (!(acting->m_row.m_inverseMobility > 0.0f)) return 0;
    if ((contact->m_flags & DRAPE_CONTACT_TURNS) && acting->m_phase != sweep->m_phase)
    {
        const Displacements at = displacementsOf(solve, contact);
        const Vec3 displacement = rowDisplacementOf(acting, DRAPE_CONTACT_COUNT(contact->m_flags), &at);
        const float level = acting->m_row.m_level - (1.0f - sweep->m_passed) * acting->m_row.m_advance;
        if (level - vec3Dot(acting->m_row.m_normal, displacement) > 0.0f)
        {
            const Solve view = *solve;
            const SolveContact copy = *contact;
            renew(&view, index, &copy, sweep->m_phase, sweep->m_passed);
            *acting = loadRow(solve, index, contact, sweep->m_phase);
            if (!(acting->m_row.m_inverseMobility > 0.0f)) return 0;
        }
    }
    return pushContact(solve, index, contact, acting, sweep);
}

// Returns whether the contact is violated or pushes.
DRAPE_HOT_FUNCTION int isDue(const Solve* solve, const SolveContact* contact, const Sweep* sweep)
{
    if (contact->m_pushing == sweep->m_phase) return 1;
    const Displacements at = displacementsOf(solve, contact);
    return excessOf(contact, &at) + sweep->m_slack > 0.0f;
}

#endif
