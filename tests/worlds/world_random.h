// Random numbers for the worlds: a seed gives the same numbers on every machine, and so the same world.
#pragma once

#include <cmath>
#include <cstdint>

#include <LinearMath/btVector3.h>

namespace drape::test
{
// An interval to draw from. An interval without extent is a constant, for which nothing is drawn.
struct Range
{
    double m_low, m_high;

    Range(double constant) : m_low(constant), m_high(constant) {}
    Range(double low, double high) : m_low(low), m_high(high) {}
};

// SplitMix64 (Steele, Lea, Flood 2014). Eight numbers are skipped, so that the first ones of small seeds differ.
class WorldRandom
{
public:
    explicit WorldRandom(std::uint64_t number) : m_state(number * kStep + 0x1234567)
    {
        for (int i = 0; i < 8; ++i)
            next();
    }

    std::uint64_t next()
    {
        std::uint64_t z = (m_state += kStep);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return z ^ (z >> 31);
    }
    double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }  // in [0, 1)
    double within(double low, double high) { return low + (high - low) * unit(); }
    double within(const Range& range)
    {
        return range.m_low == range.m_high ? range.m_low : within(range.m_low, range.m_high);
    }
    // The logarithm is uniform; both bounds are positive.
    double logWithin(double low, double high) { return std::exp(within(std::log(low), std::log(high))); }
    int below(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }
    bool chance(double probability) { return unit() < probability; }

    // Returns a unit vector. It is drawn from a cube, so that diagonals are more likely.
    btVector3 direction()
    {
        btVector3 v;
        do
        {
            const btScalar z = btScalar(within(-1, 1)), y = btScalar(within(-1, 1)), x = btScalar(within(-1, 1));
            v = btVector3(x, y, z);
        } while (v.length2() < .01);
        return v.normalized();
    }

private:
    static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15ull;

    std::uint64_t m_state;
};
}  // namespace drape::test
