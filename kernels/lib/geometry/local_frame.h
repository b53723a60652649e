// Scales a pair of features to size one, so that products neither overflow nor vanish.
#ifndef DRAPE_LIB_LOCAL_FRAME_H
#define DRAPE_LIB_LOCAL_FRAME_H

#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// Differences of any two finite floats, taken after this power of two, stay finite.
#define DRAPE_PRESCALE 0.0625f
// Largest error of a denormal that the device flushes to zero: the smallest normal float, 2^-126.
#define DRAPE_FLUSH 1.17549435e-38f
// Exponent field of the largest scale, 2^100: flushed denormals are still small (2^-26) after scaling.
#define DRAPE_LARGEST_SCALE_FIELD 227u

// Returns the power of two that scales a prescaled extent into [1/2, 1), at most 2^100. Scaling by it is exact, so
// results do not depend on the unit of length as long as units differ by powers of two. The extent is finite and not
// negative.
DRAPE_FUNCTION float localScale(float extent)
{
    const DRAPE_UINT exponent = (drapeBits(extent) >> 23) & 0xffu;
    const DRAPE_UINT field = 253u - (exponent > 252u ? 252u : exponent);
    return drapeFromBits((field > DRAPE_LARGEST_SCALE_FIELD ? DRAPE_LARGEST_SCALE_FIELD : field) << 23);
}

DRAPE_FUNCTION Vec3 vec3Prescaled(Vec3 a)
{
    return vec3Scale(a, DRAPE_PRESCALE);
}

DRAPE_NAMESPACE_END

#endif
