#include "scenes/draped_cloth.h"

#include <algorithm>
#include <cmath>

#include "scenes/cloth_grid.h"
#include "scenes/random.h"

namespace drape
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
// Sweeps of the projection. Each takes what is left of the violations to about half; after ten a thousandth is left.
constexpr int kSweeps = 10;
// Points looked at along a triangle's side, at most: above it coarse cloths on fine meshes would take minutes.
constexpr int kMostPoints = 24;

// The height of the surface at a point of a triangle of the cloth.
struct Support
{
    std::size_t m_triangle;
    double m_weights[3];
    double m_height;
};

void placeNodes(TriangleMesh& cloth, const ClothPlace& place)
{
    const double c = std::cos(place.m_turn), s = std::sin(place.m_turn);
    for (std::size_t v = 0; v < cloth.vertexCount(); ++v)
    {
        float* p = &cloth.m_positions[3 * v];
        const double x = p[0], z = p[2];
        p[0] = static_cast<float>(place.m_x + c * x + s * z);
        p[2] = static_cast<float>(place.m_z - s * x + c * z);
    }
}

std::vector<double> nodeHeights(const HeightField& field, const TriangleMesh& cloth, double gap)
{
    std::vector<double> heights(cloth.vertexCount(), -1e30);
    for (std::size_t v = 0; v < heights.size(); ++v)
    {
        double surface = 0;
        if (field.highest(cloth.m_positions[3 * v], cloth.m_positions[3 * v + 2], surface)) heights[v] = surface + gap;
    }
    return heights;
}

// Raises nodes until no node hangs more steeply than the slope from any other. Two sweeps over the grid, there and
// back, carry heights to all nodes through straight and diagonal neighbours.
void limitSlope(std::vector<double>& heights, int nodes, double cell)
{
    const int neighbours[4][2] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    for (int sweep = 0; sweep < 2; ++sweep)
        for (int k = 0; k < nodes * nodes; ++k)
        {
            const int place = sweep == 0 ? k : nodes * nodes - 1 - k, sign = sweep == 0 ? 1 : -1;
            const int i = place % nodes, j = place / nodes;
            for (const auto& offset : neighbours)
            {
                const int ni = i + sign * offset[0], nj = j + sign * offset[1];
                if (ni < 0 || nj < 0 || ni >= nodes || nj >= nodes) continue;
                const double run = cell * std::hypot(offset[0], offset[1]);
                double& height = heights[static_cast<std::size_t>(place)];
                height = std::max(height, heights[static_cast<std::size_t>(nj * nodes + ni)] - kDrapeSlope * run);
            }
        }
}

std::vector<Support> findSupports(const HeightField& field, const TriangleMesh& cloth, double gap, int points)
{
    std::vector<Support> supports;
    for (std::size_t t = 0; t < cloth.triangleCount(); ++t)
    {
        const float* corners[3];
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = &cloth.m_positions[3 * static_cast<std::size_t>(cloth.m_triangles[3 * t + i])];
        for (int a = 0; a < points; ++a)
            for (int b = 0; a + b < points; ++b)
            {
                Support support{t, {(a + 1.0 / 3) / points, (b + 1.0 / 3) / points, 0}, 0};
                support.m_weights[2] = 1 - support.m_weights[0] - support.m_weights[1];
                double x = 0, z = 0;
                for (std::size_t i = 0; i < 3; ++i)
                {
                    x += support.m_weights[i] * corners[i][0];
                    z += support.m_weights[i] * corners[i][2];
                }
                if (!field.highest(x, z, support.m_height)) continue;
                support.m_height += gap;
                supports.push_back(support);
            }
    }
    return supports;
}

// Raises the corners of each triangle that is too low at a point, by the least change that puts the point right.
void raise(const TriangleMesh& cloth, const std::vector<Support>& supports, std::vector<double>& heights)
{
    for (const Support& support : supports)
    {
        const std::int32_t* corners = &cloth.m_triangles[3 * support.m_triangle];
        double lack = support.m_height, norm = 0;
        for (std::size_t i = 0; i < 3; ++i)
        {
            lack -= support.m_weights[i] * heights[static_cast<std::size_t>(corners[i])];
            norm += support.m_weights[i] * support.m_weights[i];
        }
        if (lack <= 0) continue;
        for (std::size_t i = 0; i < 3; ++i)
            heights[static_cast<std::size_t>(corners[i])] += lack * support.m_weights[i] / norm;
    }
}
}  // namespace

TriangleMesh drapeCloth(const HeightField& field, const ClothPlace& place)
{
    const int nodes = place.m_cells + 1;
    const double cell = place.m_size / place.m_cells;
    TriangleMesh cloth = makeClothGrid(nodes, nodes, static_cast<float>(place.m_size), 0).m_mesh;
    placeNodes(cloth, place);
    const int points = std::clamp(static_cast<int>(std::ceil(cell / place.m_detail)), 1, kMostPoints);
    std::vector<double> heights = nodeHeights(field, cloth, place.m_gap);
    const std::vector<Support> supports = findSupports(field, cloth, place.m_gap, points);
    limitSlope(heights, nodes, cell);
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        raise(cloth, supports, heights);
    for (std::size_t v = 0; v < cloth.vertexCount(); ++v)
        cloth.m_positions[3 * v + 1] = static_cast<float>(std::max(heights[v], field.bounds().m_low[1] - 1.0));
    return cloth;
}

std::vector<ClothPlace> scatterCloths(const HeightField& field, const ClothPlace& place, int count, std::uint32_t seed)
{
    Random random(seed);
    const Bounds& bounds = field.bounds();
    std::vector<ClothPlace> places;
    // A floor plan with more than a thousandth covered is an obstacle. Otherwise the cloths lie anywhere.
    long tries = 1000L * count;
    while (places.size() < static_cast<std::size_t>(count))
    {
        ClothPlace next = place;
        next.m_x = random.within(bounds.m_low[0], bounds.m_high[0]);
        next.m_z = random.within(bounds.m_low[2], bounds.m_high[2]);
        next.m_turn = random.within(0, 2 * kPi);
        double height = 0;
        if (field.highest(next.m_x, next.m_z, height) || --tries < 0) places.push_back(next);
    }
    return places;
}

void ClothMotion::positions(const std::vector<float>& rest, int step, float* out) const
{
    const double phase = 2 * kPi * (step % m_period) / m_period;
    // A circle of radius a in x and z moves by 2 a sin(π / period) in a step, the sway in y by as much at most.
    const double amplitude = m_way / (2 * std::sin(kPi / m_period) * std::sqrt(2.0));
    const double x = amplitude * std::sin(phase), z = amplitude * std::cos(phase);
    for (std::size_t i = 0; i < rest.size(); i += 3)
    {
        // The wave has two metres along x and three along z: neighbours move alike, distant parts against one another.
        const double wave = amplitude * std::sin(phase + kPi * rest[i] + 2 * kPi / 3 * rest[i + 2]);
        out[i] = static_cast<float>(rest[i] + x);
        out[i + 1] = static_cast<float>(rest[i + 1] + wave);
        out[i + 2] = static_cast<float>(rest[i + 2] + z);
    }
}
}  // namespace drape
