// Solves leaves of cloths, whose nodes are in a work-group's local memory: a whole step for a cloth of one leaf, or one
// pass of a step. core/solver/step_solver.h describes the step.
//
// Links of one colour and features of one bucket share no node, so a group's work-items visit them side by side;
// colours, buckets and passes are separated by barriers. The result is the host's, bit for bit.
#define DRAPE_NODE_SPACE __local
#include "../lib/solver/solve_limits.h"
#include "../lib/solver/solve_links.h"
#include "../lib/solver/solve_nodes.h"
#include "../lib/solver/solve_passes.h"
#include "../lib/solver/solve_speeds.h"
#include "solver_bindings.h"

// Opens the group of the work-group's number in the list of groups by level.
DRAPE_HOT_FUNCTION void openLeaf(Solve* solve, const SolveLayout* layout, __global const SolveInputWord* input,
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
DRAPE_RARE_FUNCTION void applyLimits(const Solve* solve)
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

// Begins the step, up to its first substep.
DRAPE_RARE_FUNCTION void beginCloth(const Solve* solve)
{
    beginNodes(solve, solve->m_group->m_nodes);
    beginLinks(solve);
    syncAll();
}

// Ends the substep before, if there is one, and begins this one.
DRAPE_RARE_FUNCTION void nextSubstep(const Solve* solve, const uint substep)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    const SolveRange nodes = solve->m_group->m_nodes;
    if (substep > 0) endNodes(solve, nodes);
    advanceNodes(solve, nodes);
    syncNodes();
    // Limits beside a moving obstacle hold at the step's end alone.
    if (substep == 0 || !(cloth->m_rests || substep + 1 == cloth->m_substeps)) return;
    applyLimits(solve);
    boundShifts(solve, nodes);
    syncNodes();
}

// Ends the last substep.
DRAPE_RARE_FUNCTION void endSubsteps(const Solve* solve)
{
    const SolveRange nodes = solve->m_group->m_nodes;
    endNodes(solve, nodes);
    syncAll();  // shows SolveProgress::m_pushed to all work-items
    settleNodes(solve, nodes);
    rememberNodes(solve, nodes);
    syncNodes();
    applyLimits(solve);
}

// Brings nodes back before another closing sweep.
DRAPE_RARE_FUNCTION void limitAgain(const Solve* solve)
{
    if (solve->m_cloth->m_rests)
        keepNear(solve, solve->m_group->m_nodes);
    else
        applyLimits(solve);
}

// Limits nodes without contacts: see StepSolver::holdOthers().
DRAPE_RARE_FUNCTION void limitOthers(const Solve* solve)
{
    const SolveRange nodes = solve->m_group->m_nodes;
    if (!solve->m_cloth->m_rests || !anyInGroup(solve, findFarNodes(solve, nodes))) return;
    allowByResting(solve, nodes, 0);
    syncNodes();
    bringBackAllowed(solve, nodes);
    syncNodes();
}

DRAPE_RARE_FUNCTION void endCloth(const Solve* solve, __global SolverNode* ends, __global SolveResult* result)
{
    const SolveRange nodes = solve->m_group->m_nodes;
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
    result->m_meets = solve->m_progress->m_meets;
}

// Sweeps until no contact is violated by more than the tolerances.
DRAPE_HOT_FUNCTION void closeContacts(const Solve* solve, Sweep* sweep)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    const float fine = cloth->m_fineViolation, most = cloth->m_mostViolation;
    const uint blocks = solve->m_progress->m_blocks;
    int isOpen = 1, isLast = 0;
    for (uint done = 1; isOpen || isLast; ++done)
    {
        beginClosing(solve, sweep);
        sweepBuckets(solve, 0, isLast ? solve->m_group->m_nodeBuckets : bucketsOf(solve), 0, sweep);
        if (isLast) return;
        const float worst = mostInGroup(solve, sweep->m_worst);
        isOpen = needsClosing(done, blocks, worst, fine, most);
        isLast = !isOpen && worst > fine;  // nodes go last: see StepSolver::close()
        if (!isOpen) continue;
        const Solve view = *solve;
        limitAgain(&view);
    }
}

// Solves the whole step of a cloth of one leaf, whatever the group's size.
DRAPE_HOT_FUNCTION void solveCloth(const Solve* solve, __global SolverNode* ends, __global SolveResult* result)
{
    const Solve view = *solve;
    Sweep sweep;
    beginCloth(&view);
    openBuckets(solve);
    resetMarks(solve, &sweep);
    const uint substeps = solve->m_cloth->m_substeps, sweeps = solve->m_cloth->m_linkSweeps;
    const uint acting = solve->m_cloth->m_actingSweeps;
    for (uint i = 0; i < substeps * sweeps; ++i)
    {
        if (i % sweeps == 0)
        {
            nextSubstep(&view, i / sweeps);
            beginSubstep(solve, i / sweeps, &sweep);
        }
        sweepLinks(solve);
        sweepBuckets(solve, 0, bucketsOf(solve), acting, &sweep);
    }
    endSubsteps(&view);
    if (solve->m_progress->m_blocks > 0)
    {
        closeContacts(solve, &sweep);
        limitOthers(&view);
    }
    endCloth(&view, ends, result);
}

DRAPE_HOT_FUNCTION void loadLeaf(const Solve* solve, __global const SolverNode* from)
{
    const SolveRange nodes = solve->m_group->m_nodes;
    forAll(i, 0, nodes.m_count)((__local float4*)solve->m_nodes)[i] = ((__global const float4*)from)[nodes.m_first + i];
}

DRAPE_HOT_FUNCTION void storeLeaf(const Solve* solve, __global SolverNode* to)
{
    const SolveRange nodes = solve->m_group->m_nodes;
    forAll(i, 0, nodes.m_count)((__global float4*)to)[nodes.m_first + i] = ((__local const float4*)solve->m_nodes)[i];
}

// Runs one pass over a leaf.
DRAPE_HOT_FUNCTION void sweepLeaf(const Solve* solve, const SolvePass* pass, __global SolverNode* stored)
{
    if (!takesPart(solve, pass)) return;
    Sweep sweep;
    loadLeaf(solve, stored);
    if (pass->m_pass == DRAPE_PASS_LINKS)
    {
        syncNodes();
        sweepLinks(solve);
    }
    else
    {
        openBuckets(solve);
        resetMarks(solve, &sweep);
        if (pass->m_pass == DRAPE_PASS_FACES && pass->m_sweep > 0 && solve->m_cloth->m_rests)
            keepNear(solve, solve->m_group->m_nodes);
        sweepPass(solve, pass, &sweep);
    }
    syncNodes();
    storeLeaf(solve, stored);
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
