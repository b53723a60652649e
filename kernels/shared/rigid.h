// Rows of a cloth's nodes beside rigid bodies (core/solver/rigid_rows.h). World frame, SI units.
#ifndef DRAPE_SHARED_RIGID_H
#define DRAPE_SHARED_RIGID_H

#include "types.h"

DRAPE_NAMESPACE_BEGIN

typedef struct RigidBody
{
    Vec3 m_centre;              // m, centre of mass
    Vec3 m_velocity, m_spin;    // m/s at the centre of mass, rad/s
    Vec3 m_inverseMass;         // 1/kg by axis
    Vec3 m_inverseInertia[3];   // rows, 1/(kg m²)
    DRAPE_UINT m_moves;         // false for a static or kinematic body, which does not yield
    DRAPE_UINT m_follows;       // ends the step where it yields to; else only its velocity yields
    DRAPE_UINT m_isPushed;      // by cloth in this step, if it follows
    Vec3 m_impulse, m_turning;  // given by cloth in this step, N s, and about the centre of mass, N m s
    Vec3 m_shift, m_turn;       // by which these move a body that follows until the step's end, m and rad
    Vec3 m_acceleration;        // m/s², of a body that follows: what its forces added to its velocity in the step
    Vec3 m_displaced;           // m/s, of a body that follows: what its motion in the step has beside its velocity
} RigidBody;

// A plane of a rigid body beside a node.
typedef struct RigidPlane
{
    Vec3 m_normal;    // unit, from the body to the cloth
    float m_gap;      // m, between node and plane at the step's start; negative is too close
    float m_recover;  // m, of a negative gap, what the step mends
    float m_friction;
} RigidPlane;

// A node beside a plane of a body.
typedef struct RigidContact
{
    DRAPE_UINT m_node, m_body;
    Vec3 m_arm;  // m, from the body's centre of mass to the contact
    RigidPlane m_plane;
} RigidContact;

// A node that follows a point of a body.
typedef struct RigidAnchor
{
    DRAPE_UINT m_node, m_body;
    Vec3 m_arm;     // m, from the body's centre of mass to the point
    Vec3 m_apart;   // m, from the node to the point at the step's start
    float m_share;  // share of an error that a projection corrects, up to 1
} RigidAnchor;

// Working memory of a row.
typedef struct RigidRowState
{
    Vec3 m_carried;      // m, displacement of the body's point from the step's start to that of the substep
    Vec3 m_held;         // friction of a contact in the substep, in units of the multiplier
    float m_multiplier;  // pushed by a contact in the substep, kg m
} RigidRowState;

// Impulses that bodies that move received from a cloth's rows.
typedef struct RigidGiven
{
    Vec3 m_reference;  // m
    Vec3 m_impulse;    // N s
    Vec3 m_turning;    // angular momentum about the reference, N m s
} RigidGiven;

// Rows of a cloth that one work-item projects in their order: anchors, then contacts.
typedef struct RigidRun
{
    DRAPE_UINT m_cloth, m_given;
    DRAPE_UINT m_firstAnchor, m_lastAnchor, m_firstContact, m_lastContact;
} RigidRun;

// Runs that one work-item projects one after the other. Two chains have no node and no moving body in common.
typedef struct RigidChain
{
    DRAPE_UINT m_first, m_last;
} RigidChain;

// Numbers of elements, and offsets of arrays in the step's input and in the working memory, in words. m_states: of
// anchors, then of contacts.
typedef struct RigidLayout
{
    DRAPE_UINT m_chainCount, m_bodyCount, m_givenCount, m_anchorCount;
    DRAPE_UINT m_chains, m_runs, m_anchors, m_contacts, m_bodiesBefore, m_givenBefore;
    DRAPE_UINT m_states, m_bodies, m_given;
} RigidLayout;

DRAPE_NAMESPACE_END

#endif
