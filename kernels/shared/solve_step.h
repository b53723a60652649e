// Records of a cloth step on a device (solver/solve_cloths.cl). SI units.
//
// All cloths of a launch share the arrays, in which a cloth's elements are adjacent. Indices of nodes count from the
// cloth's first node, all others over all cloths.
#ifndef DRAPE_SHARED_SOLVE_STEP_H
#define DRAPE_SHARED_SOLVE_STEP_H

#include "solver.h"

DRAPE_NAMESPACE_BEGIN

// Work-items of a cloth's work-group: on a GPU few for small cloths, so that a compute unit has several groups, and for
// others as many as their registers allow. On a CPU one, without barriers.
#define DRAPE_SOLVE_GROUP 512
#define DRAPE_SOLVE_SMALL_GROUP 128
#define DRAPE_SOLVE_CPU_GROUP 1

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
    SolveRange m_features;  // with contacts
    SolveRange m_links;
    SolveRange m_linkBatches;
    SolveRange m_nodeBatches;  // contacts of nodes
    SolveRange m_faceBatches;  // contacts of nodes and faces
    SolveRange m_edgeBatches;  // contacts of edges
    SolveRange m_regions;      // obstacles that limit the motion
    DRAPE_UINT m_faceLists;    // position of the nodes' lists of faces, see SolveLayout
    DRAPE_UINT m_substeps;
    DRAPE_UINT m_linkSweeps;    // in each substep, each with a sweep over the contacts
    DRAPE_UINT m_leastClosing;  // closing sweeps up to which the finer tolerance counts
    DRAPE_UINT m_mostClosing;
    DRAPE_UINT m_levels;        // levels of the cloth's groups
    DRAPE_UINT m_actingSweeps;  // see ContactSweep::restart()
    DRAPE_UINT m_rests;         // true if all obstacles rest
    float m_substepTime;        // s
    float m_perStep;            // 1/s
    float m_pathShare;          // s, see nodeBegin()
    float m_perCorrection;      // 1/s
    float m_kept;               // share of a velocity that damping leaves in a substep
    float m_perShift;           // 1/s, velocity per metre of a closing shift
    float m_perSecond;          // 1/s, steps per second
    float m_hardness;           // see targetGap()
    float m_mostThickness;      // m
    float m_fineViolation;      // m, worst violation that may remain before m_leastClosing sweeps are done
    float m_mostViolation;      // m, and after
    float m_tolerated;          // m, violation that closing sweeps leave
    float m_nearDistance;       // m, below which features may have passed each other
    float m_margin;             // m, rounding margin of the levels
    float m_retreat;            // m, bound on the displacement of a node by an obstacle's motion
    float m_sure;               // m, see MotionLimit
    float m_leastTolerance;     // m, see MotionLimit
} SolveCloth;

// Links or features of one colour and level.
typedef struct SolveBatch
{
    DRAPE_UINT m_first, m_last;
    DRAPE_UINT m_serial;  // they may share nodes: one after the other
    DRAPE_UINT m_level;   // level of their groups, from the leaves on
} SolveBatch;

typedef struct SolveLink
{
    DRAPE_UINT m_nodes[2];
    float m_restSquared;  // m²
    float m_strength;     // see LinkSweep::set()
} SolveLink;

// A node, face or edge of a cloth, with its contacts.
typedef struct SolveFeature
{
    DRAPE_UINT m_nodes[3];
    DRAPE_UINT m_nodeCount;
    DRAPE_UINT m_firstContact, m_contactCount;
    DRAPE_UINT m_unused[2];
} SolveFeature;

// Properties that contacts of a cloth with one obstacle have in common. m_map: the motion, three rows of rotation and
// shift.
typedef struct SolveSurface
{
    float m_map[12];
    float m_thickness;  // m
    float m_friction;   // coefficient, the cloth's included
    DRAPE_UINT m_moves;
    DRAPE_UINT m_unused;
} SolveSurface;

// A link's nodes apart from each other at the step's start, and its length.
typedef struct SolveSpan
{
    Vec3 m_apart;
    float m_restSquared;  // m²
} SolveSpan;

// Flags of a bounding plane: there is a row; the plane turns with its face.
#define DRAPE_PLANE_MADE 1u
#define DRAPE_PLANE_TURNS 2u

// A bounding plane of a contact: it is not violated while n.(d0 + w1 (d1 - d0) + w2 (d2 - d0)) reaches the level.
typedef struct SolvePlane
{
    Vec3 m_normal;
    float m_level;         // m, with the margin for rounding
    float m_weights[2];    // second and third node
    DRAPE_UINT m_flags;    // DRAPE_PLANE_MADE …
    DRAPE_UINT m_pushing;  // the stage in which the row pushed last
} SolvePlane;

// Working memory of a feature. Contacts beyond the list are not violated while no node is farther than the clearance
// from its reference.
typedef struct SolveFeatureState
{
    Vec3 m_references[3];    // m, displacements of the nodes when the contacts were listed
    float m_clearance;       // m
    DRAPE_UINT m_listCount;  // contacts in the list
    DRAPE_UINT m_unused;
} SolveFeatureState;

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

// A result, by cloth.
typedef struct SolveResult
{
    DRAPE_UINT m_mayHavePassed;  // true if a contact ends so near that a surface may have been passed
    DRAPE_UINT m_closingSweeps;  // closing sweeps that were made
} SolveResult;

// Positions of the arrays, in words.
typedef struct SolveLayout
{
    // In the step's input.
    DRAPE_UINT m_cloths, m_paths, m_accelerations, m_batches, m_features, m_surfaceOf, m_surfaces, m_regions;
    // In the working memory.
    DRAPE_UINT m_nodes, m_states, m_planes, m_acting, m_allowances, m_results;
    DRAPE_UINT m_spans, m_featureStates, m_lists;
    // In the topology: the links; by node, the position of its faces, then the last one's end; the faces of the nodes;
    // three nodes for each face.
    DRAPE_UINT m_links, m_faceLists, m_facesOfNode, m_faces;
} SolveLayout;

DRAPE_NAMESPACE_END

#endif
