#include "obstacle_poses.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape
{
namespace
{
// Roundings of a placed coordinate: three products and three sums.
constexpr double kRoundings = 8;

double turned(const Pose& pose, int row, const double* v)
{
    const float* m = pose.data() + 4 * row;
    return double(m[0]) * v[0] + double(m[1]) * v[1] + double(m[2]) * v[2];
}

// Cofactors over the determinant.
void invert(const Pose& pose, double inverse[3][3])
{
    const auto m = [&](int row, int column) { return double(pose[std::size_t(4 * (row % 3) + column % 3)]); };
    for (int i = 0; i < 3; ++i)
    {
        for (int k = 0; k < 3; ++k)
            inverse[k][i] = m(i + 1, k + 1) * m(i + 2, k + 2) - m(i + 1, k + 2) * m(i + 2, k + 1);
    }
    const double determinant = m(0, 0) * inverse[0][0] + m(0, 1) * inverse[1][0] + m(0, 2) * inverse[2][0];
    for (int i = 0; i < 9; ++i)
        inverse[i / 3][i % 3] /= determinant;
}
}  // namespace

MeshBox placedBox(const Pose& pose, const MeshBox& own)
{
    MeshBox box;
    for (int row = 0; row < 3; ++row)
    {
        const float* m = pose.data() + 4 * row;
        double low = m[3], high = m[3], size = std::fabs(double(m[3]));
        for (int k = 0; k < 3; ++k)
        {
            const double a = double(m[k]) * own.m_low[k], b = double(m[k]) * own.m_high[k];
            low += std::min(a, b);
            high += std::max(a, b);
            size += std::max(std::fabs(a), std::fabs(b));
        }
        const double pad = kRoundings * double(std::numeric_limits<float>::epsilon()) * size;
        box.m_low[row] = float(low - pad);
        box.m_high[row] = float(high + pad);
    }
    return box;
}

ObstacleMotion makeMotion(const ObstaclePoses& poses, const MeshBox& own, std::uint32_t slot)
{
    ObstacleMotion motion;
    double inverse[3][3];
    invert(poses.m_start, inverse);
    double origin[3] = {0, 0, 0};  // the world's origin in the frame at the start
    for (int i = 0; i < 3; ++i)
    {
        for (int k = 0; k < 3; ++k)
            origin[i] -= inverse[i][k] * double(poses.m_start[std::size_t(4 * k + 3)]);
    }
    for (int row = 0; row < 3; ++row)
    {
        float* out = motion.m_map + 4 * row;
        for (int column = 0; column < 3; ++column)
        {
            const double direction[3] = {inverse[0][column], inverse[1][column], inverse[2][column]};
            out[column] = float(turned(poses.m_end, row, direction));
        }
        out[3] = float(turned(poses.m_end, row, origin) + double(poses.m_end[std::size_t(4 * row + 3)]));
    }
    const MeshBox box = placedBox(poses.m_end, own);
    std::copy(box.m_low, box.m_low + 3, motion.m_low);
    std::copy(box.m_high, box.m_high + 3, motion.m_high);
    motion.m_mesh = slot;
    return motion;
}
}  // namespace drape
