#include "scenes/cloth_curve.h"

#include <algorithm>
#include <cmath>

namespace drape
{
namespace
{
constexpr double kPi = 3.14159265358979323846;

// Turns a vector by the least rotation that takes one unit vector to another.
Vector3 turned(const Vector3& v, const Vector3& from, const Vector3& to)
{
    const Vector3 axis = cross(from, to);
    const double cosine = dot(from, to);
    if (!(cosine > -1 + 1e-12)) return v;
    return v + cross(axis, v) + (1 / (1 + cosine)) * cross(axis, cross(axis, v));
}

Vector3 nodeAt(const TriangleMesh& mesh, std::size_t node)
{
    const float* const p = mesh.m_positions.data() + 3 * node;
    return {p[0], p[1], p[2]};
}

Vector3 chord(const Polyline& curve, std::size_t piece)
{
    return normalized(curve[piece + 1] - curve[piece]);
}
}  // namespace

double lengthOf(const Polyline& curve)
{
    double sum = 0;
    for (std::size_t i = 1; i < curve.size(); ++i)
        sum += length(curve[i] - curve[i - 1]);
    return sum;
}

Polyline smoothCurve(const Polyline& points, int parts)
{
    Polyline curve = {points.front()};
    const auto at = [&](std::ptrdiff_t i)
    { return points[std::size_t(std::clamp(i, std::ptrdiff_t(0), std::ptrdiff_t(points.size()) - 1))]; };
    for (std::ptrdiff_t i = 0; i + 1 < std::ptrdiff_t(points.size()); ++i)
        for (int k = 1; k <= parts; ++k)
        {
            const double t = double(k) / parts;
            const double before = -0.5 * t * (1 - t) * (1 - t), after = -0.5 * t * t * (1 - t);
            const double first = 1 + t * t * (1.5 * t - 2.5);
            curve.push_back(before * at(i - 1) + first * at(i) + (1 - before - first - after) * at(i + 1) +
                            after * at(i + 2));
        }
    return curve;
}

Polyline spiral(double innerRadius, double gap, double turns)
{
    Polyline curve;
    const int parts = int(64 * turns);
    for (int i = 0; i <= parts; ++i)
    {
        const double angle = 2 * kPi * turns * i / parts, radius = innerRadius + gap * angle / (2 * kPi);
        curve.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    return curve;
}

Polyline zigzag(double width, double gap, int layers)
{
    Polyline curve;
    for (int layer = 0; layer < layers; ++layer)
    {
        const double side = layer % 2 == 0 ? 1 : -1, height = gap * layer;
        curve.push_back({-side * width / 2, height, 0});
        curve.push_back({side * width / 2, height, 0});
        for (int k = 1; k < 8 && layer + 1 < layers; ++k)
        {
            const double angle = kPi * (k / 8.0 - 0.5);
            curve.push_back(
                {side * (width / 2 + gap / 2 * std::cos(angle)), height + gap / 2 + gap / 2 * std::sin(angle), 0});
        }
    }
    return curve;
}

std::vector<float> placeAlong(const ClothGrid& cloth, int columns, const Polyline& curve, const Vector3& across)
{
    const std::size_t width = std::size_t(columns), rows = cloth.m_mesh.vertexCount() / width;
    const double step = lengthOf(curve) / double(columns - 1);
    std::vector<float> positions(cloth.m_mesh.m_positions.size());
    Vector3 side = normalized(across);
    double passed = 0;  // length of the curve up to the piece
    std::size_t piece = 0;
    for (std::size_t column = 0; column < width; ++column)
    {
        const double at = step * double(column);
        double own = length(curve[piece + 1] - curve[piece]);
        while (passed + own < at && piece + 2 < curve.size())
        {
            side = turned(side, chord(curve, piece), chord(curve, piece + 1));
            passed += own;
            ++piece;
            own = length(curve[piece + 1] - curve[piece]);
        }
        const Vector3 middle = curve[piece] + (at - passed) * chord(curve, piece);
        for (std::size_t row = 0; row < rows; ++row)
        {
            const std::size_t node = row * width + column;
            const Vector3 place = middle + nodeAt(cloth.m_mesh, node).z * side;
            for (int axis = 0; axis < 3; ++axis)
                positions[3 * node + std::size_t(axis)] = float(place[axis]);
        }
    }
    return positions;
}
}  // namespace drape
