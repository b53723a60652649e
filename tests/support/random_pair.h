// Random pairs of triangles, and how far apart they are.
#pragma once

#include "kernels/lib/queries/triangle_pair.h"
#include "tests/support/cases.h"
#include "tests/support/oracle.h"

namespace drape::test
{
struct Pair
{
    Vec3 m_a[3], m_b[3];

    double distance() const
    {
        Vector3 p[3], q[3];
        for (int i = 0; i < 3; ++i)
        {
            p[i] = {m_a[i].x, m_a[i].y, m_a[i].z};
            q[i] = {m_b[i].x, m_b[i].y, m_b[i].z};
        }
        return triangleDistance(p, q);
    }
};

// Two triangles of a size around an offset, the second shifted.
inline Pair randomPair(Random& random, float size, float offset, float shift)
{
    Pair pair;
    for (int i = 0; i < 3; ++i)
    {
        pair.m_a[i] = vec3(offset + size * random.uniform(-1, 1), offset + size * random.uniform(-1, 1),
                           size * random.uniform(-1, 1));
        pair.m_b[i] = vec3(offset + size * random.uniform(-1, 1), offset + size * random.uniform(-1, 1),
                           shift + size * random.uniform(-1, 1));
    }
    return pair;
}
}  // namespace drape::test
