// A cloth of a step as the solver's kernels see it (shared/solve_step.h), and how the work-items of a group share its
// elements. Nodes are in local memory or in global memory, as DRAPE_NODE_SPACE says.
#ifndef DRAPE_LIB_SOLVE_VIEW_H
#define DRAPE_LIB_SOLVE_VIEW_H

#include "../../shared/contact.h"
#include "../../shared/solve_step.h"
#include "../geometry/vec3.h"

// Functions of the sweeps are inlined, so that the view stays in registers. Otherwise it would be in memory, and each
// use of one of its pointers would wait. NVIDIA's compiler has to be told. Others inline without it, and Oclgrind fails
// with it.
#ifdef __NV_CL_C_VERSION
#define DRAPE_HOT_FUNCTION static __attribute__((always_inline))
#else
#define DRAPE_HOT_FUNCTION static
#endif

// The arrays of the cloth that a work-group solves. m_nodes and m_marks begin with the node m_base, counted from the
// cloth's first one. m_marks: see DRAPE_ROUND_TAG(). m_sorted, m_acting, m_order: by contact in the order of sweeps.
typedef struct Solve
{
    __global const SolveCloth* m_cloth;
    __global const SolveGroup* m_group;
    __global const SolveSurface* m_surfaces;
    __global const SolveRegion* m_regions;
    __global const MeshOffsets* m_obstacles;
    uint m_obstacleCount;
    __global const SolveLink* m_links;
    __global const SolveBatch* m_linkBatches;
    __global const uint* m_faceLists;
    __global const uint* m_facesOfNode;
    __global const int* m_faces;
    __global const Contact* m_contacts;
    DRAPE_NODE_SPACE SolverNode* m_nodes;
    DRAPE_NODE_SPACE uint* m_marks;
    uint m_base;
    __local uint* m_shared;  // DRAPE_SHARED_WORDS
    __global NodePath* m_paths;
    __global const Vec3* m_accelerations;
    __global const Vec3* m_supports;
    __global NodeState* m_states;
    __global SolveBucket* m_buckets;
    __global SolveProgress* m_progress;
    __global SolveAllowance* m_allowances;
    __global SolveContact* m_sorted;
    __global const uint* m_order;
    __global ActingContact* m_acting;
    __global SolveSpan* m_spans;
} Solve;

// Words of local memory that a group shares: one for sums, three for rounds, then three lists by bucket of the group.
// They hold a record of its pushes, the index of its first contact, and the end of its last one. A group has a bucket
// for its nodes and two for each of 63 colours at most.
#define DRAPE_SHARED_PENDING 1
#define DRAPE_SHARED_PUSHED 4
#define DRAPE_MOST_BUCKETS 127
#define DRAPE_SHARED_FIRST (DRAPE_SHARED_PUSHED + DRAPE_MOST_BUCKETS)
#define DRAPE_SHARED_LAST (DRAPE_SHARED_FIRST + DRAPE_MOST_BUCKETS)
#define DRAPE_SHARED_WORDS (DRAPE_SHARED_LAST + DRAPE_MOST_BUCKETS)

// The size of a kernel's work-groups, which is `gpu` on a GPU.
#ifdef DRAPE_CPU
#define DRAPE_GROUP_SIZE(gpu) DRAPE_SOLVE_CPU_GROUP
#else
#define DRAPE_GROUP_SIZE(gpu) gpu
#endif

#define forAll(i, first, last) for (uint i = (first) + get_local_id(0); i < (last); i += get_local_size(0))

// Waits until the group's work-items have written what others read: nodes and marks. A CPU's group has one work-item,
// since compilers for CPUs copy the code behind each barrier that is not always reached.
DRAPE_HOT_FUNCTION void syncNodes(void)
{
#ifndef DRAPE_CPU
#ifdef DRAPE_GLOBAL_NODES
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
#else
    barrier(CLK_LOCAL_MEM_FENCE);
#endif
#endif
}

// Waits for global memory, too. Data of a contact needs no wait between sweeps: the same work-item visits it in all of
// them.
DRAPE_HOT_FUNCTION void syncAll(void)
{
#ifndef DRAPE_CPU
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
#endif
}

// Returns whether a work-item's flag is set in any of the group's.
DRAPE_HOT_FUNCTION int anyInGroup(const Solve* solve, const int flag)
{
    if (get_local_id(0) == 0) *solve->m_shared = 0;
    syncNodes();
    if (flag) *solve->m_shared = 1;
    syncNodes();
    const int any = *solve->m_shared != 0;
    syncNodes();
    return any;
}

// Returns the greatest of the work-items' values, none of which is negative.
DRAPE_HOT_FUNCTION float mostInGroup(const Solve* solve, const float value)
{
    if (get_local_id(0) == 0) *solve->m_shared = 0;
    syncNodes();
    atomic_max(solve->m_shared, as_uint(value));
    syncNodes();
    const float most = as_float(*solve->m_shared);
    syncNodes();
    return most;
}

static Vec3 xyz(const float4 v)
{
    return vec3(v.x, v.y, v.z);
}

DRAPE_HOT_FUNCTION SolverNode loadNode(const Solve* solve, const uint node)
{
    const float4 v = ((DRAPE_NODE_SPACE const float4*)solve->m_nodes)[node - solve->m_base];
    SolverNode loaded;
    loaded.m_displacement = xyz(v);
    loaded.m_inverseMass = v.w;
    return loaded;
}

DRAPE_HOT_FUNCTION void storeNode(const Solve* solve, const uint node, const SolverNode* value)
{
    const Vec3 d = value->m_displacement;
    ((DRAPE_NODE_SPACE float4*)solve->m_nodes)[node - solve->m_base] = (float4)(d.x, d.y, d.z, value->m_inverseMass);
}

DRAPE_HOT_FUNCTION DRAPE_NODE_SPACE SolverNode* nodeAt(const Solve* solve, const uint node)
{
    return solve->m_nodes + (node - solve->m_base);
}

// Returns the number of the group's buckets, which are adjacent.
DRAPE_HOT_FUNCTION uint bucketsOf(const Solve* solve)
{
    return solve->m_group->m_nodeBuckets + solve->m_group->m_faceBuckets + solve->m_group->m_edgeBuckets;
}

// Sets all but the nodes and the group.
DRAPE_HOT_FUNCTION void openCloth(Solve* solve, const SolveLayout* layout, __global const SolveInputWord* input,
                                  __global const SolveTopologyWord* topology, __global const Contact* contacts,
                                  __global SolveWorkWord* work, const uint index)
{
    __global const SolveCloth* cloth = (__global const SolveCloth*)(input + layout->m_cloths) + index;
    const uint firstNode = cloth->m_nodes.m_first;
    solve->m_cloth = cloth;
    solve->m_surfaces = (__global const SolveSurface*)(input + layout->m_surfaces);
    solve->m_regions = (__global const SolveRegion*)(input + layout->m_regions);
    solve->m_obstacles = (__global const MeshOffsets*)(input + layout->m_obstacles);
    solve->m_obstacleCount = layout->m_obstacleCount;
    solve->m_links = (__global const SolveLink*)(topology + layout->m_links);
    solve->m_linkBatches = (__global const SolveBatch*)(topology + layout->m_linkBatches);
    solve->m_faceLists = (__global const uint*)(topology + layout->m_faceLists) + cloth->m_faceLists;
    solve->m_facesOfNode = (__global const uint*)(topology + layout->m_facesOfNode);
    solve->m_faces = (__global const int*)(topology + layout->m_faces);
    solve->m_contacts = contacts + DRAPE_CONTACT_HEAD;
    solve->m_paths = (__global NodePath*)(work + layout->m_paths) + firstNode;
    solve->m_accelerations = (__global const Vec3*)(work + layout->m_accelerations) + firstNode;
    solve->m_supports = (__global const Vec3*)(work + layout->m_supports) + firstNode;
    solve->m_states = (__global NodeState*)(work + layout->m_states) + firstNode;
    solve->m_buckets = (__global SolveBucket*)(work + layout->m_buckets);
    solve->m_progress = (__global SolveProgress*)(work + layout->m_progress) + index;
    solve->m_allowances = (__global SolveAllowance*)(work + layout->m_allowances) + firstNode;
    solve->m_sorted = (__global SolveContact*)(work + layout->m_sorted);
    solve->m_order = (__global const uint*)(work + layout->m_order);
    solve->m_acting = (__global ActingContact*)(work + layout->m_acting);
    solve->m_spans = (__global SolveSpan*)(work + layout->m_spans);
}

#endif
