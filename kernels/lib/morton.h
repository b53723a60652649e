// Morton codes: the order in which primitives become leaves. Neighbours in the order are near in space.
#ifndef DRAPE_LIB_MORTON_H
#define DRAPE_LIB_MORTON_H

#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// Spreads ten bits to every third place.
DRAPE_FUNCTION DRAPE_UINT mortonSpread(DRAPE_UINT v)
{
    v = (v | (v << 16)) & 0x030000ffu;
    v = (v | (v << 8)) & 0x0300f00fu;
    v = (v | (v << 4)) & 0x030c30c3u;
    return (v | (v << 2)) & 0x09249249u;
}

DRAPE_FUNCTION DRAPE_UINT mortonCell(float value, float low, float high)
{
    const float extent = high - low;
    if (!(extent > 0.0f)) return 0u;  // flat in this axis
    const float cell = (value - low) / extent * 1024.0f;
    return cell >= 1023.0f ? 1023u : cell > 0.0f ? (DRAPE_UINT)cell : 0u;  // NaN lands in the first cell
}

// 30-bit code of a point in the box [low, high].
DRAPE_FUNCTION DRAPE_UINT mortonCode(Vec3 p, Vec3 low, Vec3 high)
{
    return mortonSpread(mortonCell(p.x, low.x, high.x)) | (mortonSpread(mortonCell(p.y, low.y, high.y)) << 1) |
           (mortonSpread(mortonCell(p.z, low.z, high.z)) << 2);
}

DRAPE_NAMESPACE_END

#endif
