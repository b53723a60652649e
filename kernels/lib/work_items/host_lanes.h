// Vectors of lanes in C++, as vector types of GCC and Clang: the base of lanes.h in the host's kernels, and the mask
// functions for simd_group.h. Included by lanes.h, within its namespace.
#ifndef DRAPE_LIB_HOST_LANES_H
#define DRAPE_LIB_HOST_LANES_H

typedef float Lanes __attribute__((vector_size(4 * DRAPE_LANES)));
typedef int LaneMask __attribute__((vector_size(4 * DRAPE_LANES)));

DRAPE_FUNCTION Lanes lanesSplat(float a)
{
    return a - Lanes{};
}
DRAPE_FUNCTION Lanes lanesSplat(Lanes a)
{
    return a;
}
DRAPE_FUNCTION LaneMask lanesMaskSplat(int a)
{
    return LaneMask{} - a;
}
DRAPE_FUNCTION LaneMask lanesNot(LaneMask mask)
{
    return ~mask;
}

DRAPE_FUNCTION Lanes lanesLoad(const float* block, DRAPE_UINT component)
{
    Lanes lanes;
    __builtin_memcpy(&lanes, block + DRAPE_LANES * component, sizeof lanes);
    return lanes;
}
DRAPE_FUNCTION void lanesStore(Lanes lanes, float* block, DRAPE_UINT component)
{
    __builtin_memcpy(block + DRAPE_LANES * component, &lanes, sizeof lanes);
}

DRAPE_FUNCTION LaneMask lanesLoadIds(const DRAPE_UINT* rows, DRAPE_UINT row)
{
    LaneMask ids;
    __builtin_memcpy(&ids, rows + DRAPE_LANES * row, sizeof ids);
    return ids;
}

DRAPE_FUNCTION Lanes lanesSelect(LaneMask mask, Lanes yes, Lanes no)
{
    return mask ? yes : no;
}
DRAPE_FUNCTION Lanes lanesSelect(LaneMask mask, Lanes yes, float no)
{
    return mask ? yes : lanesSplat(no);
}

DRAPE_FUNCTION Lanes lanesAbs(Lanes a)
{
    return (Lanes)((LaneMask)a & 0x7fffffff);
}
DRAPE_FUNCTION Lanes drapeSqrt(Lanes a)
{
    Lanes root;
    for (int i = 0; i < DRAPE_LANES; ++i)
        root[i] = __builtin_sqrtf(a[i]);
    return root;
}
DRAPE_FUNCTION Lanes lanesSqrt(Lanes a)
{
    return drapeSqrt(a);
}

// Stores one byte per lane of the mask.
DRAPE_FUNCTION void laneBytes(LaneMask mask, DRAPE_ULONG* bytes)
{
    typedef signed char Bytes __attribute__((vector_size(DRAPE_LANES)));
    const Bytes all = __builtin_convertvector(mask, Bytes);
    __builtin_memcpy(bytes, &all, sizeof all);
}

#endif
