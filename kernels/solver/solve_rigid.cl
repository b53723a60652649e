// Rows beside rigid bodies in a step that is solved by passes. A work-item projects a chain of runs: the rows of one
// node, where no body moves, or else all that share bodies or nodes, in the host's order. The result is the host's,
// bit for bit.
#define DRAPE_NODE_SPACE __global
#include "../lib/solver/rigid_row.h"
#include "solver_bindings.h"

// Takes the bodies, and what cloths gave to them, as the step begins.
__kernel void takeRigid(DRAPE_SOLVE_RIGID)
{
    __global const RigidBody* bodies = (__global const RigidBody*)(input + rigid.m_bodiesBefore);
    __global const RigidGiven* given = (__global const RigidGiven*)(input + rigid.m_givenBefore);
    const uint index = get_global_id(0);
    if (index < rigid.m_bodyCount) ((__global RigidBody*)(work + rigid.m_bodies))[index] = bodies[index];
    if (index < rigid.m_givenCount) ((__global RigidGiven*)(work + rigid.m_given))[index] = given[index];
}

static RigidSubstep openRun(const SolveLayout* layout, const RigidLayout* rigid, __global const SolveCloth* cloth,
                            __global SolveWorkWord* work, const uint given, const uint substep)
{
    const uint first = cloth->m_nodes.m_first;
    RigidSubstep opened;
    opened.m_nodes = (__global SolverNode*)(work + layout->m_nodes) + first;
    opened.m_states = (__global NodeState*)(work + layout->m_states) + first;
    opened.m_paths = (__global const NodePath*)(work + layout->m_paths) + first;
    opened.m_bodies = (__global RigidBody*)(work + rigid->m_bodies);
    opened.m_given = (__global RigidGiven*)(work + rigid->m_given) + given;
    opened.m_time = cloth->m_substepTime;
    opened.m_perCorrection = cloth->m_perCorrection;
    opened.m_passed = (float)(substep + 1) / (float)cloth->m_substeps;
    opened.m_left = rigidLeft(opened.m_time, cloth->m_substeps, substep);
    return opened;
}

// Projects the rows of the runs once. pass.m_sweep counts the projections of a substep.
__kernel void projectRigid(DRAPE_SOLVE_RIGID, DRAPE_VALUE(SolvePass, pass))
{
    if (get_global_id(0) >= rigid.m_chainCount) return;
    const RigidChain chain = ((__global const RigidChain*)(input + rigid.m_chains))[get_global_id(0)];
    __global const RigidRun* runs = (__global const RigidRun*)(input + rigid.m_runs);
    __global const RigidAnchor* anchors = (__global const RigidAnchor*)(input + rigid.m_anchors);
    __global const RigidContact* contacts = (__global const RigidContact*)(input + rigid.m_contacts);
    __global RigidRowState* states = (__global RigidRowState*)(work + rigid.m_states);
    // The rows end a substep after all of the chain's were projected, as one more round.
    for (uint ends = 0; ends < 2; ++ends)
    {
        for (uint i = chain.m_first; i < chain.m_last; ++i)
        {
            const RigidRun run = runs[i];
            __global const SolveCloth* cloth = (__global const SolveCloth*)(input + layout.m_cloths) + run.m_cloth;
            if (pass.m_substep >= cloth->m_substeps || (ends && pass.m_sweep + 1 < cloth->m_linkSweeps)) continue;
            const RigidSubstep substep = openRun(&layout, &rigid, cloth, work, run.m_given, pass.m_substep);
            for (uint k = run.m_firstAnchor; k < run.m_lastAnchor; ++k)
            {
                if (ends)
                    rigidEndRow(&substep, anchors[k].m_body, anchors[k].m_arm, states + k);
                else
                    rigidProjectAnchor(&substep, anchors + k, states + k);
            }
            for (uint k = run.m_firstContact; k < run.m_lastContact; ++k)
            {
                __global RigidRowState* state = states + rigid.m_anchorCount + k;
                if (ends)
                {
                    rigidEndRow(&substep, contacts[k].m_body, contacts[k].m_arm, state);
                    continue;
                }
                if (pass.m_sweep == 0) rigidBeginRow(state);
                rigidProjectContact(&substep, contacts + k, state);
            }
        }
    }
}
