#include "expected_pairs.h"

#include <algorithm>
#include <cmath>

namespace drape
{
double expectedPairs(const Surface& cloth, const Surface& obstacle, double reach)
{
    const double all = double(cloth.m_triangles) * double(obstacle.m_triangles);
    if (!(cloth.m_area > 0) || !(obstacle.m_area > 0)) return all;
    const double perClothArea = double(cloth.m_triangles) / cloth.m_area;
    const double perObstacleArea = double(obstacle.m_triangles) / obstacle.m_area;
    // A triangle of a grid is half a square of this side. A box around it, grown by the reach, meets another whose
    // middle lies within half of both sides plus twice the reach.
    const double side = std::sqrt(2 / perClothArea) + std::sqrt(2 / perObstacleArea) + 2 * reach;
    const double pairs = std::min(cloth.m_area, obstacle.m_area) * perClothArea * perObstacleArea * side * side;
    return std::isfinite(pairs) ? std::min(pairs, all) : all;
}
}  // namespace drape
