// Cloth from triangle meshes (scenes/cloth_mesh.h) and triangles of obstacles' shapes (scenes/obstacle_shape.h).
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "scenes/cloth_mesh.h"
#include "scenes/obstacle_shape.h"

namespace drape::test
{
TEST(ClothMesh, HasAGridsEdgesAndASpringAcrossEachInnerEdge)
{
    const ClothGrid grid = makeClothGrid(5, 4, 1, 0);
    const ClothGrid cloth = clothOfMesh(grid.m_mesh);
    EXPECT_EQ(cloth.m_edgeSprings.size(), grid.m_edgeSprings.size());
    const std::size_t edges = grid.m_edgeSprings.size() / 2, rim = 2 * (4 + 3);
    EXPECT_EQ(cloth.m_bendingSprings.size() / 2, edges - rim);
    for (std::size_t i = 0; i < cloth.m_bendingSprings.size(); i += 2)
        EXPECT_NE(cloth.m_bendingSprings[i], cloth.m_bendingSprings[i + 1]);
}

TEST(ClothMesh, MassesFollowTheAreas)
{
    const TriangleMesh mesh = makeClothGrid(5, 3, 2, 0).m_mesh;
    EXPECT_NEAR(areaOf(mesh), 2, 1e-6);
    const std::vector<double> masses = massesByArea(mesh, 3);
    EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), 3, 1e-12);
    EXPECT_GT(masses[6], 2 * masses[0]) << "an inner node has more cloth around it than a corner";
}

TEST(ObstacleShape, TrianglesLieOnOrInsideTheShape)
{
    ObstacleShape shape;
    shape.m_kind = ObstacleShape::Kind::Capsule;
    shape.m_radius = 0.5;
    shape.m_length = 1;
    const TriangleMesh capsule = triangulated(shape);
    for (std::size_t i = 0; i < capsule.m_positions.size(); i += 3)
    {
        const auto x = double(capsule.m_positions[i]), y = double(capsule.m_positions[i + 1]);
        const double beyond = std::max(0.0, std::abs(y) - 0.5);
        EXPECT_LE(std::hypot(x, beyond, double(capsule.m_positions[i + 2])), 0.5);
    }
    shape.m_kind = ObstacleShape::Kind::HeightField;
    shape.m_columns = 3;
    shape.m_rows = 2;
    shape.m_cell = 2;
    shape.m_heights = {0, 1, 2, 3, 4, 5};
    const TriangleMesh field = triangulated(shape);
    EXPECT_EQ(field.triangleCount(), 4u);
    EXPECT_EQ(boundsOf(field).m_low[0], -2);
    EXPECT_EQ(boundsOf(field).m_high[2], 1);
    EXPECT_EQ(field.m_positions[3 * 5 + 1], 5);
    shape.m_kind = ObstacleShape::Kind::Plane;
    shape.m_normal = {0, 0, 1};
    shape.m_offset = 0.5;
    const TriangleMesh plane = triangulated(shape);
    EXPECT_EQ(boundsOf(plane).m_low[2], 0.5f);
    EXPECT_EQ(boundsOf(plane).m_high[2], 0.5f);
}
}  // namespace drape::test
