// Leaf order: Morton codes of the triangles' centroids and a stable radix sort, four bits a pass.
#include "lib/group_scan.h"
#include "lib/triangle_order.h"

#define DRAPE_SORT_GROUP 64
#define DRAPE_SORT_SHARE 8  // adjacent elements a work-item sorts
#define DRAPE_DIGITS 16

// Maps floats to unsigned integers in the same order, and back.
static uint floatRank(const float value)
{
    const uint bits = as_uint(value);
    return (bits & 0x80000000u) ? ~bits : bits | 0x80000000u;
}
static float unrank(const uint rank) { return as_float((rank & 0x80000000u) ? rank & 0x7fffffffu : ~rank); }

// A work-item takes every stride-th triangle. bounds holds the ranks (see floatRank) of the least and greatest centroid,
// three each; all ones and zeros before. Minima and maxima do not depend on the order of the atomics.
__kernel void mortonBounds(__global const Triangle* restrict triangles, __global const float* restrict positions,
                           const uint triangleCount, __global volatile uint* bounds)
{
    for (uint i = get_global_id(0); i < triangleCount; i += get_global_size(0))
    {
        const Vec3 p = triangleCentroid(triangles + i, positions);
        if (!vec3IsFinite(p)) continue;
        atomic_min(bounds + 0, floatRank(p.x));
        atomic_min(bounds + 1, floatRank(p.y));
        atomic_min(bounds + 2, floatRank(p.z));
        atomic_max(bounds + 3, floatRank(p.x));
        atomic_max(bounds + 4, floatRank(p.y));
        atomic_max(bounds + 5, floatRank(p.z));
    }
}

// A work-item is a triangle: writes its code and its number.
__kernel void mortonCodes(__global const Triangle* restrict triangles, __global const float* restrict positions,
                          const uint triangleCount, __global const uint* restrict bounds, __global uint* restrict codes,
                          __global uint* restrict numbers)
{
    const uint i = get_global_id(0);
    if (i >= triangleCount) return;
    const Vec3 low = vec3(unrank(bounds[0]), unrank(bounds[1]), unrank(bounds[2]));
    const Vec3 high = vec3(unrank(bounds[3]), unrank(bounds[4]), unrank(bounds[5]));
    codes[i] = mortonCode(triangleCentroid(triangles + i, positions), low, high);
    numbers[i] = i;
}

// Counts of each digit per work-item, digit-major, and the range of elements the item has.
static void countDigits(__global const uint* codes, const uint count, const uint shift, __local uint* digits, uint* first,
                        uint* last)
{
    const uint id = get_local_id(0);
    for (uint digit = 0; digit < DRAPE_DIGITS; ++digit) digits[digit * DRAPE_SORT_GROUP + id] = 0;
    *first = min(count, (uint)(get_global_id(0) * DRAPE_SORT_SHARE));
    *last = min(count, *first + DRAPE_SORT_SHARE);
    for (uint i = *first; i < *last; ++i) ++digits[((codes[i] >> shift) & 15u) * DRAPE_SORT_GROUP + id];
    barrier(CLK_LOCAL_MEM_FENCE);
}

// A work-group counts the digits of its stretch into groupCounts, digit-major.
__kernel __attribute__((reqd_work_group_size(DRAPE_SORT_GROUP, 1, 1))) void sortCount(
    __global const uint* restrict codes, const uint count, const uint shift, __global uint* restrict groupCounts)
{
    __local uint digits[DRAPE_DIGITS * DRAPE_SORT_GROUP];
    uint first, last;
    countDigits(codes, count, shift, digits, &first, &last);
    const uint digit = get_local_id(0);
    if (digit >= DRAPE_DIGITS) return;
    uint sum = 0;
    for (uint i = 0; i < DRAPE_SORT_GROUP; ++i) sum += digits[digit * DRAPE_SORT_GROUP + i];
    groupCounts[digit * get_num_groups(0) + get_group_id(0)] = sum;
}

// One work-group replaces the counts by the sums before them.
__kernel __attribute__((reqd_work_group_size(DRAPE_SORT_GROUP, 1, 1))) void sortScan(__global uint* restrict groupCounts,
                                                                                    const uint count)
{
    __local uint scratch[DRAPE_SORT_GROUP];
    uint base = 0;
    for (uint first = 0; first < count; first += DRAPE_SORT_GROUP)
    {
        const uint i = first + get_local_id(0);
        uint total;
        const uint before = groupPrefix(scratch, i < count ? groupCounts[i] : 0, &total);
        if (i < count) groupCounts[i] = base + before;
        base += total;
    }
}

// A work-group moves its stretch to the places its digits begin at; equal digits keep their order.
__kernel __attribute__((reqd_work_group_size(DRAPE_SORT_GROUP, 1, 1))) void sortScatter(
    __global const uint* restrict codes, __global const uint* restrict numbers, const uint count, const uint shift,
    __global const uint* restrict groupOffsets, __global uint* restrict codesOut, __global uint* restrict numbersOut)
{
    __local uint digits[DRAPE_DIGITS * DRAPE_SORT_GROUP];
    __local uint scratch[DRAPE_SORT_GROUP];
    __local uint starts[DRAPE_DIGITS];
    const uint id = get_local_id(0);
    uint first, last;
    countDigits(codes, count, shift, digits, &first, &last);

    // Each work-item sums DRAPE_DIGITS adjacent counts; with the sums before it they become places in the sorted stretch.
    uint sum = 0;
    for (uint i = 0; i < DRAPE_DIGITS; ++i) sum += digits[id * DRAPE_DIGITS + i];
    uint total;
    uint before = groupPrefix(scratch, sum, &total);
    for (uint i = 0; i < DRAPE_DIGITS; ++i)
    {
        const uint own = digits[id * DRAPE_DIGITS + i];
        digits[id * DRAPE_DIGITS + i] = before;
        before += own;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (id < DRAPE_DIGITS) starts[id] = digits[id * DRAPE_SORT_GROUP];
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = first; i < last; ++i)
    {
        const uint digit = (codes[i] >> shift) & 15u;
        const uint place = groupOffsets[digit * get_num_groups(0) + get_group_id(0)] +
                           digits[digit * DRAPE_SORT_GROUP + id]++ - starts[digit];
        codesOut[place] = codes[i];
        numbersOut[place] = numbers[i];
    }
}
