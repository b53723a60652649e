// Sweeps over the links of a group, colour by colour (core/solver/host/link_sweep.h).
#ifndef DRAPE_LIB_SOLVE_LINKS_H
#define DRAPE_LIB_SOLVE_LINKS_H

#include "link_row.h"
#include "solve_view.h"

// A link of a batch, as a work-item loads it.
typedef struct LoadedLink
{
    uint4 m_link;
    float4 m_span;
} LoadedLink;

DRAPE_HOT_FUNCTION LoadedLink loadLink(const Solve* solve, const uint index)
{
    LoadedLink loaded;
    loaded.m_link = ((__global const uint4*)solve->m_links)[index];
    loaded.m_span = ((__global const float4*)solve->m_spans)[index];
    return loaded;
}

DRAPE_HOT_FUNCTION void visitLoadedLink(const Solve* solve, const LoadedLink* loaded)
{
    const uint4 link = loaded->m_link;
    SolverNode a = loadNode(solve, link.x), b = loadNode(solve, link.y);
    visitLink(&a, &b, xyz(loaded->m_span), loaded->m_span.w, as_float(link.w));
    storeNode(solve, link.x, &a);
    storeNode(solve, link.y, &b);
}

DRAPE_HOT_FUNCTION void visitLinks(const Solve* solve, uint first, const uint last, const uint step)
{
    for (; first < last; first += step)
    {
        const LoadedLink link = loadLink(solve, first);
        visitLoadedLink(solve, &link);
    }
}

// Loads each batch's links while the batch before it is visited.
DRAPE_HOT_FUNCTION void sweepLinks(const Solve* solve)
{
    const SolveRange range = solve->m_group->m_linkBatches;
    if (range.m_count == 0) return;
    const uint item = get_local_id(0), width = get_local_size(0);
    SolveBatch batch = solve->m_linkBatches[range.m_first];
    LoadedLink link;
    if (batch.m_first + item < batch.m_last) link = loadLink(solve, batch.m_first + item);
    for (uint i = 1; i <= range.m_count; ++i)
    {
        SolveBatch next = batch;
        LoadedLink nextLink;
        if (i < range.m_count) next = solve->m_linkBatches[range.m_first + i];
        if (next.m_first + item < next.m_last) nextLink = loadLink(solve, next.m_first + item);
        if (!batch.m_serial)
        {
            if (batch.m_first + item < batch.m_last) visitLoadedLink(solve, &link);
            visitLinks(solve, batch.m_first + item + width, batch.m_last, width);
        }
        else if (item == 0)
            visitLinks(solve, batch.m_first, batch.m_last, 1);
        syncNodes();
        batch = next;
        link = nextLink;
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
