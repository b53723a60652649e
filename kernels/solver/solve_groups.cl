// Passes of a step over large cloths: over groups that join leaves, and over the nodes of leaves. Nodes are in global
// memory; core/solver/device/solve_stage.h tells the order of passes.
#define DRAPE_NODE_SPACE __global
#define DRAPE_GLOBAL_NODES
#include "../lib/solver/solve_limits.h"
#include "../lib/solver/solve_links.h"
#include "../lib/solver/solve_nodes.h"
#include "../lib/solver/solve_passes.h"
#include "../lib/solver/solve_speeds.h"
#include "solver_bindings.h"

// Opens the group of the work-group's number in the list of groups by level.
DRAPE_HOT_FUNCTION void openGroup(Solve* solve, const SolveLayout* layout, __global const SolveInputWord* input,
                                  __global const SolveTopologyWord* topology, __global const Contact* contacts,
                                  __global SolveWorkWord* work, const SolvePass* pass, __local uint* shared)
{
    __global const uint* list = (__global const uint*)(topology + layout->m_levelGroups) + pass->m_firstGroup;
    solve->m_group = (__global const SolveGroup*)(topology + layout->m_groups) + list[get_group_id(0)];
    openCloth(solve, layout, input, topology, contacts, work, solve->m_group->m_cloth);
    solve->m_nodes = (__global SolverNode*)(work + layout->m_nodes) + solve->m_cloth->m_nodes.m_first;
    solve->m_marks = (__global uint*)(work + layout->m_marks) + solve->m_cloth->m_nodes.m_first;
    solve->m_base = 0;
    solve->m_shared = shared;
}

// Sweeps over links or contacts, or limits the speeds that contacts gave.
__kernel __attribute__((reqd_work_group_size(DRAPE_GROUP_SIZE(DRAPE_SOLVE_JOIN_GROUP), 1, 1))) void sweepGroups(
    DRAPE_SOLVE_GROUPS)
{
    __local uint shared[DRAPE_SHARED_WORDS];
    Solve solve;
    openGroup(&solve, &layout, input, topology, contacts, work, &pass, shared);
    if (pass.m_pass == DRAPE_PASS_SPEEDS || pass.m_pass == DRAPE_PASS_EDGE_SPEEDS)
    {
        if (!endsIn(&solve, &pass)) return;
        if (limitSpeeds(&solve, pass.m_pass == DRAPE_PASS_EDGE_SPEEDS)) solve.m_progress->m_isNear = 1;
        return;
    }
    if (!takesPart(&solve, &pass)) return;
    if (pass.m_pass == DRAPE_PASS_LINKS) return sweepLinks(&solve);
    Sweep sweep;
    openBuckets(&solve);
    resetMarks(&solve, &sweep);
    sweepPass(&solve, &pass, &sweep);
}

// Ends a substep and begins the next one. Finds the nodes that the motion limit may bring back, if it holds.
static void advance(const Solve* solve, const uint substep)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    const SolveRange nodes = solve->m_group->m_nodes;
    if (substep > cloth->m_substeps) return;
    const int ends = substep == cloth->m_substeps;
    if (substep > 0) endNodes(solve, nodes);
    if (ends)
    {
        settleNodes(solve, nodes);
        rememberNodes(solve, nodes);
    }
    else
        advanceNodes(solve, nodes);
    // Limits beside a moving obstacle hold at the step's end alone.
    const int holds = ends || (substep > 0 && (cloth->m_rests || substep + 1 == cloth->m_substeps));
    if (holds && cloth->m_regions.m_count > 0 && findFarNodes(solve, nodes)) solve->m_progress->m_far = substep + 1;
}

// Returns the number that a pass of the motion limit has in SolveProgress::m_far: those of the substeps, then those of
// the closing sweeps, then that of the step's end.
static uint limitNumber(const Solve* solve, const SolvePass* pass)
{
    if (pass->m_substep != DRAPE_CLOSING) return pass->m_substep + 1;
    const uint sweep = pass->m_round > 0 ? DRAPE_CLOSING_SWEEPS + 4 : pass->m_sweep;
    return solve->m_cloth->m_substeps + 1 + sweep;
}

// Returns whether the motion limit acts in the pass. The end of a step limits nodes beside resting obstacles alone, as
// MotionLimit::applyToOthers() does.
static int isLimited(const Solve* solve, const SolvePass* pass)
{
    if (pass->m_substep != DRAPE_CLOSING) return pass->m_substep < solve->m_cloth->m_substeps;
    if (pass->m_round > 0) return solve->m_cloth->m_rests && solve->m_progress->m_blocks > 0 && endsIn(solve, pass);
    return pass->m_sweep == 0 || (!solve->m_cloth->m_rests && needsSweep(solve, pass->m_sweep));
}

// Brings nodes near a moving obstacle back. The last such obstacle of a substep bounds what they gain.
static void carryBack(const Solve* solve, const SolvePass* pass)
{
    const SolveRange regions = solve->m_cloth->m_regions, nodes = solve->m_group->m_nodes;
    bringBackNear(solve, nodes, solve->m_regions + regions.m_first + pass->m_region);
    for (uint i = pass->m_region + 1; i < regions.m_count; ++i)
        if (solve->m_regions[regions.m_first + i].m_moves) return;
    if (pass->m_substep < solve->m_cloth->m_substeps) boundShifts(solve, nodes);
}

// Runs a pass of the motion limit.
DRAPE_RARE_FUNCTION void limitNodes(const Solve* solve, const SolvePass* pass)
{
    const SolveRange regions = solve->m_cloth->m_regions, nodes = solve->m_group->m_nodes;
    if (regions.m_count == 0 || !isLimited(solve, pass)) return;
    if (pass->m_pass == DRAPE_PASS_FAR)
    {
        if (findFarNodes(solve, nodes)) solve->m_progress->m_far = limitNumber(solve, pass);
        return;
    }
    if (solve->m_progress->m_far != limitNumber(solve, pass)) return;
    if (pass->m_pass == DRAPE_PASS_LIMIT) return allowByResting(solve, nodes, pass->m_round == 0);
    if (pass->m_pass == DRAPE_PASS_BRING_BACK)
    {
        bringBackAllowed(solve, nodes);
        if (solve->m_cloth->m_rests && pass->m_substep < solve->m_cloth->m_substeps) boundShifts(solve, nodes);
        return;
    }
    if (pass->m_region >= regions.m_count || !solve->m_regions[regions.m_first + pass->m_region].m_moves) return;
    if (pass->m_pass == DRAPE_PASS_NEAR)
        findNear(solve, nodes, solve->m_regions + regions.m_first + pass->m_region);
    else
        carryBack(solve, pass);
}

static void writeResult(const Solve* solve, const SolvePass* pass, __global SolveResult* result)
{
    const int ends = endsIn(solve, pass);
    if (solve->m_progress->m_ended != 0 && !ends) return;  // in an earlier round
    result->m_mayHavePassed = solve->m_progress->m_isNear;
    result->m_isOpen = !ends;
    result->m_refused = solve->m_progress->m_refused;
    result->m_meets = solve->m_progress->m_meets;
    if (ends) solve->m_progress->m_ended = pass->m_round;
}

// Runs a pass over the nodes of leaves; the first one also over the links of all groups.
__kernel __attribute__((reqd_work_group_size(DRAPE_GROUP_SIZE(DRAPE_SOLVE_GROUP), 1, 1))) void passNodes(
    DRAPE_SOLVE_GROUPS)
{
    __local uint shared[DRAPE_SHARED_WORDS];
    Solve solve;
    openGroup(&solve, &layout, input, topology, contacts, work, &pass, shared);
    const SolveRange nodes = solve.m_group->m_nodes;
    switch (pass.m_pass)
    {
        case DRAPE_PASS_BEGIN:
            beginNodes(&solve, nodes);
            return beginLinks(&solve);
        case DRAPE_PASS_ADVANCE:
            return advance(&solve, pass.m_substep);
        case DRAPE_PASS_END:
            if (endsIn(&solve, &pass)) addShifts(&solve, nodes);
            return;
        case DRAPE_PASS_RESULT:
            if (get_local_id(0) == 0)
                writeResult(&solve, &pass, (__global SolveResult*)(work + layout.m_results) + solve.m_group->m_cloth);
            return;
        default:
            return limitNodes(&solve, &pass);
    }
}
