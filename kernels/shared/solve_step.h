// Records of a cloth step on a device (solver/). SI units.
//
// All cloths of a step share the arrays. A cloth's nodes are adjacent, sorted by the leaves of its parts
// (core/solver/topology/cloth_parts.h). Indices of nodes count from the cloth's first node, all others over all cloths.
#ifndef DRAPE_SHARED_SOLVE_STEP_H
#define DRAPE_SHARED_SOLVE_STEP_H

#include "mesh.h"
#include "solver.h"

DRAPE_NAMESPACE_BEGIN

// Work-items of a work-group: on a GPU few for small cloths, so that a compute unit has several groups, and for others
// as many as their registers allow. On a CPU one, without barriers.
#define DRAPE_SOLVE_GROUP 512
#define DRAPE_SOLVE_SMALL_GROUP 128
#define DRAPE_SOLVE_JOIN_GROUP 128  // for groups that join leaves
#define DRAPE_SOLVE_CPU_GROUP 1

// Maximum closing sweeps (lib/solver/closing_sweeps.h).
#define DRAPE_CLOSING_SWEEPS 128

// Words of the three arenas (shared/arenas.h) that hold the step's input, the topology and the working memory.
typedef struct SolveInputWord
{
    DRAPE_UINT m_bits;
} SolveInputWord;
typedef struct SolveTopologyWord
{
    DRAPE_UINT m_bits;
} SolveTopologyWord;
typedef struct SolveWorkWord
{
    DRAPE_UINT m_bits;
} SolveWorkWord;

// Adjacent elements of an array, over all cloths.
typedef struct SolveRange
{
    DRAPE_UINT m_first, m_count;
} SolveRange;

// A cloth and its settings in the step.
typedef struct SolveCloth
{
    SolveRange m_nodes;
    SolveRange m_surfaces;   // by rising slot of the obstacle
    SolveRange m_regions;    // obstacles that limit the motion
    DRAPE_UINT m_faceLists;  // position of the nodes' lists of faces, see SolveLayout
    DRAPE_UINT m_substeps;
    DRAPE_UINT m_linkSweeps;    // in each substep, each with a sweep over the contacts
    DRAPE_UINT m_actingSweeps;  // see ContactSweep::restart()
    DRAPE_UINT m_rests;         // true if all obstacles rest
    DRAPE_UINT m_settles;       // true if nodes that hardly moved come to rest, see StepSolver::settle()
    float m_substepTime;        // s
    float m_perStep;            // 1/s
    float m_pathShare;          // s, see nodeBegin()
    float m_spread;             // see Substeps::spread()
    float m_perCorrection;      // 1/s
    float m_undamped;           // share of a velocity that damping leaves in a substep
    float m_perShift;           // 1/s, velocity per metre of a closing shift
    float m_perSecond;          // 1/s, steps per second
    float m_hardness;           // see targetGap()
    float m_mostThickness;      // m
    float m_fineViolation;      // m, worst violation that may remain before DRAPE_LEAST_CLOSING sweeps
    float m_mostViolation;      // m, and after
    float m_tolerated;          // m, violation that closing sweeps leave
    float m_nearDistance;       // m, below which features may have passed each other
    float m_margin;             // m, rounding margin of the levels
    float m_retreat;            // m, bound on the displacement of a node by an obstacle's motion
    float m_sure;               // m, see MotionLimit
    float m_leastTolerance;     // m, see MotionLimit
} SolveCloth;

// A group of a cloth's parts: a leaf, or what joins two groups. Its buckets are adjacent: those of nodes, of faces and
// of edges.
typedef struct SolveGroup
{
    DRAPE_UINT m_cloth;
    SolveRange m_nodes;  // a leaf has some
    SolveRange m_linkBatches;
    DRAPE_UINT m_firstBucket;
    DRAPE_UINT m_nodeBuckets, m_faceBuckets, m_edgeBuckets;  // their numbers
} SolveGroup;

// Links of one colour.
typedef struct SolveBatch
{
    DRAPE_UINT m_first, m_last;
    DRAPE_UINT m_serial;  // they may share nodes: one after the other
} SolveBatch;

// The bucket of the contacts of a cloth feature, and its nodes.
typedef struct SolveFeature
{
    DRAPE_UINT m_bucket;    // DRAPE_NO_BUCKET: in no cloth of the step
    DRAPE_UINT m_nodes[3];  // DRAPE_NO_NODE where unused
} SolveFeature;
#define DRAPE_NO_BUCKET 0xffffffffu
#define DRAPE_NO_NODE 0xffffffffu

// A bucket: contacts of features that have one group, kind and colour, so that two features share no node.
typedef struct SolveBucket
{
    DRAPE_UINT m_count;   // contacts
    DRAPE_UINT m_first;   // position of the first one
    DRAPE_UINT m_filled;  // contacts that have a position
    DRAPE_UINT m_pushed;  // see DRAPE_PUSH_RECORD()
} SolveBucket;

typedef struct SolveLink
{
    DRAPE_UINT m_nodes[2];
    float m_restSquared;  // m²
    float m_strength;     // see LinkSweep::set()
} SolveLink;

// Properties that contacts of a cloth with one obstacle have in common. m_map: the motion, three rows of rotation and
// shift.
typedef struct SolveSurface
{
    float m_map[12];
    float m_thickness;  // m
    float m_friction;   // coefficient, the cloth's included
    DRAPE_UINT m_moves;
    DRAPE_UINT m_obstacle;  // slot
} SolveSurface;

// A link's nodes apart from each other at the step's start, and its length.
typedef struct SolveSpan
{
    Vec3 m_apart;
    float m_restSquared;  // m²
} SolveSpan;

// Flags of a contact: it has a row; its plane turns with its face. The number of its nodes is behind them.
#define DRAPE_CONTACT_MADE 1u
#define DRAPE_CONTACT_TURNS 2u
#define DRAPE_CONTACT_COUNT(flags) ((flags) >> 8)

// A contact in the order of sweeps, with its bounding plane: it is not violated while n.(d0 + w1 (d1 - d0) + w2 (d2 -
// d0)) reaches the level. Read as vectors of four numbers.
typedef struct SolveContact
{
    Vec3 m_normal;
    float m_level;          // m, with the margin for rounding
    float m_weights[2];     // second and third node
    DRAPE_UINT m_flags;     // DRAPE_CONTACT_MADE ...
    DRAPE_UINT m_pushing;   // the phase in which the row pushed last
    DRAPE_UINT m_nodes[3];  // the first one again where unused
    DRAPE_UINT m_rank;      // among the contacts of its feature; above bit 16 among those that act
} SolveContact;

// An obstacle that limits the motion near it.
typedef struct SolveRegion
{
    Vec3 m_low, m_high;    // m
    float m_start, m_end;  // m, by which a node may leave the path's start and end
    DRAPE_UINT m_surface;
    DRAPE_UINT m_moves;
} SolveRegion;

// Working memory of the motion limit, by node.
typedef struct SolveAllowance
{
    float m_start, m_end;  // m
    DRAPE_UINT m_hasContact;
    DRAPE_UINT m_isNear;
} SolveAllowance;

// Working memory of a cloth.
typedef struct SolveProgress
{
    DRAPE_UINT m_blocks;   // blocks of contacts as the host counts them, see mostClosingSweeps()
    DRAPE_UINT m_far;      // the last pass in which a node was far from its path's end
    DRAPE_UINT m_ended;    // the round in which the step ended; 0: it has not
    DRAPE_UINT m_isNear;   // true if a contact ends so near that a surface may have been passed
    DRAPE_UINT m_refused;  // true if a feature has too many contacts
    DRAPE_UINT m_meets;    // true if a node's path meets a surface
    DRAPE_UINT m_pushed;   // true if a contact pushed in the step
    DRAPE_UINT m_unused;
    float m_worst[DRAPE_CLOSING_SWEEPS + 4];  // m, by closing sweep
} SolveProgress;

// A result, by cloth.
typedef struct SolveResult
{
    DRAPE_UINT m_mayHavePassed;  // true if a contact ends so near that a surface may have been passed
    DRAPE_UINT m_isOpen;         // true if the cloth needs more closing sweeps than were enqueued
    DRAPE_UINT m_refused;        // true if the device cannot solve the cloth
    DRAPE_UINT m_meets;          // true if a path meets a surface: paths may have to end there before the solver begins
} SolveResult;

// Positions of the arrays, in words, and numbers of elements.
typedef struct SolveLayout
{
    DRAPE_UINT m_nodeCount, m_bucketCount, m_obstacleCount;
    // In the step's input. By node in the caller's order: paths, accelerations, supports.
    DRAPE_UINT m_cloths, m_givenPaths, m_givenAccelerations, m_givenSupports, m_surfaces, m_regions, m_obstacles;
    // These are in the working memory. m_order: by contact in the order of sweeps, its index in the list of contacts.
    DRAPE_UINT m_nodes, m_states, m_results;
    DRAPE_UINT m_buckets, m_progress, m_allowances, m_total;
    DRAPE_UINT m_paths, m_accelerations, m_supports, m_sorted, m_order, m_acting, m_spans, m_marks;
    // In the topology. m_faceLists: by node, the position of its faces; then the last one's end. m_faces: three nodes
    // each. m_nodeOrder: by node, its index in the caller's order.
    DRAPE_UINT m_links, m_linkBatches, m_groups, m_levelGroups, m_faceLists, m_facesOfNode, m_faces, m_nodeOrder,
        m_features, m_bucketCloths;
} SolveLayout;

// Passes of a step over the groups of a level, or over leaves.
#define DRAPE_PASS_BEGIN 0u         // all groups: nodes at the paths' starts, links apart
#define DRAPE_PASS_ADVANCE 1u       // leaves: ends a substep and begins the next one
#define DRAPE_PASS_LIMIT 2u         // leaves: how far nodes may leave their paths beside resting obstacles
#define DRAPE_PASS_BRING_BACK 3u    // leaves: brings these nodes back
#define DRAPE_PASS_NEAR 4u          // leaves: nodes near a moving obstacle
#define DRAPE_PASS_CARRY_BACK 5u    // leaves: brings these nodes back
#define DRAPE_PASS_LINKS 6u         // a level
#define DRAPE_PASS_FACES 7u         // a level: contacts of nodes and faces
#define DRAPE_PASS_EDGES 8u         // a level: contacts of edges, then those that act
#define DRAPE_PASS_FAR 9u           // leaves: finds nodes far from their paths' ends
#define DRAPE_PASS_NODES 10u        // a level: contacts of nodes alone
#define DRAPE_PASS_END 11u          // leaves: velocities of the closing shifts
#define DRAPE_PASS_SPEEDS 12u       // a level: nodes and faces limit speeds
#define DRAPE_PASS_EDGE_SPEEDS 13u  // a level
#define DRAPE_PASS_RESULT 14u       // leaves

// A pass. Cloths with fewer substeps, or that need no closing sweep of this number, take no part.
typedef struct SolvePass
{
    DRAPE_UINT m_pass;
    DRAPE_UINT m_firstGroup;  // in the list of groups by level
    DRAPE_UINT m_substep;     // DRAPE_CLOSING: after the last one
    DRAPE_UINT m_sweep;       // closing sweep, or for rigid rows that of the substep
    DRAPE_UINT m_region;      // a moving obstacle's, counted from the cloth's first
    DRAPE_UINT m_round;       // counts from 1 for passes that end the step
} SolvePass;
#define DRAPE_CLOSING 0xffffffffu

DRAPE_NAMESPACE_END

#endif
