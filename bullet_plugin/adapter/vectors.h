// Machine vectors for work on many contacts: whole vectors of Bullet's, and numbers of adjacent contacts.
#pragma once

#include <LinearMath/btVector3.h>

#include <cstdint>
#include <cstring>

namespace drape
{
constexpr int kLanes = 4;  // contacts side by side
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

// A whole vector of Bullet's, whose fourth number is unused. It is loaded and stored in one piece: a contact reads
// what the one before has just written, and a load waits for narrower stores to reach the cache.
using Quad = btScalar __attribute__((vector_size(4 * sizeof(btScalar))));

inline void load(const btVector3& vector, Quad& quad)
{
    std::memcpy(&quad, vector.m_floats, sizeof(quad));
}

inline void store(const Quad& quad, btVector3& vector)
{
    std::memcpy(vector.m_floats, &quad, sizeof(quad));
}

// Writes the position in the core's float32, and moves `out` behind it.
inline void writePosition(const btVector3& position, float*& out)
{
    for (int axis = 0; axis < 3; ++axis)
        *out++ = static_cast<float>(position[axis]);
}

// Converts to float32, as blocks use it.
inline Lanes lanesOf(const btVector3& vector)
{
    Quad quad;
    load(vector, quad);
    return __builtin_convertvector(quad, Lanes);
}

inline btScalar dot(const Quad& a, const Quad& b)
{
    const Quad products = a * b;
    return products[0] + products[1] + products[2];
}

inline bool anyAbove0(const Lanes& values)
{
    const auto above = values > 0;
    std::uint64_t halves[2];
    std::memcpy(halves, &above, sizeof(above));
    return (halves[0] | halves[1]) != 0;
}

// A bit for each lane that is above 0.
inline unsigned bitsAbove0(const Lanes& values)
{
    static_assert(kLanes == 4 && sizeof(int) == sizeof(float));
    using Bits = int __attribute__((vector_size(sizeof(values))));
    const Bits bits = (values > 0) & Bits{1, 2, 4, 8};
    std::uint64_t halves[2];
    std::memcpy(halves, &bits, sizeof(bits));
    const std::uint64_t both = halves[0] | halves[1];
    return static_cast<unsigned>(both | both >> 32);
}
}  // namespace drape
