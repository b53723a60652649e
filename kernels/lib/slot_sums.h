// Sums that give the position of a slot's contacts in a list ordered by slot, for few slots. Kernels that count a
// slot's contacts also add them up by rows of slots. Every work-item can then sum for itself, and no extra launch has
// to sum before. For kernels only.
#ifndef DRAPE_LIB_SLOT_SUMS_H
#define DRAPE_LIB_SLOT_SUMS_H

#include "../shared/slot_sums.h"

// Adds `hits` contacts of a slot. sums: DRAPE_SLOT_SUMS elements.
static void addToSums(__global volatile uint* sums, const uint slot, const uint hits)
{
    atomic_add(sums + slot / DRAPE_SUMMED, hits);
}

#ifndef DRAPE_CPU_KERNELS
// Returns the sum of the first `count` of DRAPE_SUMMED numbers. Uses masks: PoCL 3.1 miscompiles choices by component.
static uint sumOfFirst(__global const uint* numbers, const uint count)
{
    uint4 sums = 0;
    DRAPE_UNROLL
    for (uint i = 0; i < DRAPE_SUMMED; i += 4)
        sums += ((__global const uint4*)numbers)[i / 4] & as_uint4((uint4)(i, i + 1, i + 2, i + 3) < (uint4)(count));
    return sums.x + sums.y + sums.z + sums.w;
}

// Sums rows by DRAPE_SUMMED, in a group of at least DRAPE_WIDE_SUMS work-items. wide: gets DRAPE_WIDE_SUMS sums.
static void sumRows(__global const uint* sums, __local uint* wide)
{
    const uint id = get_local_id(0);
    if (id < DRAPE_WIDE_SUMS) wide[id] = sumOfFirst(sums + id * DRAPE_SUMMED, DRAPE_SUMMED);
    barrier(CLK_LOCAL_MEM_FENCE);
}

static uint sumOfWide(__local const uint* wide, const uint count)
{
    uint sum = 0;
    for (uint i = 0; i < count; ++i) sum += wide[i];
    return sum;
}

// Returns the number of contacts in the slots before this one. counts: of each slot; wide: from sumRows().
static uint hitsBefore(__global const uint* counts, __global const uint* sums, __local const uint* wide, const uint slot)
{
    const uint row = slot / DRAPE_SUMMED, firstRow = row / DRAPE_SUMMED * DRAPE_SUMMED;
    return sumOfWide(wide, row / DRAPE_SUMMED) + sumOfFirst(sums + firstRow, row - firstRow) +
           sumOfFirst(counts + row * DRAPE_SUMMED, slot % DRAPE_SUMMED);
}

// Zeroes counts and sums; all work-items of the launch call it together. Does nothing if sums is null.
static void clearSums(__global uint* counts, __global uint* sums, const uint slots)
{
    if (!sums) return;
    for (uint i = get_global_id(0); i < slots; i += get_global_size(0)) counts[i] = 0;
    for (uint i = get_global_id(0); i < DRAPE_SLOT_SUMS; i += get_global_size(0)) sums[i] = 0;
}
#endif

#endif
