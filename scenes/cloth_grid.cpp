#include "scenes/cloth_grid.h"

#include <algorithm>
#include <cmath>

namespace drape
{
namespace
{
void addNodes(ClothGrid& grid, int columns, int rows, float size, float y)
{
    const double cell = static_cast<double>(size) / (std::max(columns, rows) - 1);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            grid.m_mesh.m_positions.insert(grid.m_mesh.m_positions.end(),
                                           {static_cast<float>((i - 0.5 * (columns - 1)) * cell), y,
                                            static_cast<float>((j - 0.5 * (rows - 1)) * cell)});
}

void addCell(ClothGrid& grid, int a, int b, int c, int d, bool falling)
{
    // a b is the cell's near row, d c the far one; y is up, so counter-clockwise from above is a d c b.
    std::vector<std::int32_t>& triangles = grid.m_mesh.m_triangles;
    if (falling)
        triangles.insert(triangles.end(), {a, d, b, b, d, c});
    else
        triangles.insert(triangles.end(), {a, d, c, a, c, b});
    grid.m_edgeSprings.insert(grid.m_edgeSprings.end(), {falling ? b : a, falling ? d : c});
}

void addSprings(std::vector<std::int32_t>& springs, int columns, int rows, int di, int dj)
{
    for (int j = std::max(0, -dj); j < rows - std::max(0, dj); ++j)
        for (int i = std::max(0, -di); i < columns - std::max(0, di); ++i)
            springs.insert(springs.end(), {j * columns + i, (j + dj) * columns + i + di});
}
}  // namespace

ClothGrid makeClothGrid(int columns, int rows, float size, float y)
{
    ClothGrid grid;
    addNodes(grid, columns, rows, size, y);
    addSprings(grid.m_edgeSprings, columns, rows, 1, 0);
    addSprings(grid.m_edgeSprings, columns, rows, 0, 1);
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i + 1 < columns; ++i)
        {
            const int a = j * columns + i;
            addCell(grid, a, a + 1, a + 1 + columns, a + columns, ((i + j) & 1) != 0);
        }
    const int offsets[4][2] = {{2, 0}, {0, 2}, {2, 2}, {2, -2}};
    for (const auto& offset : offsets)
        addSprings(grid.m_bendingSprings, columns, rows, offset[0], offset[1]);
    return grid;
}

ClothGrid makeClothTube(int around, int rows, float radius, float height)
{
    constexpr double kPi = 3.14159265358979323846;
    ClothGrid tube;
    std::vector<float>& positions = tube.m_mesh.m_positions;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < around; ++i)
        {
            const double angle = -2 * kPi * i / around;
            positions.insert(positions.end(), {static_cast<float>(radius * std::cos(angle)),
                                               static_cast<float>(height * (static_cast<double>(j) / (rows - 1) - 0.5)),
                                               static_cast<float>(radius * std::sin(angle))});
        }
    const auto node = [&](int i, int j) { return j * around + i % around; };
    const auto addRound = [&](std::vector<std::int32_t>& springs, int di, int dj)
    {
        for (int j = 0; j + dj < rows; ++j)
            for (int i = 0; i < around; ++i)
                springs.insert(springs.end(), {node(i, j), node(i + di + around, j + dj)});
    };
    addRound(tube.m_edgeSprings, 1, 0);
    addRound(tube.m_edgeSprings, 0, 1);
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i < around; ++i)
            addCell(tube, node(i, j + 1), node(i + 1, j + 1), node(i + 1, j), node(i, j), ((i + j) & 1) != 0);
    const int offsets[4][2] = {{2, 0}, {0, 2}, {2, 2}, {-2, 2}};
    for (const auto& offset : offsets)
        addRound(tube.m_bendingSprings, offset[0], offset[1]);
    return tube;
}
}  // namespace drape
