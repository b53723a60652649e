// Records of the cloth solver (core/solver). SI units.
#ifndef DRAPE_SHARED_SOLVER_H
#define DRAPE_SHARED_SOLVER_H

#include "types.h"

DRAPE_NAMESPACE_BEGIN

// The address space of a cloth's nodes. Kernels may define another one.
#ifndef DRAPE_NODE_SPACE
#define DRAPE_NODE_SPACE DRAPE_GLOBAL
#endif

// Lets a kernel read a record as a vector of four numbers wherever the record is.
#ifdef __OPENCL_VERSION__
#define DRAPE_VECTOR_ALIGNED __attribute__((aligned(16)))
#else
#define DRAPE_VECTOR_ALIGNED
#endif

// A node's displacement from the step's start and its inverse mass, read and written as one vector of four numbers.
typedef struct SolverNode
{
    Vec3 m_displacement;  // m
    float m_inverseMass;  // 1/kg; 0 for a node that constraints do not move
} DRAPE_VECTOR_ALIGNED SolverNode;

// A node's path through the step: straight, from its start to its predicted end.
typedef struct NodePath
{
    Vec3 m_start;         // m
    float m_inverseMass;  // 1/kg, as contacts see it: 0 for a node that they do not move
    Vec3 m_vector;        // m, from the start to the end
    float m_freeMass;     // 1/kg, the inverse mass as links see it
} NodePath;

// Values of NodeState::m_shifted: the node was moved since its displacement was remembered; a contact pushed it in the
// step.
#define DRAPE_NODE_SHIFTED 1u
#define DRAPE_NODE_PUSHED 2u

// Properties of a node beside its displacement.
typedef struct NodeState
{
    Vec3 m_velocity;       // m/s
    DRAPE_UINT m_shifted;  // DRAPE_NODE_SHIFTED, DRAPE_NODE_PUSHED
    Vec3 m_before;         // m, the displacement that was remembered
    DRAPE_UINT m_isFar;    // working memory of the motion limit
} NodeState;

// A contact that acts: the least displacement, along a normal, of a weighted point of the cloth. Devices read it as
// vectors of four numbers.
typedef struct ContactRow
{
    Vec3 m_normal;       // unit, from the obstacle to the cloth
    float m_level;       // m, least displacement along the normal at the step's end
    Vec3 m_carried;      // m, displacement along the surface by the obstacle's motion in the step
    float m_advance;     // m, that displacement along the normal
    Vec3 m_held;         // friction applied in this phase, in units of the multiplier
    float m_multiplier;  // pushed in this phase, kg m
    float m_weights[3];  // by node, sum 1
    float m_friction;
    float m_shares[3];        // by node, displacement per unit of the multiplier, 1/kg
    float m_inverseMobility;  // kg, of the weighted point; 0: nothing moves
    DRAPE_UINT m_nodes[3];
    DRAPE_UINT m_count;  // nodes, 1 to 3
    float m_mended;      // share of a violation that a push corrects: 1 where no node is fixed
} ContactRow;

// A contact with a row, and what the row's projection does not need.
typedef struct ActingContact
{
    ContactRow m_row;
    float m_distance;     // m, distance to keep from the contact's point: thickness plus target
    float m_speedLimit;   // m/s outwards when the contact pushed
    DRAPE_UINT m_phase;   // in which the plane was renewed
    DRAPE_UINT m_pushed;  // true if it pushed in any phase
    DRAPE_UINT m_unused[3];
} ActingContact;

DRAPE_NAMESPACE_END

#endif
