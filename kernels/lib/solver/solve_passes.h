// Passes of a step over groups of large cloths (SolvePass): which cloths take part, and sweeps over contacts.
#ifndef DRAPE_LIB_SOLVE_PASSES_H
#define DRAPE_LIB_SOLVE_PASSES_H

#include "closing_sweeps.h"
#include "solve_contacts.h"

// Returns whether the cloth needs another closing sweep after `done` sweeps. A sweep that was not needed has met no
// violation, so that no later one is needed.
static int needsSweep(const Solve* solve, const uint done)
{
    __global const SolveProgress* progress = solve->m_progress;
    if (progress->m_blocks == 0) return 0;
    return done == 0 || needsClosing(done, progress->m_blocks, progress->m_worst[done - 1],
                                     solve->m_cloth->m_fineViolation, solve->m_cloth->m_mostViolation);
}

// Returns whether the closing sweeps before pass->m_sweep were enough, so that the step ends in this round.
static int endsIn(const Solve* solve, const SolvePass* pass)
{
    const uint ended = solve->m_progress->m_ended;
    return (ended == 0 || ended == pass->m_round) && !needsSweep(solve, pass->m_sweep);
}

// Returns the worst violation that the last closing sweep met, m.
static float lastWorst(const Solve* solve, const SolvePass* pass)
{
    uint done = 1;
    while (done < pass->m_sweep && needsSweep(solve, done))
        ++done;
    return solve->m_progress->m_worst[done - 1];
}

// Returns whether the cloth takes part in the pass over its links or contacts.
static int takesPart(const Solve* solve, const SolvePass* pass)
{
    if (pass->m_substep != DRAPE_CLOSING) return pass->m_substep < solve->m_cloth->m_substeps;
    if (pass->m_pass != DRAPE_PASS_NODES) return needsSweep(solve, pass->m_sweep);
    return solve->m_progress->m_blocks > 0 && endsIn(solve, pass) &&
           lastWorst(solve, pass) > solve->m_cloth->m_fineViolation;
}

// Runs a pass over the contacts of the group.
DRAPE_HOT_FUNCTION void sweepPass(const Solve* solve, const SolvePass* pass, Sweep* sweep)
{
    __global const SolveGroup* group = solve->m_group;
    const int closes = pass->m_substep == DRAPE_CLOSING;
    if (closes)
        beginClosing(solve, sweep);
    else
        beginSubstep(solve, pass->m_substep, sweep);
    const uint nodes = group->m_nodeBuckets, faces = nodes + group->m_faceBuckets;
    const int ofEdges = pass->m_pass == DRAPE_PASS_EDGES;
    const uint last = ofEdges ? faces + group->m_edgeBuckets : pass->m_pass == DRAPE_PASS_FACES ? faces : nodes;
    sweepBuckets(solve, ofEdges ? faces : 0, last, ofEdges && !closes ? solve->m_cloth->m_actingSweeps : 0, sweep);
    syncNodes();
    forAll(i, 0, bucketsOf(solve)) solve->m_buckets[group->m_firstBucket + i].m_pushed =
        solve->m_shared[DRAPE_SHARED_PUSHED + i];
    if (closes && pass->m_pass != DRAPE_PASS_NODES && sweep->m_worst > 0.0f)
        atomic_max((__global uint*)(solve->m_progress->m_worst + pass->m_sweep), as_uint(sweep->m_worst));
}

#endif
