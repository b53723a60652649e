#include "benchmarks/error_vs_time/triangle_sets.h"

#include "benchmarks/error_vs_time/round_to_float.h"
#include "oracle/exact_predicates.h"
#include "scenes/random.h"

namespace drape::bench
{
namespace
{
constexpr double kSize = 0.01;    // m
constexpr double kLayer = 0.001;  // m

// Places three corners at heights around `height` above `at`; `rough` is the range of their heights.
void place(Vector3 corners[3], double at, double height, double rough, Random& random)
{
    for (int i = 0; i < 3; ++i)
    {
        const double x = random.within(-kSize, kSize), y = height + random.within(-rough, rough),
                     z = random.within(-kSize, kSize);
        corners[i] = {roundToFloat(at + x), roundToFloat(at + y), roundToFloat(at + z)};
    }
}

TriangleSet makeSet(const std::string& name, std::size_t count, double distance, bool layers, std::uint32_t seed)
{
    Random random(seed);
    TriangleSet set;
    set.m_name = name;
    for (std::size_t i = 0; i < count; ++i)
    {
        Vector3 a[3], b[3];
        place(a, distance, 0, layers ? 0.2 * kLayer : kSize, random);
        place(b, distance, layers ? kLayer : 0, layers ? 0.2 * kLayer : kSize, random);
        TriangleQuery query;
        for (int corner = 0; corner < 9; ++corner)
        {
            query.m_a[corner] = float(a[corner / 3][corner % 3]);
            query.m_b[corner] = float(b[corner / 3][corner % 3]);
        }
        set.m_queries.push_back(query);
        set.m_truth.push_back(trianglesIntersect(a, b));
    }
    return set;
}
}  // namespace

std::vector<TriangleSet> makeTriangleSets(std::size_t pairs)
{
    return {makeSet("triangles at 1 m", pairs, 1, false, 91), makeSet("triangles at 100 m", pairs, 100, false, 92),
            makeSet("layers 1 mm apart", pairs, 1, true, 93)};
}
}  // namespace drape::bench
