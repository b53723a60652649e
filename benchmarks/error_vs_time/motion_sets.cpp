#include "benchmarks/error_vs_time/motion_sets.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/error_vs_time/round_to_float.h"
#include "scenes/random.h"
#include "scenes/vector3.h"

namespace drape::bench
{
namespace
{
constexpr double kSize = 0.05;  // m, of features and motions
// Pairs nearer than this relative distance to a change of the truth are left out. Double errs by less than 1e-11, for
// positions of up to 100 m and sizes of centimetres.
constexpr double kSure = 1e-8;

struct Moving
{
    Vector3 m_start[4], m_end[4];

    Vector3 at(int point, double time) const { return m_start[point] + time * (m_end[point] - m_start[point]); }
};

Vector3 randomPoint(Random& random, double size)
{
    const double x = random.within(-size, size), y = random.within(-size, size), z = random.within(-size, size);
    return {x, y, z};
}

// Computes three vectors that lie in one plane if the four points do: the offset, and two along the features.
void vectorsAt(const Moving& moving, std::uint32_t kind, double time, Vector3& d, Vector3& e, Vector3& g)
{
    const Vector3 p[4] = {moving.at(0, time), moving.at(1, time), moving.at(2, time), moving.at(3, time)};
    const bool face = kind == DRAPE_VERTEX_FACE;
    d = p[face ? 0 : 2] - p[face ? 1 : 0];
    e = p[face ? 2 : 1] - p[face ? 1 : 0];
    g = p[3] - p[face ? 1 : 2];
}

double volumeAt(const Moving& moving, std::uint32_t kind, double time)
{
    Vector3 d, e, g;
    vectorsAt(moving, kind, time, d, e, g);
    return dot(d, cross(e, g));
}

// Returns how far inside both features the meeting point of the coplanar four is, relative to the features' size.
// Negative values are outside.
double insideAt(const Moving& moving, std::uint32_t kind, double time)
{
    Vector3 d, e, g;
    vectorsAt(moving, kind, time, d, e, g);
    const Vector3 normal = cross(e, g);
    const double area = dot(normal, normal);
    const double u = dot(cross(d, g), normal) / area;
    if (kind == DRAPE_VERTEX_FACE)
    {
        const double v = dot(cross(e, d), normal) / area;
        return std::min({u, v, 1 - u - v});
    }
    const double v = dot(cross(d, e), normal) / area;
    return std::min({u, 1 - u, v, 1 - v});
}

// A cubic, given by its values at four positions.
struct Cubic
{
    double m_c[4];

    double at(double t) const { return ((m_c[3] * t + m_c[2]) * t + m_c[1]) * t + m_c[0]; }
};

Cubic volumeCubic(const Moving& moving, std::uint32_t kind)
{
    const double f0 = volumeAt(moving, kind, 0), f1 = volumeAt(moving, kind, 1), fm = volumeAt(moving, kind, -1),
                 f2 = volumeAt(moving, kind, 2);
    const double square = (f1 + fm) / 2 - f0;
    const double cube = (f2 - 4 * square - f0 - (f1 - fm)) / 6;
    return {{f0, (f1 - fm) / 2 - cube, square, cube}};
}

// Ends of the stretches of [0, 1] in which the cubic rises or falls.
std::vector<double> turns(const Cubic& f)
{
    std::vector<double> ends = {0};
    const double a = 3 * f.m_c[3], b = 2 * f.m_c[2], c = f.m_c[1];
    const double root = std::sqrt(std::max(b * b - 4 * a * c, 0.0));
    const double q = -(b + std::copysign(root, b)) / 2;
    for (const double t : {a != 0 ? q / a : -1, q != 0 ? c / q : -1})
    {
        if (b * b - 4 * a * c > 0 && t > 0 && t < 1) ends.push_back(t);
    }
    ends.push_back(1);
    std::sort(ends.begin(), ends.end());
    return ends;
}

// Returns the root between two positions of different sign.
double rootBetween(const Cubic& f, double low, double high)
{
    for (int i = 0; i < 100; ++i)
    {
        const double middle = (low + high) / 2;
        ((f.at(middle) < 0) == (f.at(low) < 0) ? low : high) = middle;
    }
    return (low + high) / 2;
}

// Returns whether double precision can decide. If so, sets whether the features touch and the first time.
bool truthOf(const Moving& moving, std::uint32_t kind, bool& touch, double& time)
{
    touch = false;
    time = 1;
    const Cubic f = volumeCubic(moving, kind);
    const double scale = std::max({std::abs(f.m_c[0]), std::abs(f.m_c[1]), std::abs(f.m_c[2]), std::abs(f.m_c[3])});
    const std::vector<double> ends = turns(f);
    for (const double end : ends)
    {
        if (!(std::abs(f.at(end)) > kSure * scale)) return false;
    }
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    {
        if ((f.at(ends[i]) < 0) == (f.at(ends[i + 1]) < 0)) continue;
        const double root = rootBetween(f, ends[i], ends[i + 1]), inside = insideAt(moving, kind, root);
        if (!(std::abs(inside) > kSure)) return false;
        if (inside < 0 || touch) continue;
        touch = true;
        time = root;
    }
    return true;
}

// Places a vertex, or the middle of an edge, on the other feature at some time: `past` inside its border (outside, if
// negative), in parts of its size, or anywhere inside where that is 0.
void aim(Moving& moving, std::uint32_t kind, double past, Random& random)
{
    const double time = random.within(0.05, 0.95);
    const Vector3 p[4] = {moving.at(0, time), moving.at(1, time), moving.at(2, time), moving.at(3, time)};
    const double u = past != 0 ? past : random.within(0.05, 0.45), v = random.within(0.05, 0.45);
    const bool face = kind == DRAPE_VERTEX_FACE;
    const Vector3 other = face ? p[1] + u * (p[2] - p[1]) + v * (p[3] - p[1]) : p[2] + u * (p[3] - p[2]);
    const Vector3 own = face ? p[0] : p[0] + v * (p[1] - p[0]);
    for (int i = 0; i < (face ? 1 : 2); ++i)
    {
        moving.m_start[i] += other - own;
        moving.m_end[i] += other - own;
    }
}

Vector3 roundPoint(const Vector3& p)
{
    return {roundToFloat(p.x), roundToFloat(p.y), roundToFloat(p.z)};
}

// Rounds to float, as everyone will read it.
void store(CcdQuery& query, Moving& moving)
{
    for (int point = 0; point < 4; ++point)
    {
        moving.m_start[point] = roundPoint(moving.m_start[point]);
        moving.m_end[point] = roundPoint(moving.m_end[point]);
        for (int axis = 0; axis < 3; ++axis)
        {
            query.m_start[3 * point + axis] = float(moving.m_start[point][axis]);
            query.m_end[3 * point + axis] = float(moving.m_end[point][axis]);
        }
    }
}

MotionSet makeSet(const std::string& name, std::size_t count, double distance, bool grazing, std::uint32_t seed)
{
    Random random(seed);
    MotionSet set;
    set.m_name = name;
    while (set.m_queries.size() < count)
    {
        CcdQuery query;
        query.m_kind = set.m_queries.size() % 2 ? DRAPE_EDGES : DRAPE_VERTEX_FACE;
        Moving moving;
        const Vector3 place = {distance, distance, distance};
        for (int point = 0; point < 4; ++point)
        {
            moving.m_start[point] = place + randomPoint(random, kSize);
            moving.m_end[point] = moving.m_start[point] + randomPoint(random, kSize);
        }
        const double past = std::pow(10.0, random.within(-6, -3)) * (random.unit() < 0.5 ? -1 : 1);
        if (grazing || random.unit() < 0.5) aim(moving, query.m_kind, grazing ? past : 0, random);
        store(query, moving);
        bool touch;
        double time;
        if (!truthOf(moving, query.m_kind, touch, time)) continue;
        set.m_queries.push_back(query);
        set.m_truth.push_back(touch);
        set.m_times.push_back(time);
    }
    return set;
}
}  // namespace

std::vector<MotionSet> makeMotionSets(std::size_t queries)
{
    return {makeSet("motions at 1 m", queries, 1, false, 71), makeSet("motions at 100 m", queries, 100, false, 72),
            makeSet("grazing motions", queries, 1, true, 73)};
}
}  // namespace drape::bench
