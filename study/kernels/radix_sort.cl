// A stable sort of numbers by 32-bit keys, least digit first: eight bits a pass, three launches each.
//
// Two shapes with the same result: for GPUs a work-group sorts a tile in local memory before it scatters, so that
// writes come in runs; for CPUs a work-item counts and moves a long stretch alone.
#include "../../kernels/lib/work_items/group_scan.h"
#include "../../kernels/shared/types.h"

#define DRAPE_RADIX_DIGITS 256u
#define DRAPE_RADIX_GROUP 256
#define DRAPE_RADIX_SHARE 8  // adjacent keys of a work-item
#define DRAPE_RADIX_TILE (DRAPE_RADIX_GROUP * DRAPE_RADIX_SHARE)

static uint digitOf(const uint key, const uint shift)
{
    return (key >> shift) & (DRAPE_RADIX_DIGITS - 1u);
}

// A work-group counts a tile's digits: counts[digit × tiles + tile].
__kernel __attribute__((reqd_work_group_size(DRAPE_RADIX_GROUP, 1, 1))) void radixCountTiles(
    __global const uint* restrict keys, const uint count, const uint shift, __global uint* restrict counts)
{
    __local uint histogram[DRAPE_RADIX_DIGITS];
    const uint item = get_local_id(0);
    histogram[item] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint first = get_group_id(0) * DRAPE_RADIX_TILE;
    const uint end = min(count, first + DRAPE_RADIX_TILE);
    for (uint i = first + item; i < end; i += DRAPE_RADIX_GROUP)
        atomic_inc(histogram + digitOf(keys[i], shift));
    barrier(CLK_LOCAL_MEM_FENCE);
    counts[item * get_num_groups(0) + get_group_id(0)] = histogram[item];
}

// A work-item counts a stretch's digits. Stretches take the place of tiles.
__kernel void radixCountStretches(__global const uint* restrict keys, const uint count, const uint shift,
                                  __global uint* restrict counts, const uint stretches, const uint length)
{
    const uint stretch = get_global_id(0);
    if (stretch >= stretches) return;
    uint histogram[DRAPE_RADIX_DIGITS];
    for (uint digit = 0; digit < DRAPE_RADIX_DIGITS; ++digit)
        histogram[digit] = 0;
    const uint end = min(count, (stretch + 1) * length);
    for (uint i = stretch * length; i < end; ++i)
        ++histogram[digitOf(keys[i], shift)];
    for (uint digit = 0; digit < DRAPE_RADIX_DIGITS; ++digit)
        counts[digit * stretches + stretch] = histogram[digit];
}

// A work-group is a digit: its counts become the sums before them, and their total goes to totals.
__kernel __attribute__((reqd_work_group_size(DRAPE_RADIX_GROUP, 1, 1))) void radixScanDigits(
    __global uint* restrict counts, const uint tiles, __global uint* restrict totals)
{
    __local uint scratch[DRAPE_RADIX_GROUP];
    __global uint* row = counts + get_group_id(0) * tiles;
    uint base = 0;
    for (uint first = 0; first < tiles; first += DRAPE_RADIX_GROUP)
    {
        const uint i = first + get_local_id(0);
        uint total;
        const uint before = groupPrefix(scratch, i < tiles ? row[i] : 0, &total);
        if (i < tiles) row[i] = base + before;
        base += total;
    }
    if (get_local_id(0) == 0) totals[get_group_id(0)] = base;
}

// Does the work of radixScanDigits with a work-item per digit, for few tiles.
__kernel void radixScanDigitsSerial(__global uint* restrict counts, const uint tiles, __global uint* restrict totals)
{
    const uint digit = get_global_id(0);
    if (digit >= DRAPE_RADIX_DIGITS) return;
    uint base = 0;
    for (uint i = digit * tiles; i < (digit + 1) * tiles; ++i)
    {
        const uint own = counts[i];
        counts[i] = base;
        base += own;
    }
    totals[digit] = base;
}

// One stable pass over four bits of a tile in local memory: places of a work-item's keys in the tile. Loops over a
// work-item's keys have a known length, so that a GPU keeps them in registers.
static void placesByNibble(const uint* nibbles, const uint own, __local ushort* counters, __local uint* scratch,
                           uint* places)
{
    const uint item = get_local_id(0);
    for (uint k = 0; k < 16; ++k)
        counters[k * DRAPE_RADIX_GROUP + item] = 0;
    DRAPE_UNROLL
    for (uint k = 0; k < DRAPE_RADIX_SHARE; ++k)
        if (k < own) ++counters[nibbles[k] * DRAPE_RADIX_GROUP + item];
    barrier(CLK_LOCAL_MEM_FENCE);
    uint sum = 0;
    for (uint k = 0; k < 16; ++k)
        sum += counters[item * 16 + k];
    uint total;
    uint before = groupPrefix(scratch, sum, &total);
    for (uint k = 0; k < 16; ++k)
    {
        const uint value = counters[item * 16 + k];
        counters[item * 16 + k] = (ushort)before;
        before += value;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    DRAPE_UNROLL
    for (uint k = 0; k < DRAPE_RADIX_SHARE; ++k)
        if (k < own) places[k] = counters[nibbles[k] * DRAPE_RADIX_GROUP + item]++;
    barrier(CLK_LOCAL_MEM_FENCE);
}

// A work-group moves a tile: sorts it by four bits twice, then every key goes behind its equals of the tiles before.
__kernel __attribute__((reqd_work_group_size(DRAPE_RADIX_GROUP, 1, 1))) void radixScatterTiles(
    __global const uint* restrict keys, __global const uint* restrict numbers, const uint count, const uint shift,
    __global const uint* restrict counts, __global const uint* restrict totals, __global uint* restrict keysOut,
    __global uint* restrict numbersOut)
{
    __local uint tileKeys[DRAPE_RADIX_TILE];
    __local uint tileNumbers[DRAPE_RADIX_TILE];
    __local ushort counters[16 * DRAPE_RADIX_GROUP];
    __local uint scratch[DRAPE_RADIX_GROUP];
    __local uint begins[DRAPE_RADIX_DIGITS];
    const uint item = get_local_id(0);
    const uint first = get_group_id(0) * DRAPE_RADIX_TILE;
    const uint size = min((uint)DRAPE_RADIX_TILE, count - first);
    for (uint i = item; i < size; i += DRAPE_RADIX_GROUP)
    {
        tileKeys[i] = keys[first + i];
        tileNumbers[i] = numbers[first + i];
    }
    uint total;
    const uint digitBase = groupPrefix(scratch, totals[item], &total);  // its barriers order the loads above

    const uint own =
        item * DRAPE_RADIX_SHARE < size ? min((uint)DRAPE_RADIX_SHARE, size - item * DRAPE_RADIX_SHARE) : 0;
    for (uint nibble = 0; nibble < 2; ++nibble)
    {
        uint ownKeys[DRAPE_RADIX_SHARE], ownNumbers[DRAPE_RADIX_SHARE], nibbles[DRAPE_RADIX_SHARE];
        uint places[DRAPE_RADIX_SHARE];
        DRAPE_UNROLL
        for (uint k = 0; k < DRAPE_RADIX_SHARE; ++k)
        {
            ownKeys[k] = tileKeys[item * DRAPE_RADIX_SHARE + k];  // behind the tile's size: anything, used for nothing
            ownNumbers[k] = tileNumbers[item * DRAPE_RADIX_SHARE + k];
            nibbles[k] = (ownKeys[k] >> (shift + 4 * nibble)) & 15u;
        }
        placesByNibble(nibbles, own, counters, scratch, places);
        DRAPE_UNROLL
        for (uint k = 0; k < DRAPE_RADIX_SHARE; ++k)
        {
            if (k >= own) continue;
            tileKeys[places[k]] = ownKeys[k];
            tileNumbers[places[k]] = ownNumbers[k];
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    // The new position of the digit's first key of the tile, less its position in the tile.
    for (uint i = item; i < size; i += DRAPE_RADIX_GROUP)
    {
        const uint digit = digitOf(tileKeys[i], shift);
        if (i == 0 || digitOf(tileKeys[i - 1], shift) != digit) begins[digit] = i;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    begins[item] = digitBase + counts[item * get_num_groups(0) + get_group_id(0)] - begins[item];
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < size; i += DRAPE_RADIX_GROUP)
    {
        const uint place = begins[digitOf(tileKeys[i], shift)] + i;
        keysOut[place] = tileKeys[i];
        numbersOut[place] = tileNumbers[i];
    }
}

// A work-item moves a stretch.
__kernel void radixScatterStretches(__global const uint* restrict keys, __global const uint* restrict numbers,
                                    const uint count, const uint shift, __global const uint* restrict counts,
                                    __global const uint* restrict totals, __global uint* restrict keysOut,
                                    __global uint* restrict numbersOut, const uint stretches, const uint length)
{
    const uint stretch = get_global_id(0);
    if (stretch >= stretches) return;
    uint places[DRAPE_RADIX_DIGITS];
    uint base = 0;
    for (uint digit = 0; digit < DRAPE_RADIX_DIGITS; ++digit)
    {
        places[digit] = base + counts[digit * stretches + stretch];
        base += totals[digit];
    }
    const uint end = min(count, (stretch + 1) * length);
    for (uint i = stretch * length; i < end; ++i)
    {
        const uint place = places[digitOf(keys[i], shift)]++;
        keysOut[place] = keys[i];
        numbersOut[place] = numbers[i];
    }
}

// out[i] = values[numbers[i]]: brings the other word of a two-word key along.
__kernel void radixGather(__global const uint* restrict values, __global const uint* restrict numbers, const uint count,
                          __global uint* restrict out)
{
    const uint i = get_global_id(0);
    if (i < count) out[i] = values[numbers[i]];
}
