// Motion of a cloth's nodes in a step (solver_node.h), for the nodes of a group.
#ifndef DRAPE_LIB_SOLVE_NODES_H
#define DRAPE_LIB_SOLVE_NODES_H

#include "solve_view.h"
#include "solver_node.h"

static void beginNodes(const Solve* solve, const SolveRange nodes)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    forAll(i, nodes.m_first, nodes.m_first + nodes.m_count)
    {
        const NodePath path = solve->m_paths[i];
        nodeAt(solve, i)->m_inverseMass = path.m_freeMass;
        nodeBegin(nodeAt(solve, i), solve->m_states + i, path.m_vector,
                  vec3AddScaled(solve->m_supports[i], solve->m_accelerations[i], cloth->m_spread), cloth->m_perStep,
                  cloth->m_pathShare);
        solve->m_states[i].m_shifted = 0;
    }
}

static void advanceNodes(const Solve* solve, const SolveRange nodes)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    forAll(i, nodes.m_first, nodes.m_first + nodes.m_count)
        nodeAdvance(nodeAt(solve, i), solve->m_states + i, vec3Scale(solve->m_accelerations[i], cloth->m_spread),
                    cloth->m_substepTime);
}

static void endNodes(const Solve* solve, const SolveRange nodes)
{
    forAll(i, nodes.m_first, nodes.m_first + nodes.m_count)
        nodeEnd(nodeAt(solve, i), solve->m_states + i, solve->m_cloth->m_perCorrection, solve->m_cloth->m_undamped);
}

// See StepSolver::settle(). The group's work-items must see SolveProgress::m_pushed.
static void settleNodes(const Solve* solve, const SolveRange nodes)
{
    if (!solve->m_cloth->m_settles || solve->m_progress->m_pushed == 0) return;
    forAll(i, nodes.m_first, nodes.m_first + nodes.m_count) if (solve->m_paths[i].m_inverseMass > 0.0f)
        nodeSettle(nodeAt(solve, i), solve->m_states + i, solve->m_accelerations[i], solve->m_cloth->m_perStep);
}

static void rememberNodes(const Solve* solve, const SolveRange nodes)
{
    forAll(i, nodes.m_first, nodes.m_first + nodes.m_count) nodeRemember(nodeAt(solve, i), solve->m_states + i);
}

static void boundShifts(const Solve* solve, const SolveRange nodes)
{
    forAll(i, nodes.m_first, nodes.m_first + nodes.m_count) nodeLimitShift(
        nodeAt(solve, i), solve->m_states + i, solve->m_cloth->m_perCorrection, solve->m_cloth->m_perSecond);
}

static void addShifts(const Solve* solve, const SolveRange nodes)
{
    forAll(i, nodes.m_first, nodes.m_first + nodes.m_count)
        nodeAddShift(nodeAt(solve, i), solve->m_states + i, solve->m_cloth->m_perShift);
}

#endif
