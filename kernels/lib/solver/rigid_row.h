// Projects rows of a cloth's nodes beside rigid bodies (core/solver/rigid_rows.h), one text for host and device.
#ifndef DRAPE_LIB_RIGID_ROW_H
#define DRAPE_LIB_RIGID_ROW_H

#include "../../shared/rigid.h"
#include "../geometry/vec3.h"
#include "solver_node.h"

DRAPE_NAMESPACE_BEGIN

// A cloth and the bodies of its rows in a substep.
typedef struct RigidSubstep
{
    DRAPE_NODE_SPACE SolverNode* m_nodes;
    DRAPE_GLOBAL NodeState* m_states;
    const DRAPE_GLOBAL NodePath* m_paths;
    DRAPE_GLOBAL RigidBody* m_bodies;
    DRAPE_GLOBAL RigidGiven* m_given;
    float m_time;           // s, of the substep
    float m_perCorrection;  // 1/s, velocity per metre of a correction
    float m_passed;         // share of the step that has passed at the substep's end
    float m_left;           // s, from the substep's start to the step's end
} RigidSubstep;

// Returns the time from a substep's start to the step's end, s. time: s, of each of `count` substeps.
DRAPE_FUNCTION float rigidLeft(float time, DRAPE_UINT count, DRAPE_UINT substep)
{
    return time * (float)(count - substep);
}

DRAPE_FUNCTION Vec3 rigidProduct(const DRAPE_GLOBAL Vec3* rows, Vec3 v)
{
    return vec3(vec3Dot(rows[0], v), vec3Dot(rows[1], v), vec3Dot(rows[2], v));
}

DRAPE_FUNCTION Vec3 rigidByAxis(Vec3 a, Vec3 b)
{
    return vec3(a.x * b.x, a.y * b.y, a.z * b.z);
}

// Returns the velocity of a body's point, m/s. arm: m, from the centre of mass.
DRAPE_FUNCTION Vec3 rigidVelocity(const DRAPE_GLOBAL RigidBody* body, Vec3 arm)
{
    return vec3Add(body->m_velocity, vec3Cross(body->m_spin, arm));
}

// Returns how far along a direction a unit push along it moves a body's point in the substep, 1/kg.
DRAPE_FUNCTION float rigidMobility(const RigidSubstep* substep, const DRAPE_GLOBAL RigidBody* body, Vec3 arm,
                                   Vec3 direction)
{
    const Vec3 spin = rigidProduct(body->m_inverseInertia, vec3Cross(arm, direction));
    const Vec3 velocity = vec3Add(rigidByAxis(body->m_inverseMass, direction), vec3Cross(spin, arm));
    return vec3Dot(direction, velocity) * (substep->m_time * substep->m_perCorrection);
}

// Gives the body an impulse at a point, N s.
DRAPE_FUNCTION void rigidGive(const RigidSubstep* substep, DRAPE_GLOBAL RigidBody* body, Vec3 arm, Vec3 impulse)
{
    const Vec3 turning = vec3Cross(arm, impulse), velocity = rigidByAxis(body->m_inverseMass, impulse);
    const Vec3 spin = rigidProduct(body->m_inverseInertia, turning);
    body->m_velocity = vec3Add(body->m_velocity, velocity);
    body->m_spin = vec3Add(body->m_spin, spin);
    body->m_impulse = vec3Add(body->m_impulse, impulse);
    body->m_turning = vec3Add(body->m_turning, turning);
    Vec3 centre = body->m_centre;
    if (body->m_follows)
    {
        body->m_shift = vec3AddScaled(body->m_shift, velocity, substep->m_left);
        body->m_turn = vec3AddScaled(body->m_turn, spin, substep->m_left);
        // The body's place as the substep begins.
        const Vec3 motion = vec3Add(body->m_velocity, body->m_displaced);
        centre = vec3AddScaled(vec3Add(centre, body->m_shift), motion, -substep->m_left);
        centre =
            vec3AddScaled(centre, body->m_acceleration, 0.5f * substep->m_left * (substep->m_left - substep->m_time));
    }
    DRAPE_GLOBAL RigidGiven* given = substep->m_given;
    const Vec3 from = vec3Add(vec3Sub(centre, given->m_reference), arm);
    given->m_impulse = vec3Add(given->m_impulse, impulse);
    given->m_turning = vec3Add(given->m_turning, vec3Cross(from, impulse));
}

DRAPE_FUNCTION void rigidShiftNode(const RigidSubstep* substep, DRAPE_UINT node, Vec3 by)
{
    nodeShift(substep->m_nodes + node, substep->m_states + node, vec3Scale(by, substep->m_nodes[node].m_inverseMass));
}

// Pushes the node, and the body the other way. by: direction times multiplier, kg m.
DRAPE_FUNCTION void rigidPush(const RigidSubstep* substep, DRAPE_UINT node, DRAPE_GLOBAL RigidBody* body, Vec3 arm,
                              Vec3 by)
{
    rigidShiftNode(substep, node, by);
    if (body->m_moves) rigidGive(substep, body, arm, vec3Scale(by, -substep->m_perCorrection));
}

DRAPE_FUNCTION void rigidBeginRow(DRAPE_GLOBAL RigidRowState* state)
{
    state->m_held = vec3(0.0f, 0.0f, 0.0f);
    state->m_multiplier = 0.0f;
}

// Ends a substep: the body's point has gone on with the body's velocity.
DRAPE_FUNCTION void rigidEndRow(const RigidSubstep* substep, DRAPE_UINT body, Vec3 arm,
                                DRAPE_GLOBAL RigidRowState* state)
{
    state->m_carried = vec3AddScaled(state->m_carried, rigidVelocity(substep->m_bodies + body, arm), substep->m_time);
}

// Returns the displacement of a body's point from the step's start to the substep's end, m.
DRAPE_FUNCTION Vec3 rigidCarried(const RigidSubstep* substep, const DRAPE_GLOBAL RigidBody* body, Vec3 arm,
                                 const DRAPE_GLOBAL RigidRowState* state)
{
    return vec3AddScaled(state->m_carried, rigidVelocity(body, arm), substep->m_time);
}

// Returns how far a point beside a plane is below the level that the step allows, m. displacement: m, of the point,
// less that of the plane.
DRAPE_FUNCTION float rigidViolation(const DRAPE_GLOBAL RigidPlane* plane, Vec3 displacement, float passed)
{
    const float level = plane->m_gap < 0.0f ? plane->m_recover * passed : -plane->m_gap;
    return level - vec3Dot(plane->m_normal, displacement);
}

// Computes the push that makes a contact hold, or takes back an earlier push that is not needed any more. mobility:
// 1/kg, of both sides. relaxation: share of a violation that is corrected. by: kg m, for the cloth. Returns whether
// there is anything to do.
DRAPE_FUNCTION int rigidContactPush(const DRAPE_GLOBAL RigidPlane* contact, Vec3 displacement, float passed,
                                    float mobility, float relaxation, DRAPE_GLOBAL RigidRowState* state, Vec3* by)
{
    const RigidPlane plane = *contact;
    const float inverseMobility = 1.0f / drapeMax(mobility, 1e-30f);
    const float along = vec3Dot(plane.m_normal, displacement), before = state->m_multiplier;
    const float violation = rigidViolation(contact, displacement, passed);
    if (!(violation > 0.0f) && !(before > 0.0f)) return 0;
    const float pushed = drapeMax(0.0f, before + relaxation * violation * inverseMobility);
    Vec3 held = vec3AddScaled(state->m_held, vec3AddScaled(displacement, plane.m_normal, -along), -inverseMobility);
    const float most = plane.m_friction * pushed, wanted = vec3Length(held);
    if (wanted > most) held = vec3Scale(held, most / wanted);
    *by = vec3AddScaled(vec3Sub(held, state->m_held), plane.m_normal, pushed - before);
    state->m_multiplier = pushed;
    state->m_held = held;
    return 1;
}

DRAPE_FUNCTION void rigidProjectContact(const RigidSubstep* substep, const DRAPE_GLOBAL RigidContact* contact,
                                        DRAPE_GLOBAL RigidRowState* state)
{
    DRAPE_GLOBAL RigidBody* body = substep->m_bodies + contact->m_body;
    const float inverseMass = substep->m_paths[contact->m_node].m_inverseMass;
    if (!(inverseMass > 0.0f)) return;
    const Vec3 arm = contact->m_arm;
    const Vec3 displacement =
        vec3Sub(substep->m_nodes[contact->m_node].m_displacement, rigidCarried(substep, body, arm, state));
    const float mobility = inverseMass + rigidMobility(substep, body, arm, contact->m_plane.m_normal);
    Vec3 by;
    if (rigidContactPush(&contact->m_plane, displacement, substep->m_passed, mobility, 1.0f, state, &by))
        rigidPush(substep, contact->m_node, body, arm, by);
}

DRAPE_FUNCTION void rigidProjectAnchor(const RigidSubstep* substep, const DRAPE_GLOBAL RigidAnchor* anchor,
                                       const DRAPE_GLOBAL RigidRowState* state)
{
    DRAPE_GLOBAL RigidBody* body = substep->m_bodies + anchor->m_body;
    const Vec3 arm = anchor->m_arm;
    for (int axis = 0; axis < 3; ++axis)
    {
        const Vec3 direction = vec3(axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f);
        const Vec3 carried = vec3AddScaled(state->m_carried, rigidVelocity(body, arm), substep->m_time);
        const Vec3 wanted = vec3AddScaled(carried, anchor->m_apart, substep->m_passed);
        const float error = vec3Dot(direction, vec3Sub(wanted, substep->m_nodes[anchor->m_node].m_displacement));
        const float both =
            substep->m_nodes[anchor->m_node].m_inverseMass + rigidMobility(substep, body, arm, direction);
        if (!(both > 0.0f)) continue;
        rigidPush(substep, anchor->m_node, body, arm, vec3Scale(direction, anchor->m_share * error / both));
    }
}

DRAPE_NAMESPACE_END

#endif
