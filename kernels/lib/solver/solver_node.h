// Motion of one node in a substep, and what corrections do to its velocity (core/solver/solver_nodes.h).
#ifndef DRAPE_LIB_SOLVER_NODE_H
#define DRAPE_LIB_SOLVER_NODE_H

#include "../../shared/solver.h"
#include "../geometry/vec3.h"

DRAPE_NAMESPACE_BEGIN

// Bounds of nodeSettle(): the displacement in a step, as a share of the acceleration times the step's time squared, and
// the speed at its end, as a share of the acceleration times the time. Measured: docs/design_notes/contact_sweeps.md,
// "Rest".
#define DRAPE_SETTLED_DISPLACEMENT 0.015f
#define DRAPE_SETTLED_SPEED 0.006f

// Bound of the displacement, in the same unit, up to which corrections alone moved a node without such a speed, and the
// share of its displacement that remains then.
#define DRAPE_CORRECTED_DISPLACEMENT 0.165f
#define DRAPE_CORRECTED_SHARE 0.75f

// Puts a node with hardly any speed to rest: at its path's start if it hardly moved in the step, or at a share of its
// displacement if corrections moved it somewhat farther. Without acceleration nothing changes. acceleration: m/s², by
// gravity and forces. perStep: 1/s, the inverse of the step's time.
DRAPE_FUNCTION void nodeSettle(DRAPE_NODE_SPACE SolverNode* node, DRAPE_GLOBAL NodeState* state, Vec3 acceleration,
                               float perStep)
{
    const float most2 = vec3Dot(acceleration, acceleration);
    const Vec3 speed = vec3Scale(state->m_velocity, perStep / DRAPE_SETTLED_SPEED);
    const Vec3 moved = vec3Scale(node->m_displacement, perStep * perStep / DRAPE_SETTLED_DISPLACEMENT);
    const float farther = DRAPE_SETTLED_DISPLACEMENT / DRAPE_CORRECTED_DISPLACEMENT;
    if (!(vec3Dot(speed, speed) < most2) || !(vec3Dot(moved, moved) * (farther * farther) < most2)) return;
    const float share = vec3Dot(moved, moved) < most2 ? 0.0f : DRAPE_CORRECTED_SHARE;
    node->m_displacement = vec3Scale(node->m_displacement, share);
    state->m_velocity = vec3(0.0f, 0.0f, 0.0f);
}

DRAPE_FUNCTION void nodeRemember(const DRAPE_NODE_SPACE SolverNode* node, DRAPE_GLOBAL NodeState* state)
{
    state->m_before = node->m_displacement;
    state->m_shifted &= DRAPE_NODE_PUSHED;
}

DRAPE_FUNCTION void nodeShift(DRAPE_NODE_SPACE SolverNode* node, DRAPE_GLOBAL NodeState* state, Vec3 by)
{
    node->m_displacement = vec3Add(node->m_displacement, by);
    state->m_shifted |= DRAPE_NODE_SHIFTED;
}

// Maximum acceleration by contacts that nodeSupport() takes for lasting, as a share of that by gravity and forces. A
// greater one is a blow.
#define DRAPE_MOST_LASTING_SUPPORT 1.5f

// Share of the thickness that gravity and forces must move a node in a step to make its cloth thin.
#define DRAPE_THIN_SHARE 0.5f

// Returns the acceleration, m/s², that contacts will give a node of thin cloth in the next step if they hold it as in
// this one, or 0 if none pushed it. It is that of this step; after a blow it is the part that gravity and forces call
// for. Without it the path would pass the surface that the node lies on. Thicker cloth has none: paths that end below
// their resting places, where normals of neighbouring features differ, let it come to rest. before: m/s, the node's
// velocity at this step's start. acceleration: m/s², by gravity and forces. perStep: 1/s, the inverse of the step's
// time. thickness: m, the least of the cloth's pairs.
DRAPE_FUNCTION Vec3 nodeSupport(const DRAPE_GLOBAL NodeState* state, Vec3 before, Vec3 acceleration, float perStep,
                                float thickness)
{
    const float acceleration2 = vec3Dot(acceleration, acceleration);
    const float least = DRAPE_THIN_SHARE * thickness * perStep * perStep;
    if (!(state->m_shifted & DRAPE_NODE_PUSHED) || !(acceleration2 > least * least)) return vec3(0.0f, 0.0f, 0.0f);
    const Vec3 gained = vec3Scale(vec3Sub(state->m_velocity, before), perStep);
    const Vec3 support = vec3Sub(gained, acceleration);
    const float length2 = vec3Dot(support, support);
    if (!(length2 > DRAPE_MOST_LASTING_SUPPORT * DRAPE_MOST_LASTING_SUPPORT * acceleration2)) return support;
    return vec3Scale(support, drapeMax(0.0f, -vec3Dot(support, acceleration)) / length2);
}

// Puts the node at its path's start, with the velocity that leads to the end under constant acceleration. perStep: 1/s,
// the inverse of the step's time. share: s, of the acceleration in the mean velocity (Substeps::pathShare()).
DRAPE_FUNCTION void nodeBegin(DRAPE_NODE_SPACE SolverNode* node, DRAPE_GLOBAL NodeState* state, Vec3 path,
                              Vec3 acceleration, float perStep, float share)
{
    node->m_displacement = vec3(0.0f, 0.0f, 0.0f);
    state->m_velocity = vec3AddScaled(vec3Scale(path, perStep), acceleration, -share);
}

// Moves the node through a substep of `time` seconds.
DRAPE_FUNCTION void nodeAdvance(DRAPE_NODE_SPACE SolverNode* node, DRAPE_GLOBAL NodeState* state, Vec3 acceleration,
                                float time)
{
    state->m_velocity = vec3AddScaled(state->m_velocity, acceleration, time);
    node->m_displacement = vec3AddScaled(node->m_displacement, state->m_velocity, time);
    nodeRemember(node, state);
}

// Adds the correction since nodeAdvance() to the velocity, of which damping leaves the share `kept`.
DRAPE_FUNCTION void nodeEnd(const DRAPE_NODE_SPACE SolverNode* node, DRAPE_GLOBAL NodeState* state, float perSecond,
                            float kept)
{
    const Vec3 correction = vec3Sub(node->m_displacement, state->m_before);
    state->m_velocity = vec3Scale(vec3AddScaled(state->m_velocity, correction, perSecond), kept);
}

// Gives a shifted node the velocity of its displacement since nodeRemember(): perSecond times as much.
DRAPE_FUNCTION void nodeAddShift(const DRAPE_NODE_SPACE SolverNode* node, DRAPE_GLOBAL NodeState* state,
                                 float perSecond)
{
    if (!(state->m_shifted & DRAPE_NODE_SHIFTED)) return;
    const Vec3 shift = vec3Sub(node->m_displacement, state->m_before);
    state->m_velocity = vec3Add(state->m_velocity, vec3Scale(shift, perSecond));
}

// Bounds the velocity that the shift since nodeRemember() gives the node. The shift may stop the node's motion against
// it. Beyond that it gives at most the velocity of the same shift in a whole step. perSecond: 1/s, the velocity per
// metre of shift that is bounded. stepsPerSecond: 1/s.
DRAPE_FUNCTION void nodeLimitShift(const DRAPE_NODE_SPACE SolverNode* node, DRAPE_GLOBAL NodeState* state,
                                   float perSecond, float stepsPerSecond)
{
    if (!(state->m_shifted & DRAPE_NODE_SHIFTED)) return;
    const Vec3 shift = vec3Sub(node->m_displacement, state->m_before);
    const float length = vec3Length(shift);
    if (!(length > 0.0f)) return;
    const float against = -vec3Dot(state->m_velocity, shift) / length;
    const float most = drapeMax(length * stepsPerSecond, against) / perSecond;
    if (most < length) state->m_before = vec3AddScaled(state->m_before, shift, 1.0f - most / length);
}

DRAPE_NAMESPACE_END

#endif
