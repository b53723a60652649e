// Sweeps over the links of a group, colour by colour (core/solver/link_sweep.h).
#ifndef DRAPE_LIB_SOLVE_LINKS_H
#define DRAPE_LIB_SOLVE_LINKS_H

#include "link_row.h"
#include "solve_view.h"

static void visitLinkAt(const Solve* solve, const uint index)
{
    const uint4 link = ((__global const uint4*)solve->m_links)[index];
    const float4 span = ((__global const float4*)solve->m_spans)[index];
    SolverNode a = loadNode(solve, link.x), b = loadNode(solve, link.y);
    visitLink(&a, &b, xyz(span), span.w, as_float(link.w));
    storeNode(solve, link.x, &a);
    storeNode(solve, link.y, &b);
}

static void sweepLinks(const Solve* solve)
{
    const SolveRange range = solve->m_group->m_linkBatches;
    for (uint i = range.m_first; i < range.m_first + range.m_count; ++i)
    {
        const SolveBatch batch = solve->m_linkBatches[i];
        if (!batch.m_serial)
            forAll(k, batch.m_first, batch.m_last) visitLinkAt(solve, k);
        else if (get_local_id(0) == 0)
            for (uint k = batch.m_first; k < batch.m_last; ++k)
                visitLinkAt(solve, k);
        syncNodes();
    }
}

// Records how far apart the nodes of the group's links are at the step's start.
static void beginLinks(const Solve* solve)
{
    const SolveRange range = solve->m_group->m_linkBatches;
    if (range.m_count == 0) return;
    const uint last = solve->m_linkBatches[range.m_first + range.m_count - 1].m_last;
    forAll(link, solve->m_linkBatches[range.m_first].m_first, last)
    {
        const SolveLink joined = solve->m_links[link];
        solve->m_spans[link].m_apart =
            vec3Sub(solve->m_paths[joined.m_nodes[1]].m_start, solve->m_paths[joined.m_nodes[0]].m_start);
        solve->m_spans[link].m_restSquared = joined.m_restSquared;
    }
}

#endif
