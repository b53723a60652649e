// A SIMD group is the unit that does one piece of a cull. It is one work-item with vectors of lanes (DRAPE_LANES 8 or
// 16), or one work-group whose work-items are the lanes (DRAPE_LANES 1), DRAPE_PATCH_WIDTH of them or a multiple. A
// build option selects which; the text is the same.
//
// A group gathers its results and moves many of them to a list with one atomic. The list's demand counts on past the
// capacity. Results that do not fit are not written, and the host repeats the step with a larger list. Past the limit
// the group ends: the step exceeds it in any case, and a count that ran on could wrap around. For kernels only.
#ifndef DRAPE_LIB_SIMD_GROUP_H
#define DRAPE_LIB_SIMD_GROUP_H

#include "../../shared/mesh.h"
#include "../step_data/step_views.h"
#include "lanes.h"

// Records gathered before room is reserved for them; a surplus goes to the list one by one.
#define DRAPE_GROUP_KEPT (4 * DRAPE_PATCH_WIDTH)

typedef struct SimdGroup
{
    uint m_depth;  // depth of the stack that a walk's lanes share
    FeatureTest m_kept[DRAPE_GROUP_KEPT];
    uint m_keptCount;
    uint m_index;  // list index of the records moved last
} SimdGroup;

#if DRAPE_LANES > 1
#define simdLane() 0
#define simdWidth() 1
#define simdSync()

// Returns a mask whose bit i is byte i of eight bytes, each all ones or zero. The first byte is the lowest, as on
// little-endian CPUs.
static uint byteBits(const ulong bytes)
{
    return (uint)(((bytes & 0x8040201008040201UL) * 0x0101010101010101UL) >> 56);
}

#ifndef DRAPE_CPU_KERNELS
// Stores one byte per lane of the mask.
static void laneBytes(const LaneMask mask, ulong* bytes)
{
#if DRAPE_LANES == 16
    const ulong2 all = as_ulong2(convert_char16(mask));
    bytes[0] = all.x;
    bytes[1] = all.y;
#else
    bytes[0] = as_ulong(convert_char8(mask));
#endif
}
#endif

// Bit i: lane i's mask.
static uint laneBits(const LaneMask mask)
{
    ulong bytes[DRAPE_LANES / 8];
    laneBytes(mask, bytes);
#if DRAPE_LANES == 16
    return (bytes[0] | bytes[1]) == 0 ? 0 : byteBits(bytes[0]) | byteBits(bytes[1]) << 8;
#else
    return byteBits(bytes[0]);
#endif
}

static int anyLane(const LaneMask mask)
{
    ulong bytes[DRAPE_LANES / 8];
    laneBytes(mask, bytes);
#if DRAPE_LANES == 16
    return (bytes[0] | bytes[1]) != 0;
#else
    return bytes[0] != 0;
#endif
}

// The least of all lanes.
static float leastLane(const Lanes all)
{
#ifdef DRAPE_CPU_KERNELS
    float least = laneOf(&all, 0);
    for (uint i = 1; i < DRAPE_LANES; ++i)
        least = drapeMin(least, laneOf(&all, i));
    return least;
#else
#if DRAPE_LANES == 16
    const float8 half8 = all.lo < all.hi ? all.lo : all.hi;
#else
    const float8 half8 = all;
#endif
    const float4 half4 = half8.lo < half8.hi ? half8.lo : half8.hi;
    const float2 half2 = half4.lo < half4.hi ? half4.lo : half4.hi;
    return half2.lo < half2.hi ? half2.lo : half2.hi;
#endif
}

// The counter has the lane's name in its own, so that loops nest.
#define forLanes(lane, mask)                                                                                  \
    for (uint bitsOf_##lane = laneBits(mask), lane = 31 - clz(bitsOf_##lane & -bitsOf_##lane); bitsOf_##lane; \
         bitsOf_##lane &= bitsOf_##lane - 1, lane = 31 - clz(bitsOf_##lane & -bitsOf_##lane))
#define simdAdd(counter) ((counter)++)
#else
#define simdLane() get_local_id(0)
#define simdWidth() get_local_size(0)
#define simdSync() barrier(CLK_LOCAL_MEM_FENCE)
#define forLanes(lane, mask) for (uint lane = get_local_id(0) % DRAPE_PATCH_WIDTH, once = (mask) != 0; once; once = 0)
#define simdAdd(counter) atomic_inc(&(counter))
#endif

static void simdStart(DRAPE_GROUP_MEMORY SimdGroup* group)
{
    if (simdLane() == 0) group->m_keptCount = group->m_index = group->m_depth = 0;
    simdSync();
}

// Stores a test; called by any single lane. kept: value of m_keptCount from which the lane raised it.
static void simdPut(DRAPE_GROUP_MEMORY SimdGroup* group, const TestList* list, const uint kept, const FeatureTest test)
{
    if (kept < DRAPE_GROUP_KEPT)
    {
        group->m_kept[kept] = test;
        return;
    }
    const uint index = atomic_inc(list->m_count);
    if (index < list->m_capacity) list->m_tests[index] = test;
}

static void simdKeep(DRAPE_GROUP_MEMORY SimdGroup* group, const TestList* list, const FeatureTest test)
{
    simdPut(group, list, simdAdd(group->m_keptCount), test);
}

// Moves the group's kept records to the list; all lanes call it together. Returns whether the list is within its limit.
static int simdFlush(DRAPE_GROUP_MEMORY SimdGroup* group, const TestList* list)
{
    simdSync();
    const uint count = min(group->m_keptCount, (uint)DRAPE_GROUP_KEPT);
    if (simdLane() == 0 && count > 0) group->m_index = atomic_add(list->m_count, count);
    simdSync();
    const uint index = group->m_index;
    for (uint i = simdLane(); i < count; i += simdWidth())
    {
        if (index + i < list->m_capacity) list->m_tests[index + i] = group->m_kept[i];
    }
    simdSync();
    if (simdLane() == 0) group->m_keptCount = 0;
    simdSync();
    return index <= list->m_limit;
}

// Moves the kept tests only where little room is left. Returns the same as simdFlush().
static int simdMakeRoom(DRAPE_GROUP_MEMORY SimdGroup* group, const TestList* list)
{
    simdSync();
    const uint count = group->m_keptCount;
    simdSync();
    return count <= DRAPE_GROUP_KEPT / 2 ? group->m_index <= list->m_limit : simdFlush(group, list);
}

#endif
