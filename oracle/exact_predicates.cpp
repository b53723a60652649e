#include "oracle/exact_predicates.h"

#include <gmpxx.h>

namespace drape
{
namespace
{
constexpr double kUnit = 1.1102230246251565e-16;      // 2⁻⁵³
constexpr double kBound3 = (7 + 56 * kUnit) * kUnit;  // Shewchuk 1997, orient3d, stage A
constexpr double kBound2 = (3 + 16 * kUnit) * kUnit;  // error bound of orient2d
constexpr int kNext[3] = {1, 2, 0};

int signOf(double value)
{
    return (value > 0) - (value < 0);
}

bool areSame(const Vector3& a, const Vector3& b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

// Returns true if two of the points are equal, so that a segment stands for a triangle.
bool anySame(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d)
{
    return areSame(a, b) || areSame(a, c) || areSame(a, d) || areSame(b, c) || areSame(b, d) || areSame(c, d);
}

int exactOrientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d)
{
    mpq_class m[3][3];
    const Vector3* rows[3] = {&a, &b, &c};
    for (int row = 0; row < 3; ++row)
        for (int axis = 0; axis < 3; ++axis)
            m[row][axis] = mpq_class((*rows[row])[axis]) - mpq_class(d[axis]);
    const mpq_class volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
                             m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return sgn(volume);
}

// Computes a difference; returns whether it is exact.
bool subtractExactly(double a, double b, double& difference)
{
    difference = a - b;
    const double back = a - difference;
    return (a - (difference + back)) + (back - b) == 0;
}

// Computes the sign of the area of a, b, c in a view; returns whether no step is rounded, as with most floats.
bool unroundedOrientation2(const Vector3& a, const Vector3& b, const Vector3& c, int u, int v, int& sign)
{
    double p, q, r, s;
    if (!subtractExactly(a[u], c[u], p) || !subtractExactly(b[v], c[v], q)) return false;
    if (!subtractExactly(a[v], c[v], r) || !subtractExactly(b[u], c[u], s)) return false;
    const double left = p * q, right = r * s;
    sign = (left > right) - (left < right);
    return std::fma(p, q, -left) == 0 && std::fma(r, s, -right) == 0;
}

// Returns the sign of the area of a, b, c seen along an axis.
int orientation2(const Vector3& a, const Vector3& b, const Vector3& c, int along)
{
    const int u = kNext[along], v = kNext[u];
    const double left = (a[u] - c[u]) * (b[v] - c[v]);
    const double right = (a[v] - c[v]) * (b[u] - c[u]);
    const double area = left - right;
    if (std::fabs(area) > kBound2 * (std::fabs(left) + std::fabs(right))) return signOf(area);
    if (areSame(a, b) || areSame(b, c) || areSame(c, a)) return 0;
    if (int sign = 0; unroundedOrientation2(a, b, c, u, v, sign)) return sign;
    const mpq_class exact = (mpq_class(a[u]) - mpq_class(c[u])) * (mpq_class(b[v]) - mpq_class(c[v])) -
                            (mpq_class(a[v]) - mpq_class(c[v])) * (mpq_class(b[u]) - mpq_class(c[u]));
    return sgn(exact);
}

bool within(double value, double p, double q)
{
    return (p <= value && value <= q) || (q <= value && value <= p);
}

bool onSegment2(const Vector3& p, const Vector3& q, const Vector3& point, int along)
{
    const int u = kNext[along], v = kNext[u];
    return within(point[u], p[u], q[u]) && within(point[v], p[v], q[v]);
}

bool segmentsMeet2(const Vector3& p, const Vector3& q, const Vector3& r, const Vector3& s, int along)
{
    const int pqr = orientation2(p, q, r, along), pqs = orientation2(p, q, s, along);
    const int rsp = orientation2(r, s, p, along), rsq = orientation2(r, s, q, along);
    if (pqr * pqs < 0 && rsp * rsq < 0) return true;
    return (pqr == 0 && onSegment2(p, q, r, along)) || (pqs == 0 && onSegment2(p, q, s, along)) ||
           (rsp == 0 && onSegment2(r, s, p, along)) || (rsq == 0 && onSegment2(r, s, q, along));
}

// Segments meet if and only if they lie in one plane and meet in all three axis views. At least one view is one-to-one
// on the plane (or line) that contains them, and a common point shows in every view.
bool segmentsMeet(const Vector3& p, const Vector3& q, const Vector3& r, const Vector3& s)
{
    return segmentsMeet2(p, q, r, s, 0) && segmentsMeet2(p, q, r, s, 1) && segmentsMeet2(p, q, r, s, 2) &&
           orientation(p, q, r, s) == 0;
}

bool meetsBoundary(const Vector3& p, const Vector3& q, const Vector3 t[3])
{
    return segmentsMeet(p, q, t[0], t[1]) || segmentsMeet(p, q, t[1], t[2]) || segmentsMeet(p, q, t[2], t[0]);
}

// Tests a point in the plane of a triangle that has area, in all views for the reason above.
bool coplanarPointInside(const Vector3& point, const Vector3 t[3])
{
    for (int along = 0; along < 3; ++along)
    {
        const int s0 = orientation2(t[0], t[1], point, along);
        const int s1 = orientation2(t[1], t[2], point, along);
        const int s2 = orientation2(t[2], t[0], point, along);
        if ((s0 > 0 || s1 > 0 || s2 > 0) && (s0 < 0 || s1 < 0 || s2 < 0)) return false;
    }
    return true;
}

bool hasArea(const Vector3 t[3])
{
    return orientation2(t[0], t[1], t[2], 0) != 0 || orientation2(t[0], t[1], t[2], 1) != 0 ||
           orientation2(t[0], t[1], t[2], 2) != 0;
}
}  // namespace

int orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d)
{
    const Vector3 ad = a - d, bd = b - d, cd = c - d;
    const double bc1 = bd.y * cd.z, bc2 = bd.z * cd.y;
    const double ca1 = bd.z * cd.x, ca2 = bd.x * cd.z;
    const double ab1 = bd.x * cd.y, ab2 = bd.y * cd.x;
    const double volume = ad.x * (bc1 - bc2) + ad.y * (ca1 - ca2) + ad.z * (ab1 - ab2);
    const double permanent = (std::fabs(bc1) + std::fabs(bc2)) * std::fabs(ad.x) +
                             (std::fabs(ca1) + std::fabs(ca2)) * std::fabs(ad.y) +
                             (std::fabs(ab1) + std::fabs(ab2)) * std::fabs(ad.z);
    if (std::fabs(volume) > kBound3 * permanent) return signOf(volume);
    return permanent == 0 || anySame(a, b, c, d) ? 0 : exactOrientation(a, b, c, d);
}

bool segmentMeetsTriangle(const Vector3& p, const Vector3& q, const Vector3 t[3])
{
    const int sideP = orientation(t[0], t[1], t[2], p);
    const int sideQ = orientation(t[0], t[1], t[2], q);
    if (sideP * sideQ > 0) return false;
    if (sideP == 0 && sideQ == 0)  // in its plane, or no area
        return meetsBoundary(p, q, t) || (hasArea(t) && coplanarPointInside(p, t));
    const int s0 = orientation(p, q, t[0], t[1]);
    const int s1 = orientation(p, q, t[1], t[2]);
    const int s2 = orientation(p, q, t[2], t[0]);
    return !((s0 > 0 || s1 > 0 || s2 > 0) && (s0 < 0 || s1 < 0 || s2 < 0));
}

bool foldedFlat(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d)
{
    if (orientation(a, b, c, d) != 0) return false;
    // Views along the axes keep the sides of a plane; one in which c and d have a side decides.
    for (int along = 0; along < 3; ++along)
        if (orientation2(a, b, c, along) * orientation2(a, b, d, along) != 0)
            return orientation2(a, b, c, along) == orientation2(a, b, d, along);
    return false;
}

bool trianglesIntersect(const Vector3 a[3], const Vector3 b[3])
{
    // All of one triangle is strictly on one side of the other's plane: they do not meet.
    const int b0 = orientation(a[0], a[1], a[2], b[0]);
    if (b0 != 0 && b0 == orientation(a[0], a[1], a[2], b[1]) && b0 == orientation(a[0], a[1], a[2], b[2])) return false;
    const int a0 = orientation(b[0], b[1], b[2], a[0]);
    if (a0 != 0 && a0 == orientation(b[0], b[1], b[2], a[1]) && a0 == orientation(b[0], b[1], b[2], a[2])) return false;
    for (int i = 0; i < 3; ++i)
        if (segmentMeetsTriangle(a[i], a[kNext[i]], b) || segmentMeetsTriangle(b[i], b[kNext[i]], a)) return true;
    return false;
}
}  // namespace drape
