// Ropes of scenes (scenes/cloth_rope.h) and volumes of meshes (scenes/mesh_volume.h).
#include <gtest/gtest.h>

#include <numeric>

#include "scenes/cloth_rope.h"
#include "scenes/mesh_volume.h"
#include "scenes/shapes.h"

namespace drape::test
{
TEST(Rope, HasLinksBetweenNeighboursAndAcrossNodesThatBend)
{
    const ClothGrid rope = makeRope(nodesBetween({0, 1, 0}, {3, 1, 0}, 4), false);
    EXPECT_EQ(rope.m_mesh.m_positions, (std::vector<float>{0, 1, 0, 1, 1, 0, 2, 1, 0, 3, 1, 0}));
    EXPECT_EQ(rope.m_edgeSprings, (std::vector<std::int32_t>{0, 1, 1, 2, 2, 3}));
    EXPECT_TRUE(rope.m_bendingSprings.empty());
    EXPECT_EQ(makeRope(rope.m_mesh.m_positions, true).m_bendingSprings, (std::vector<std::int32_t>{0, 2, 1, 3}));
}

TEST(Rope, MassesFollowTheLengths)
{
    const std::vector<double> masses = massesByLength({0, 0, 0, 1, 0, 0, 1, 3, 0}, 8);
    EXPECT_EQ(masses, (std::vector<double>{1, 4, 3}));
}

TEST(Rope, TubesAreClosedAndSkipLinesWithoutALength)
{
    const TriangleMesh tubes = tubesAround({0, 0, 0, 0, 0, 2, 0, 0, 2}, {0, 1, 1, 2}, 0.1);
    EXPECT_EQ(whyNotClosed(tubes), "");
    EXPECT_NEAR(volumeOf(tubes), 3.14 * 0.01 * 2, 0.01);
}

TEST(MeshVolume, IsThatOfTheShapeAndSigned)
{
    TriangleMesh box = makeBox(1, 2, 3);
    joinVertices(box);
    EXPECT_EQ(whyNotClosed(box), "");
    EXPECT_NEAR(volumeOf(box), 6, 1e-6);
    TriangleMesh inward = box;
    for (std::size_t t = 0; t < inward.m_triangles.size(); t += 3)
        std::swap(inward.m_triangles[t], inward.m_triangles[t + 1]);
    EXPECT_NEAR(volumeOf(inward), -6, 1e-6);
    turnOutwards(inward);
    EXPECT_NEAR(volumeOf(inward), 6, 1e-6);
    turnOutwards(box);
    EXPECT_NEAR(volumeOf(box), 6, 1e-6);
}

TEST(MeshVolume, ReasonsNameWhatIsNotClosed)
{
    TriangleMesh box = makeBox(1, 1, 1);
    joinVertices(box);
    const auto reasonWithout = [&](std::size_t triangles)
    {
        TriangleMesh open = box;
        open.m_triangles.resize(open.m_triangles.size() - 3 * triangles);
        return whyNotClosed(open);
    };
    EXPECT_NE(reasonWithout(1).find("belongs to one triangle only"), std::string::npos);
    EXPECT_EQ(reasonWithout(box.triangleCount()), "it has no triangles");
    TriangleMesh twisted = box;
    std::swap(twisted.m_triangles[0], twisted.m_triangles[1]);
    EXPECT_NE(whyNotClosed(twisted).find("face opposite sides"), std::string::npos);
    TriangleMesh doubled = box;
    doubled.m_triangles.insert(doubled.m_triangles.end(), box.m_triangles.begin(), box.m_triangles.begin() + 3);
    EXPECT_NE(whyNotClosed(doubled).find("belongs to 3 triangles, not two"), std::string::npos);
    TriangleMesh two = box;
    for (const std::int32_t vertex : box.m_triangles)
        two.m_triangles.push_back(vertex + std::int32_t(box.vertexCount()));
    two.m_positions.insert(two.m_positions.end(), box.m_positions.begin(), box.m_positions.end());
    EXPECT_EQ(whyNotClosed(two), "it has 2 parts; make a cloth of each");
}
}  // namespace drape::test
