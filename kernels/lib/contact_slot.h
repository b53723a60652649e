// Where a contact goes in the reduction: one place per cloth feature and direction, and the order that decides who keeps it.
#ifndef DRAPE_LIB_CONTACT_SLOT_H
#define DRAPE_LIB_CONTACT_SLOT_H

#include "../shared/contact.h"
#include "vec3.h"

DRAPE_NAMESPACE_BEGIN

// Normals are sorted by their largest component and its sign: a node in a corner keeps one contact per wall, and normals
// of one wall compete.
#define DRAPE_CONTACT_DIRECTIONS 6u
#define DRAPE_NO_CONTACT 0xffffffffu

DRAPE_FUNCTION DRAPE_UINT contactDirection(Vec3 normal)
{
    const float x = drapeAbs(normal.x), y = drapeAbs(normal.y), z = drapeAbs(normal.z);
    if (x >= y && x >= z) return normal.x < 0.0f ? 1u : 0u;
    if (y >= z) return normal.y < 0.0f ? 3u : 2u;
    return normal.z < 0.0f ? 5u : 4u;
}

// Maps floats to unsigned integers in the same order (-0 before +0), for atomic minima. Never DRAPE_NO_CONTACT for a finite
// gap.
DRAPE_FUNCTION DRAPE_UINT contactRank(float gap)
{
    const DRAPE_UINT bits = drapeBits(gap);
    return (bits & 0x80000000u) ? ~bits : bits | 0x80000000u;
}

DRAPE_NAMESPACE_END

#endif
