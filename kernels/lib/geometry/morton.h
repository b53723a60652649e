// Morton codes: the order in which primitives become leaves. Neighbours in the order are near in space.
#ifndef DRAPE_LIB_MORTON_H
#define DRAPE_LIB_MORTON_H

#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// Spreads ten bits to every third bit position.
DRAPE_FUNCTION DRAPE_UINT mortonSpread(DRAPE_UINT v)
{
    v = (v | (v << 16)) & 0x030000ffu;
    v = (v | (v << 8)) & 0x0300f00fu;
    v = (v | (v << 4)) & 0x030c30c3u;
    return (v | (v << 2)) & 0x09249249u;
}

// Returns the cell of a value among `cells` in [low, high].
DRAPE_FUNCTION DRAPE_UINT mortonCell(float value, float low, float high, DRAPE_UINT cells)
{
    const float extent = high - low;
    if (!(extent > 0.0f)) return 0u;  // flat in this axis
    const float cell = (value - low) / extent * (float)cells;
    const float last = (float)(cells - 1u);
    return cell >= last ? cells - 1u : cell > 0.0f ? (DRAPE_UINT)cell : 0u;  // NaN lands in the first cell
}

DRAPE_FUNCTION DRAPE_UINT mortonInterleave(DRAPE_UINT x, DRAPE_UINT y, DRAPE_UINT z)
{
    return mortonSpread(x) | (mortonSpread(y) << 1) | (mortonSpread(z) << 2);
}

// Returns the 30-bit code of a point in the box [low, high].
DRAPE_FUNCTION DRAPE_UINT mortonCode(Vec3 p, Vec3 low, Vec3 high)
{
    return mortonInterleave(mortonCell(p.x, low.x, high.x, 1024u), mortonCell(p.y, low.y, high.y, 1024u),
                            mortonCell(p.z, low.z, high.z, 1024u));
}

DRAPE_NAMESPACE_END

#endif
