// Assigns the items of a list to the work-items of a launch of fixed width; the list's length is known only on the
// device. On a GPU a work-item takes every stride-th item: neighbours then read adjacent items. On a CPU it takes
// runs of adjacent items, one after the other: adjacent items lie close in space, and their data is in the cache. For
// kernels only.
#ifndef DRAPE_LIB_ITEM_RUNS_H
#define DRAPE_LIB_ITEM_RUNS_H

// Longest run: its items' data stays in a core's own cache, and runs are balanced among the cores.
#define DRAPE_MOST_RUN 128u

// m_item: the current item; none is left once it reaches the list's length.
#ifdef DRAPE_CPU
typedef struct ItemRuns
{
    uint m_item, m_end;  // current run
    uint m_run, m_runs;
    uint m_takers;  // work-items that take runs in turn
    uint m_count;
} ItemRuns;

// Divides the list into runs that differ by at most one in length. If there are more takers than items, some have none.
static void takeRun(ItemRuns* runs)
{
    const ulong run = runs->m_run, count = runs->m_count;
    runs->m_item = (uint)(run * count / runs->m_runs);
    runs->m_end = (uint)((run + 1) * count / runs->m_runs);
    if (runs->m_run >= runs->m_runs || runs->m_item == runs->m_end) runs->m_item = UINT_MAX;
}
#else
typedef struct ItemRuns
{
    uint m_item, m_stride;
} ItemRuns;
#endif

// count: equal for all work-items. parts: number of neighbouring work-items that take the same items, a divisor of the
// width.
static ItemRuns itemRuns(const uint count, const uint parts)
{
    const uint takers = get_global_size(0) / parts, taker = get_global_id(0) / parts;
    ItemRuns runs;
#ifdef DRAPE_CPU
    runs.m_run = taker;
    runs.m_runs = takers * (count / (takers * DRAPE_MOST_RUN) + 1);
    runs.m_takers = takers;
    runs.m_count = count;
    takeRun(&runs);
#else
    runs.m_item = taker;
    runs.m_stride = takers;
#endif
    return runs;
}

#ifdef DRAPE_CPU
// Takes the next run, from m_item to m_end.
static void nextRun(ItemRuns* runs)
{
    runs->m_run += runs->m_takers;
    takeRun(runs);
}
#endif

static void nextItem(ItemRuns* runs)
{
#ifdef DRAPE_CPU
    if (++runs->m_item < runs->m_end) return;
    nextRun(runs);
#else
    runs->m_item += runs->m_stride;
#endif
}

#endif
