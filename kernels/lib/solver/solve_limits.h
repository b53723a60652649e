// Motion limits of a cloth's nodes (core/solver/host/motion_limit.h). Only for nodes from the cloth's first on.
#ifndef DRAPE_LIB_SOLVE_LIMITS_H
#define DRAPE_LIB_SOLVE_LIMITS_H

#include "motion_limit.h"
#include "solve_contacts.h"

// Returns whether what the node or its faces may pass between the ends of their paths and their positions meets the
// region.
DRAPE_RARE_FUNCTION int isNearRegion(const Solve* solve, const uint node, __global const SolveRegion* region)
{
    Box box, own = pointBox(vec3Add(solve->m_paths[node].m_start, solve->m_paths[node].m_vector));
    box.m_low = region->m_low;
    box.m_high = region->m_high;
    growByPassed(&own, solve->m_nodes + node, solve->m_paths + node);
    int near = boxesMeet(&own, &box);
    __global const uint* list = solve->m_faceLists + node;
    for (uint i = list[0]; i < list[1] && !near; ++i)
    {
        __global const int* face = solve->m_faces + 3 * solve->m_facesOfNode[i];
        Box passed = pointBox(vec3Add(solve->m_paths[face[0]].m_start, solve->m_paths[face[0]].m_vector));
        for (int k = 0; k < 3; ++k)
            growByPassed(&passed, solve->m_nodes + face[k], solve->m_paths + face[k]);
        near = boxesMeet(&passed, &box);
    }
    return near;
}

// Marks the nodes that the limit may bring back. Returns whether the work-item's are among them.
static int findFarNodes(const Solve* solve, const SolveRange nodes)
{
    int any = 0;
    forAll(node, nodes.m_first, nodes.m_first + nodes.m_count)
    {
        const int far = isFarFromEnd(solve->m_nodes + node, solve->m_paths + node, solve->m_cloth->m_sure);
        solve->m_states[node].m_isFar = far;
        any |= far;
    }
    return any;
}

// Computes how far far nodes may leave their paths beside the obstacles that rest. withContacts: whether nodes with
// contacts are among them.
DRAPE_RARE_FUNCTION void allowByResting(const Solve* solve, const SolveRange nodes, const int withContacts)
{
    const SolveRange regions = solve->m_cloth->m_regions;
    forAll(node, nodes.m_first, nodes.m_first + nodes.m_count)
    {
        if (!solve->m_states[node].m_isFar) continue;
        __global SolveAllowance* allowance = solve->m_allowances + node;
        float start = DRAPE_INFINITY, end = DRAPE_INFINITY;
        for (uint i = regions.m_first; i < regions.m_first + regions.m_count; ++i)
        {
            __global const SolveRegion* region = solve->m_regions + i;
            if (region->m_moves) continue;
            const int hasContact = allowance->m_hasContact != 0;
            if (hasContact ? !withContacts : !isNearRegion(solve, node, region)) continue;
            start = drapeMin(start, region->m_start);
            end = drapeMin(end, hasContact ? region->m_start : region->m_end);
        }
        allowance->m_start = start;
        allowance->m_end = end;
    }
}

static void bringBackAllowed(const Solve* solve, const SolveRange nodes)
{
    forAll(node, nodes.m_first, nodes.m_first + nodes.m_count)
    {
        const SolveAllowance allowance = solve->m_allowances[node];
        if (!solve->m_states[node].m_isFar || allowance.m_end == DRAPE_INFINITY) continue;
        bringBack(solve->m_nodes + node, solve->m_states + node, vec3(0.0f, 0.0f, 0.0f), solve->m_paths[node].m_vector,
                  allowance.m_start, allowance.m_end);
    }
}

// Marks the far nodes near a moving obstacle.
DRAPE_RARE_FUNCTION void findNear(const Solve* solve, const SolveRange nodes, __global const SolveRegion* region)
{
    forAll(node, nodes.m_first, nodes.m_first + nodes.m_count) solve->m_allowances[node].m_isNear =
        solve->m_states[node].m_isFar ? isNearRegion(solve, node, region) : 0;
}

DRAPE_RARE_FUNCTION void bringBackNear(const Solve* solve, const SolveRange nodes, __global const SolveRegion* region)
{
    forAll(node, nodes.m_first, nodes.m_first + nodes.m_count)
    {
        if (!solve->m_allowances[node].m_isNear) continue;
        const Vec3 from = solve->m_paths[node].m_start;
        const Vec3 start = vec3Sub(carriedStart(solve->m_surfaces + region->m_surface, from), from);
        const float end = solve->m_allowances[node].m_hasContact ? region->m_start : region->m_end;
        bringBack(solve->m_nodes + node, solve->m_states + node, start, solve->m_paths[node].m_vector, region->m_start,
                  end);
    }
}

// See MotionLimit::keepNear(). For any of the cloth's nodes.
static void keepNear(const Solve* solve, const SolveRange nodes)
{
    __global const SolveCloth* cloth = solve->m_cloth;
    forAll(node, nodes.m_first, nodes.m_first + nodes.m_count)
    {
        if (!solve->m_allowances[node].m_hasContact) continue;
        if (!isFarFromEnd(nodeAt(solve, node), solve->m_paths + node, cloth->m_sure)) continue;
        bringBack(nodeAt(solve, node), solve->m_states + node, vec3(0.0f, 0.0f, 0.0f), solve->m_paths[node].m_vector,
                  cloth->m_leastTolerance, cloth->m_leastTolerance);
    }
    syncNodes();
}

#endif
