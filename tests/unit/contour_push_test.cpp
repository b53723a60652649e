// Displacements that bring intersecting triangles of cloth apart.
#include "bullet_plugin/core/cloth_cloth/contour_push.h"

#include <gtest/gtest.h>

#include <cmath>

namespace drape::test
{
namespace
{
// A large triangle in the plane y = 0, and one that pokes its last corner through it by `depth` (m).
std::vector<float> pokedThrough(float depth)
{
    return {-5, 0, -5, 5, 0, -5, 0, 0, 8, -1, 2, 0.1f, 1, 2, -0.1f, 0.2f, -depth, 0};
}

const std::vector<std::uint32_t> kPair = {0, 1, 2, 3, 4, 5};

double wayOf(const ContourPush& push, std::size_t node, std::size_t axis)
{
    return push.displacements()[3 * node + axis];
}

std::vector<float> moved(std::vector<float> positions, const ContourPush& push)
{
    for (std::size_t i = 0; i < positions.size(); ++i)
        positions[i] += float(push.displacements()[i]);
    return positions;
}
}  // namespace

TEST(ContourPush, ACornerWithdrawsAndTheFaceMovesTheOtherWay)
{
    ContourPush push;
    push.compute(kPair, pokedThrough(0.1f).data(), std::vector<unsigned char>(6, 0), std::vector<double>(6, 0.01));
    ASSERT_EQ(push.displacements().size(), 18u);
    EXPECT_GT(wayOf(push, 5, 1), 0.004);
    for (const std::size_t node : {0, 1, 2})
        EXPECT_LT(wayOf(push, node, 1), 0);
    for (std::size_t node = 0; node < 6; ++node)
        EXPECT_LE(std::hypot(wayOf(push, node, 0), wayOf(push, node, 1), wayOf(push, node, 2)), 0.01 * (1 + 1e-9));
}

TEST(ContourPush, RepeatedPushesBringTheTrianglesApart)
{
    std::vector<float> positions = pokedThrough(0.1f);
    ContourPush push;
    int steps = 0;
    for (; steps < 100; ++steps)
    {
        push.compute(kPair, positions.data(), std::vector<unsigned char>(6, 0), std::vector<double>(6, 0.01));
        positions = moved(positions, push);
        if (positions[16] > positions[1]) break;
    }
    EXPECT_LT(steps, 40);
}

TEST(ContourPush, HeldNodesStay)
{
    ContourPush push;
    push.compute(kPair, pokedThrough(0.1f).data(), {1, 1, 1, 0, 0, 0}, std::vector<double>(6, 0.01));
    for (const std::size_t node : {0, 1, 2})
        for (const std::size_t axis : {0, 1, 2})
            EXPECT_EQ(wayOf(push, node, axis), 0);
    EXPECT_GT(wayOf(push, 5, 1), 0);
}

TEST(ContourPush, PairsWithoutAnIntersectionOrAreaMoveNothing)
{
    std::vector<float> flat = pokedThrough(-0.1f);
    ContourPush push;
    push.compute(kPair, flat.data(), std::vector<unsigned char>(6, 0), std::vector<double>(6, 0.01));
    for (const double way : push.displacements())
        EXPECT_EQ(way, 0);
    std::fill(flat.begin() + 9, flat.end(), 0.0f);
    push.compute(kPair, flat.data(), std::vector<unsigned char>(6, 0), std::vector<double>(6, 0.01));
    for (const double way : push.displacements())
        EXPECT_EQ(way, 0);
    push.compute({}, flat.data(), std::vector<unsigned char>(6, 0), std::vector<double>(6, 0.01));
    EXPECT_TRUE(push.displacements().empty());
}
}  // namespace drape::test
