#include "triangles.h"

#include <algorithm>

namespace drape
{
namespace
{
// Returns an axis along which points of one plane stay distinct: three of them span an area in that view or, if all are
// in line, two of them differ.
int viewOf(const ExactPoint* points, int count)
{
    for (int along = 0; along < 3; ++along)
    {
        for (int i = 2; i < count; ++i)
            for (int j = 1; j < i; ++j)
                for (int k = 0; k < j; ++k)
                    if (orientation2(points[i], points[j], points[k], along) != 0) return along;
    }
    for (int along = 0; along < 3; ++along)
    {
        for (int i = 1; i < count; ++i)
            for (int axis : {(along + 1) % 3, (along + 2) % 3})
                if (points[i][axis] != points[0][axis]) return along;
    }
    return 0;
}

bool between(const ExactPoint& p, const ExactPoint& q, const ExactPoint& point, int along)
{
    for (int axis : {(along + 1) % 3, (along + 2) % 3})
    {
        if (point[axis] < std::min(p[axis], q[axis]) || point[axis] > std::max(p[axis], q[axis])) return false;
    }
    return true;
}

// Tests the closed segments p q and r s in the view along an axis.
bool segmentsCross(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r, const ExactPoint& s, int along)
{
    const int a = orientation2(p, q, r, along), b = orientation2(p, q, s, along);
    const int c = orientation2(r, s, p, along), d = orientation2(r, s, q, along);
    if (a * b < 0 && c * d < 0) return true;
    return (a == 0 && between(p, q, r, along)) || (b == 0 && between(p, q, s, along)) ||
           (c == 0 && between(r, s, p, along)) || (d == 0 && between(r, s, q, along));
}

bool segmentsMeet(const ExactPoint& p, const ExactPoint& q, const ExactPoint& r, const ExactPoint& s)
{
    if (orientation3(p, q, r, s) != 0) return false;
    const ExactPoint points[4] = {p, q, r, s};
    return segmentsCross(p, q, r, s, viewOf(points, 4));
}

bool sameSide(int a, int b, int c)
{
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

// A segment in the triangle's plane; a triangle without area is its three edges.
bool meetsInPlane(const ExactPoint& p, const ExactPoint& q, const ExactTriangle& t)
{
    const ExactPoint* c = t.m_p;
    const int along = viewOf(c, 3);
    if (orientation2(c[0], c[1], c[2], along) == 0)
        return segmentsMeet(p, q, c[0], c[1]) || segmentsMeet(p, q, c[1], c[2]) || segmentsMeet(p, q, c[2], c[0]);
    if (sameSide(orientation2(c[0], c[1], p, along), orientation2(c[1], c[2], p, along),
                 orientation2(c[2], c[0], p, along)))
        return true;
    return segmentsCross(p, q, c[0], c[1], along) || segmentsCross(p, q, c[1], c[2], along) ||
           segmentsCross(p, q, c[2], c[0], along);
}

// sideP, sideQ: of the triangle's plane.
bool segmentMeets(const ExactPoint& p, const ExactPoint& q, const ExactTriangle& t, int sideP, int sideQ)
{
    if (sideP * sideQ > 0) return false;
    if (sideP == 0 && sideQ == 0) return meetsInPlane(p, q, t);
    return sameSide(orientation3(p, q, t.m_p[0], t.m_p[1]), orientation3(p, q, t.m_p[1], t.m_p[2]),
                    orientation3(p, q, t.m_p[2], t.m_p[0]));
}

// Sides of the corners of `of` to the plane of t. Returns whether all are strictly on one.
bool sides(const ExactTriangle& t, const ExactTriangle& of, int side[3])
{
    for (int i = 0; i < 3; ++i)
        side[i] = orientation3(t.m_p[0], t.m_p[1], t.m_p[2], of.m_p[i]);
    return side[0] != 0 && side[0] == side[1] && side[0] == side[2];
}

ExactPoint minus(const ExactPoint& a, const ExactPoint& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
ExactPoint plus(const ExactPoint& a, double s, const ExactPoint& b)
{
    return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
double dot(const ExactPoint& a, const ExactPoint& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
ExactPoint cross(const ExactPoint& a, const ExactPoint& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Returns the squared distance from the origin of the points w + s u - t v, s and t in [0, 1].
double segmentsSquared(const ExactPoint& w, const ExactPoint& u, const ExactPoint& v)
{
    const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    const auto at = [&](double s, double t)
    {
        const ExactPoint offset = plus(plus(w, s, u), -t, v);
        return dot(offset, offset);
    };
    const auto clamp = [](double numerator, double denominator)
    { return denominator > 0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0; };
    // Takes the least over the square's sides, and over its inside if the distance has its minimum there.
    double least = std::min(std::min(at(0, clamp(vw, vv)), at(1, clamp(uv + vw, vv))),
                            std::min(at(clamp(-uw, uu), 0), at(clamp(uv - uw, uu), 1)));
    const double determinant = uu * vv - uv * uv;
    const double s = uv * vw - uw * vv, t = uu * vw - uv * uw;
    if (s > 0 && s < determinant && t > 0 && t < determinant)
        least = std::min(least, at(s / determinant, t / determinant));
    return least;
}

// Returns the point's squared distance from the triangle's plane if it is above or below the triangle's inside;
// otherwise a value beyond any distance.
double faceSquared(const ExactPoint& p, const ExactTriangle& t)
{
    const ExactPoint normal = cross(minus(t.m_p[1], t.m_p[0]), minus(t.m_p[2], t.m_p[0]));
    for (int i = 0; i < 3; ++i)
    {
        const ExactPoint inward = cross(normal, minus(t.m_p[(i + 1) % 3], t.m_p[i]));
        if (dot(inward, minus(p, t.m_p[i])) <= 0) return 1e300;
    }
    const double height = dot(normal, minus(p, t.m_p[0]));
    return height * height / dot(normal, normal);
}
}  // namespace

ExactTriangle exactTriangle(const float* corners)
{
    ExactTriangle t;
    for (int i = 0; i < 9; ++i)
        t.m_p[i / 3][i % 3] = corners[i];
    return t;
}

bool trianglesMeet(const ExactTriangle& a, const ExactTriangle& b)
{
    int sidesA[3], sidesB[3];
    if (sides(a, b, sidesB) || sides(b, a, sidesA)) return false;
    for (int i = 0; i < 3; ++i)
    {
        const int j = (i + 1) % 3;
        if (segmentMeets(a.m_p[i], a.m_p[j], b, sidesA[i], sidesA[j])) return true;
        if (segmentMeets(b.m_p[i], b.m_p[j], a, sidesB[i], sidesB[j])) return true;
    }
    return false;
}

double squaredDistance(const ExactTriangle& a, const ExactTriangle& b)
{
    double least = 1e300;
    for (int i = 0; i < 3; ++i)
    {
        least = std::min(least, std::min(faceSquared(a.m_p[i], b), faceSquared(b.m_p[i], a)));
        const ExactPoint u = minus(a.m_p[(i + 1) % 3], a.m_p[i]);
        for (int j = 0; j < 3; ++j)
        {
            const ExactPoint v = minus(b.m_p[(j + 1) % 3], b.m_p[j]);
            least = std::min(least, segmentsSquared(minus(a.m_p[i], b.m_p[j]), u, v));
        }
    }
    return least;
}
}  // namespace drape
