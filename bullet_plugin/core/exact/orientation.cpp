#include "orientation.h"

#include <cmath>

#include "expansion.h"

namespace drape
{
namespace
{
constexpr double kUnit = 1.1102230246251565e-16;      // 2^-53
constexpr double kBound3 = (7 + 56 * kUnit) * kUnit;  // Shewchuk 1997, orient3d, stage A
constexpr double kBound2 = (3 + 16 * kUnit) * kUnit;  // for orient2d

int signOf(double value)
{
    return (value > 0) - (value < 0);
}

// Rows of the differences to the last point.
using Row = std::array<Expansion, 3>;

Row exactRow(const ExactPoint& p, const ExactPoint& base)
{
    return {Expansion::difference(p[0], base[0]), Expansion::difference(p[1], base[1]),
            Expansion::difference(p[2], base[2])};
}

int exactOrientation3(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d)
{
    const Row p = exactRow(a, d), q = exactRow(b, d), r = exactRow(c, d);
    const Expansion volume =
        p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
    return volume.sign();
}
}  // namespace

int orientation3(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d)
{
    double volume = 0, permanent = 0;
    for (int x = 0; x < 3; ++x)
    {
        const int y = (x + 1) % 3, z = (x + 2) % 3;
        const double left = (b[y] - d[y]) * (c[z] - d[z]), right = (b[z] - d[z]) * (c[y] - d[y]);
        volume += (a[x] - d[x]) * (left - right);
        permanent += std::fabs(a[x] - d[x]) * (std::fabs(left) + std::fabs(right));
    }
    if (std::fabs(volume) > kBound3 * permanent) return signOf(volume);
    return permanent == 0 ? 0 : exactOrientation3(a, b, c, d);
}

int orientation2(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, int along)
{
    const int u = (along + 1) % 3, v = (along + 2) % 3;
    const double left = (a[u] - c[u]) * (b[v] - c[v]), right = (a[v] - c[v]) * (b[u] - c[u]);
    const double area = left - right;
    if (std::fabs(area) > kBound2 * (std::fabs(left) + std::fabs(right))) return signOf(area);
    const Expansion exact = Expansion::difference(a[u], c[u]) * Expansion::difference(b[v], c[v]) -
                            Expansion::difference(a[v], c[v]) * Expansion::difference(b[u], c[u]);
    return exact.sign();
}
}  // namespace drape
