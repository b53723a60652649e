// The exact check of cloth with itself, on pairs of triangles that share no vertex, one or two.
#include "oracle/self_intersections.h"

#include <gtest/gtest.h>

#include "scenes/cloth_grid.h"

namespace drape::test
{
namespace
{
std::size_t pairsOf(const std::vector<float>& positions, const std::vector<std::int32_t>& triangles)
{
    TriangleMesh mesh;
    mesh.m_positions = positions;
    mesh.m_triangles = triangles;
    return SelfIntersections(mesh).find(positions).size();
}

// The triangles 0 1 2 and 0 3 4, the first of which lies in the plane z = 0.
std::size_t pairsAtAVertex(const std::vector<float>& third, const std::vector<float>& fourth)
{
    std::vector<float> positions = {0, 0, 0, 2, 0, 0, 0, 2, 0};
    positions.insert(positions.end(), third.begin(), third.end());
    positions.insert(positions.end(), fourth.begin(), fourth.end());
    return pairsOf(positions, {0, 1, 2, 0, 3, 4});
}

// The triangles 0 1 2 and 0 1 3, the first of which lies in the plane z = 0.
std::size_t pairsAtAnEdge(float x, float y, float z)
{
    return pairsOf({0, 0, 0, 2, 0, 0, 0, 2, 0, x, y, z}, {0, 1, 2, 1, 0, 3});
}
}  // namespace

TEST(SelfIntersections, TrianglesWithoutACommonVertexCountWhereTheyTouch)
{
    const std::vector<std::int32_t> triangles = {0, 1, 2, 3, 4, 5};
    EXPECT_EQ(pairsOf({0, 0, 0, 2, 0, 0, 0, 2, 0, 0.5f, 0.5f, -1, 0.5f, 0.5f, 1, 3, 3, 0}, triangles), 1u);
    EXPECT_EQ(pairsOf({0, 0, 0, 2, 0, 0, 0, 2, 0, 0.5f, 0.5f, 0, 0.5f, 0.5f, 1, 3, 3, 1}, triangles), 1u);
    EXPECT_EQ(pairsOf({0, 0, 0, 2, 0, 0, 0, 2, 0, 0.5f, 0.5f, 1e-30f, 0.5f, 0.5f, 1, 3, 3, 1}, triangles), 0u);
}

TEST(SelfIntersections, TrianglesWithACommonVertexNeedAnotherCommonPoint)
{
    EXPECT_EQ(pairsAtAVertex({-1, 0, 0}, {0, -1, 0}), 0u);             // opposite quadrants
    EXPECT_EQ(pairsAtAVertex({-1, 3, 0}, {-1, 1, 0}), 0u);             // beside it, in its plane
    EXPECT_EQ(pairsAtAVertex({1, 1, 1}, {1, 1, 2}), 0u);               // above
    EXPECT_EQ(pairsAtAVertex({1, 1, 1}, {1, 1, -1}), 1u);              // through the opposite edge
    EXPECT_EQ(pairsAtAVertex({0.1f, 0.1f, 1}, {0.1f, 0.1f, -1}), 1u);  // through the face
    EXPECT_EQ(pairsAtAVertex({3, 3, 1}, {3, 3, -1}), 1u);              // its opposite edge passes beside the first
    EXPECT_EQ(pairsAtAVertex({2, 0, 0}, {2, -2, 0}), 1u);              // along an edge
    EXPECT_EQ(pairsAtAVertex({0.5f, 0.5f, 0}, {3, 3, 1}), 1u);         // one edge in the face
}

TEST(SelfIntersections, TrianglesWithACommonEdgeCountWhenFoldedFlat)
{
    EXPECT_EQ(pairsAtAnEdge(0, -2, 0), 0u);
    EXPECT_EQ(pairsAtAnEdge(0, 1, 1e-30f), 0u);
    EXPECT_EQ(pairsAtAnEdge(0, 1, 0), 1u);
    EXPECT_EQ(pairsAtAnEdge(5, 1, 0), 1u);
    EXPECT_EQ(pairsAtAnEdge(5, 0, 0), 0u);  // no area
}

TEST(SelfIntersections, AFlatClothHasNoneAndAClothFoldedThroughItselfHasSome)
{
    const ClothGrid grid = makeClothGrid(9, 9, 1, 0);
    SelfIntersections check(grid.m_mesh);
    std::vector<float> positions = grid.m_mesh.m_positions;
    EXPECT_TRUE(check.find(positions).empty());
    // Folds the right half onto the left one, tilted, so that it passes through.
    for (std::size_t i = 0; i < positions.size(); i += 3)
        if (positions[i] > 0.05f)
        {
            positions[i + 1] = 0.1f - 0.5f * positions[i];
            positions[i] = -positions[i];
        }
    const auto pairs = check.find(positions);
    EXPECT_GE(pairs.size(), 8u);
    for (const auto& pair : pairs)
        EXPECT_LT(pair.first, pair.second);
}
}  // namespace drape::test
