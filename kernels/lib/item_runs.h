// Which items of a list, whose length is only on the device, a work-item of a launch of fixed width takes. On a GPU every
// stride-th: neighbours then read side by side. On a CPU runs of adjacent ones, one after the other: what lies side by side
// in a list lies side by side in space, and finds what it reads in the cache. For OpenCL C only.
#ifndef DRAPE_LIB_ITEM_RUNS_H
#define DRAPE_LIB_ITEM_RUNS_H

// Longest run: what its items read stays in a core's own cache, and runs even out among the cores.
#define DRAPE_MOST_RUN 128u

typedef struct ItemRuns
{
    uint m_item;  // the one at hand; there is none left where it is not below the list's length
    uint m_left;  // of its run, with itself
    uint m_run;
    uint m_skip;  // from the last item of a run to the first of the next
} ItemRuns;

// parts: neighbouring work-items that take the same items.
static ItemRuns itemRuns(const uint count, const uint parts)
{
    const uint items = get_global_size(0) / parts, item = get_global_id(0) / parts;
    ItemRuns runs;
#ifdef DRAPE_CPU
    const uint share = max((count + items - 1) / items, 1u);
    const uint turns = (share + DRAPE_MOST_RUN - 1) / DRAPE_MOST_RUN;  // all take as many
    runs.m_run = (share + turns - 1) / turns;
#else
    runs.m_run = 1;
#endif
    runs.m_item = item * runs.m_run;
    runs.m_left = runs.m_run;
    runs.m_skip = (items - 1) * runs.m_run + 1;
    return runs;
}

static void nextItem(ItemRuns* runs)
{
#ifdef DRAPE_CPU
    --runs->m_left;
    runs->m_item += runs->m_left > 0 ? 1 : runs->m_skip;
    if (runs->m_left == 0) runs->m_left = runs->m_run;
#else
    runs->m_item += runs->m_skip;
#endif
}

#endif
