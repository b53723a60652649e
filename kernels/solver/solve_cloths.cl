// Solves leaves of cloths, whose nodes are in a work-group's local memory: a whole step for a cloth of one leaf, or one
// pass of a step. core/solver/step_solver.h describes the step.
//
// Links of one colour and features of one bucket share no node, so a group's work-items visit them side by side;
// colours, buckets and passes are separated by barriers. The result is the host's, bit for bit.
#define DRAPE_NODE_SPACE __local
#include "../lib/solve_limits.h"
#include "../lib/solve_links.h"
#include "../lib/solve_nodes.h"
#include "../lib/solve_passes.h"
#include "solver_bindings.h"

// Opens the group of the work-group's number in the list of groups by level.
static void openLeaf(Solve* solve, const SolveLayout* layout, __global const SolveInputWord* input,
                     __global const SolveTopologyWord* topology, __global const Contact* contacts,
                     __global SolveWorkWord* work, const SolvePass* pass, __local SolverNode* nodes,
                     __local uint* marks, __local uint* shared)
{
    __global const uint* list = (__global const uint*)(topology + layout->m_levelGroups) + pass->m_firstGroup;
    solve->m_group = (__global const SolveGroup*)(topology + layout->m_groups) + list[get_group_id(0)];
    solve->m_nodes = nodes;
    solve->m_marks = marks;
    solve->m_base = solve->m_group->m_nodes.m_first;
    solve->m_shared = shared;
    openCloth(solve, layout, input, topology, contacts, work, solve->m_group->m_cloth);
}

// See MotionLimit::apply().
static void applyLimits(const Solve* solve)
{
    const SolveRange regions = solve->m_cloth->m_regions, nodes = solve->m_group->m_nodes;
    if (regions.m_count == 0 || !anyInGroup(solve, findFarNodes(solve, nodes))) return;
    allowByResting(solve, nodes, 1);
    syncNodes();
    bringBackAllowed(solve, nodes);
    syncNodes();
    for (uint i = regions.m_first; i < regions.m_first + regions.m_count; ++i)
    {
        if (!solve->m_regions[i].m_moves) continue;
        findNear(solve, nodes, solve->m_regions + i);
        syncNodes();
        bringBackNear(solve, nodes, solve->m_regions + i);
        syncNodes();
    }
}

static void runSubstep(const Solve* solve, const uint substep, Sweep* sweep)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    const SolveRange nodes = solve->m_group->m_nodes;
    advanceNodes(solve, nodes);
    syncNodes();
    // Limits beside a moving obstacle hold at the step's end alone.
    if (substep > 0 && (cloth->m_rests || substep + 1 == cloth->m_substeps))
    {
        applyLimits(solve);
        boundShifts(solve, nodes);
        syncNodes();
    }
    beginSubstep(solve, substep, sweep);
    for (uint i = 0; i < cloth->m_linkSweeps; ++i)
    {
        sweepLinks(solve);
        sweepFaces(solve, sweep);
        sweepEdges(solve, sweep, cloth->m_actingSweeps);
    }
    endNodes(solve, nodes);
    syncNodes();
}

// Returns the worst violation that a closing sweep met, m.
static float closeOnce(const Solve* solve, Sweep* sweep)
{
    beginClosing(solve, sweep);
    sweepFaces(solve, sweep);
    sweepEdges(solve, sweep, 0);
    return mostInGroup(solve, sweep->m_worst);
}

// Sweeps until no contact is violated by more than the tolerances.
static void closeContacts(const Solve* solve, Sweep* sweep)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    const SolveRange nodes = solve->m_group->m_nodes;
    const uint blocks = solve->m_progress->m_blocks;
    float worst = closeOnce(solve, sweep);
    for (uint done = 1; needsClosing(done, blocks, worst, cloth->m_fineViolation, cloth->m_mostViolation); ++done)
    {
        if (cloth->m_rests)
            keepNear(solve, nodes);
        else
            applyLimits(solve);
        worst = closeOnce(solve, sweep);
    }
    // Nodes go last: see StepSolver::close().
    if (worst > cloth->m_fineViolation) sweepNodes(solve, sweep);
    if (!cloth->m_rests || !anyInGroup(solve, findFarNodes(solve, nodes))) return;
    allowByResting(solve, nodes, 0);
    syncNodes();
    bringBackAllowed(solve, nodes);
    syncNodes();
}

// Solves the whole step of a cloth of one leaf, whatever the group's size.
DRAPE_RARE_FUNCTION void solveCloth(const Solve* solve, __global SolverNode* ends, __global SolveResult* result)
{
    const SolveRange nodes = solve->m_group->m_nodes;
    Sweep sweep;
    beginNodes(solve, nodes);
    beginLinks(solve);
    forAll(i, 0, DRAPE_MOST_BUCKETS) solve->m_shared[DRAPE_SHARED_PUSHED + i] = 0;
    resetMarks(solve, &sweep);
    syncAll();
    for (uint i = 0; i < solve->m_cloth->m_substeps; ++i)
        runSubstep(solve, i, &sweep);
    rememberNodes(solve, nodes);
    syncNodes();
    applyLimits(solve);
    if (solve->m_progress->m_blocks > 0) closeContacts(solve, &sweep);
    syncAll();
    addShifts(solve, nodes);
    syncAll();
    forAll(i, 0, nodes.m_count) ends[i] = solve->m_nodes[i];
    int near = limitSpeeds(solve, 0);
    near |= limitSpeeds(solve, 1);
    near = anyInGroup(solve, near);
    if (get_local_id(0) > 0) return;
    result->m_mayHavePassed = near;
    result->m_isOpen = 0;
    result->m_refused = solve->m_progress->m_refused;
}

static void loadLeaf(const Solve* solve, __global const SolverNode* from)
{
    const SolveRange nodes = solve->m_group->m_nodes;
    forAll(i, 0, nodes.m_count)
        ((__local float4*)solve->m_nodes)[i] = ((__global const float4*)from)[nodes.m_first + i];
}

static void storeLeaf(const Solve* solve, __global SolverNode* to)
{
    const SolveRange nodes = solve->m_group->m_nodes;
    forAll(i, 0, nodes.m_count)
        ((__global float4*)to)[nodes.m_first + i] = ((__local const float4*)solve->m_nodes)[i];
}

// Runs one pass over a leaf.
DRAPE_RARE_FUNCTION void sweepLeaf(const Solve* solve, const SolvePass* pass, __global SolverNode* places)
{
    if (!takesPart(solve, pass)) return;
    Sweep sweep;
    loadLeaf(solve, places);
    if (pass->m_pass == DRAPE_PASS_LINKS)
    {
        syncNodes();
        sweepLinks(solve);
    }
    else
    {
        resetMarks(solve, &sweep);
        if (pass->m_pass == DRAPE_PASS_FACES && pass->m_sweep > 0 && solve->m_cloth->m_rests)
            keepNear(solve, solve->m_group->m_nodes);
        sweepPass(solve, pass, &sweep);
    }
    syncNodes();
    storeLeaf(solve, places);
}

// One text for both sizes of groups.
#define DRAPE_SOLVE(name, group)                                                                                \
    __kernel __attribute__((reqd_work_group_size(DRAPE_GROUP_SIZE(group), 1, 1))) void name(DRAPE_SOLVE_LEAVES) \
    {                                                                                                           \
        __local uint shared[DRAPE_SHARED_WORDS];                                                                \
        Solve solve;                                                                                            \
        openLeaf(&solve, &layout, input, topology, contacts, work, &pass, nodes, marks, shared);                \
        solveCloth(&solve, (__global SolverNode*)(work + layout.m_nodes) + solve.m_cloth->m_nodes.m_first,      \
                   (__global SolveResult*)(work + layout.m_results) + solve.m_group->m_cloth);                  \
    }
DRAPE_SOLVE(solveCloths, DRAPE_SOLVE_GROUP)
DRAPE_SOLVE(solveSmallCloths, DRAPE_SOLVE_SMALL_GROUP)

__kernel __attribute__((reqd_work_group_size(DRAPE_GROUP_SIZE(DRAPE_SOLVE_GROUP), 1, 1))) void sweepLeaves(
    DRAPE_SOLVE_LEAVES)
{
    __local uint shared[DRAPE_SHARED_WORDS];
    Solve solve;
    openLeaf(&solve, &layout, input, topology, contacts, work, &pass, nodes, marks, shared);
    sweepLeaf(&solve, &pass, (__global SolverNode*)(work + layout.m_nodes) + solve.m_cloth->m_nodes.m_first);
}
