// Morton codes of 63 bits.
#ifndef DRAPE_STUDY_MORTON_WIDE_H
#define DRAPE_STUDY_MORTON_WIDE_H

#include "../../../kernels/lib/geometry/morton.h"

DRAPE_NAMESPACE_BEGIN

// 63-bit code: the upper 31 bits and the lower 32. 21 bits an axis are fewer than a float's 24.
DRAPE_FUNCTION void mortonCodeWide(Vec3 p, Vec3 low, Vec3 high, DRAPE_GLOBAL DRAPE_UINT* upper,
                                   DRAPE_GLOBAL DRAPE_UINT* lower)
{
    const DRAPE_UINT cells = 1u << 21;
    const DRAPE_UINT x = mortonCell(p.x, low.x, high.x, cells);
    const DRAPE_UINT y = mortonCell(p.y, low.y, high.y, cells);
    const DRAPE_UINT z = mortonCell(p.z, low.z, high.z, cells);
    // Bits 0 … 29 from the lowest ten of each axis, 30 … 59 from the next ten, 60 … 62 from the last.
    const DRAPE_UINT middle = mortonInterleave((x >> 10) & 1023u, (y >> 10) & 1023u, (z >> 10) & 1023u);
    const DRAPE_UINT top = (x >> 20) | ((y >> 20) << 1) | ((z >> 20) << 2);
    *lower = mortonInterleave(x & 1023u, y & 1023u, z & 1023u) | (middle << 30);
    *upper = (middle >> 2) | (top << 28);
}

DRAPE_NAMESPACE_END

#endif
