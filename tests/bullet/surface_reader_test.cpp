// Height fields of every type of data and every axis give Bullet's own triangles; planes cover their boxes.
#include "bullet_plugin/adapter/mirrors/surface_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>

#include "BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h"
#include "BulletCollision/CollisionShapes/btStaticPlaneShape.h"

namespace drape::test
{
namespace
{
constexpr int kWide = 9, kLong = 14;  // grid points

using Corners = std::array<std::array<btScalar, 3>, 3>;

Corners cornersOf(const btVector3& a, const btVector3& b, const btVector3& c)
{
    Corners corners;
    const btVector3* const all[] = {&a, &b, &c};
    for (std::size_t k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis)
            corners[k][std::size_t(axis)] = (*all[k])[axis];
    return corners;
}

class ListCorners : public btTriangleCallback
{
public:
    void processTriangle(btVector3* corners, int, int) override
    {
        m_found.insert(cornersOf(corners[0], corners[1], corners[2]));
    }

    std::set<Corners> m_found;
};

std::set<Corners> bulletsTriangles(const btHeightfieldTerrainShape& field)
{
    ListCorners list;
    const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    field.processAllTriangles(&list, -far, far);
    return list.m_found;
}

struct Surface
{
    std::vector<btVector3> m_vertices;
    std::vector<std::int32_t> m_triangles;

    std::set<Corners> triangles() const
    {
        std::set<Corners> all;
        const auto at = [&](std::size_t i) { return m_vertices[std::size_t(m_triangles[i])]; };
        for (std::size_t i = 0; i < m_triangles.size(); i += 3)
            all.insert(cornersOf(at(i), at(i + 1), at(i + 2)));
        return all;
    }
};

Surface read(const btCollisionShape& shape, const std::vector<SurfaceBox>& boxes,
             const TriangleFilter& filter = nullptr)
{
    Surface surface;
    readSurface(shape, boxes, filter, surface.m_vertices, surface.m_triangles);
    return surface;
}

SurfaceBox wholeOf(const btCollisionShape& shape)
{
    SurfaceBox box;
    shape.getAabb(btTransform::getIdentity(), box.m_low, box.m_high);
    return box;
}

// Heights of 0 to 10 as numbers of any type.
template <typename Height>
std::vector<Height> makeHeights()
{
    std::vector<Height> heights;
    for (int i = 0; i < kWide * kLong; ++i)
        heights.push_back(Height(i * i % 11));
    return heights;
}

void expectBulletsTriangles(btHeightfieldTerrainShape& field)
{
    for (const int flags : {0, 1, 2, 4, 5})
    {
        field.setUseDiamondSubdivision(flags & 1);
        field.setUseZigzagSubdivision(flags & 2);
        field.setFlipTriangleWinding(flags & 4);
        field.setLocalScaling(btVector3(btScalar(0.5), 2, btScalar(1.5)));
        const Surface surface = read(field, {wholeOf(field)});
        EXPECT_EQ(surface.m_vertices.size(), std::size_t(kWide * kLong));
        EXPECT_EQ(surface.m_triangles.size(), std::size_t(6 * (kWide - 1) * (kLong - 1)));
        EXPECT_EQ(surface.triangles(), bulletsTriangles(field));
    }
}

class HeightFieldAxes : public testing::TestWithParam<int>
{
};
}  // namespace

TEST_P(HeightFieldAxes, GiveBulletsTrianglesForEachTypeOfHeight)
{
    const auto floats = makeHeights<float>();
    const auto doubles = makeHeights<double>();
    const auto shorts = makeHeights<short>();
    const auto bytes = makeHeights<unsigned char>();
    for (const bool flips : {false, true})
    {
        btHeightfieldTerrainShape ofFloats(kWide, kLong, floats.data(), btScalar(0), btScalar(10), GetParam(), flips);
        btHeightfieldTerrainShape ofDoubles(kWide, kLong, doubles.data(), btScalar(0), btScalar(10), GetParam(), flips);
        btHeightfieldTerrainShape ofShorts(kWide, kLong, shorts.data(), btScalar(0.5), 0, 5, GetParam(), flips);
        btHeightfieldTerrainShape ofBytes(kWide, kLong, bytes.data(), btScalar(0.5), 0, 5, GetParam(), flips);
        for (btHeightfieldTerrainShape* field : {&ofFloats, &ofDoubles, &ofShorts, &ofBytes})
            expectBulletsTriangles(*field);
    }
}

INSTANTIATE_TEST_SUITE_P(UpAxes, HeightFieldAxes, testing::Values(0, 1, 2));

// Boxes that overlap give each cell once.
TEST(HeightFieldParts, CoverEachBoxAtAnyHeight)
{
    const auto heights = makeHeights<float>();
    const btHeightfieldTerrainShape field(kWide, kLong, heights.data(), btScalar(0), btScalar(10), 1, false);
    const std::vector<SurfaceBox> boxes = {{btVector3(-2, 90, -2), btVector3(-1, 91, -1)},
                                           {btVector3(-2, -9, -2), btVector3(1, -8, btScalar(0.5))}};
    const Surface part = read(field, boxes);
    const std::set<Corners> triangles = part.triangles();
    EXPECT_EQ(part.m_triangles.size(), 3 * triangles.size());
    EXPECT_LT(triangles.size(), 120u);
    for (const Corners& corners : bulletsTriangles(field))
    {
        bool isUnder = true;
        for (const std::size_t axis : {0u, 2u})
        {
            const auto least = std::min({corners[0][axis], corners[1][axis], corners[2][axis]});
            const auto most = std::max({corners[0][axis], corners[1][axis], corners[2][axis]});
            isUnder = isUnder && most >= boxes[1].m_low[int(axis)] && least <= boxes[1].m_high[int(axis)];
        }
        EXPECT_TRUE(!isUnder || triangles.count(corners) > 0);
    }
}

TEST(HeightFieldParts, LeaveOutWhatTheFilterRefuses)
{
    const auto heights = makeHeights<float>();
    const btHeightfieldTerrainShape field(kWide, kLong, heights.data(), btScalar(0), btScalar(10), 1, false);
    std::set<std::pair<int, int>> asked;
    const Surface part = read(field, {wholeOf(field)},
                              [&](int cell, int j)
                              {
                                  asked.insert({cell, j});
                                  return j != 3;
                              });
    EXPECT_EQ(asked.size(), std::size_t(2 * (kWide - 1) * (kLong - 1)));
    EXPECT_EQ(part.m_triangles.size(), std::size_t(6 * (kWide - 1) * (kLong - 2)));
}

TEST(PlaneParts, CoverTheirBoxesAndFaceAsThePlaneDoes)
{
    for (const btVector3& normal : {btVector3(0, 1, 0), btVector3(0, 0, -1), btVector3(1, -2, btScalar(0.3))})
    {
        const btStaticPlaneShape plane(normal, btScalar(0.7));
        const std::vector<SurfaceBox> boxes = {{btVector3(3, 4, 5), btVector3(4, 6, 5)},
                                               {btVector3(-3, 1, 9), btVector3(-2, 2, 9)}};
        const Surface surface = read(plane, boxes);
        ASSERT_EQ(surface.m_triangles.size(), 3u);
        const btVector3 a = surface.m_vertices[0], b = surface.m_vertices[1], c = surface.m_vertices[2];
        const btVector3 front = (b - a).cross(c - a).normalized();
        EXPECT_GT(front.dot(plane.getPlaneNormal()), btScalar(0.99999));
        for (const SurfaceBox& box : boxes)
        {
            for (const btVector3& corner : {box.m_low, box.m_high})
            {
                EXPECT_GT((b - a).cross(corner - a).dot(front), 0);
                EXPECT_GT((c - b).cross(corner - b).dot(front), 0);
                EXPECT_GT((a - c).cross(corner - c).dot(front), 0);
            }
        }
    }
    const btStaticPlaneShape level(btVector3(0, 1, 0), btScalar(0.1));
    for (const btVector3& vertex : read(level, {{btVector3(-7, 3, 5), btVector3(1, 4, 6)}}).m_vertices)
        EXPECT_EQ(vertex.y(), btScalar(0.1));
}

TEST(PlaneParts, MeetBoxesNearThem)
{
    const btStaticPlaneShape plane(btVector3(1, 1, 0), 0);
    const btTransform pose(btQuaternion(btVector3(0, 0, 1), SIMD_PI / 4), btVector3(0, 1, 0));  // level, at 1 m
    const auto meets = [&](btScalar low, btScalar high, btScalar reach) {
        return surfaceMeets(plane, pose, {btVector3(-9, low, -9), btVector3(9, high, 9)}, reach);
    };
    EXPECT_TRUE(meets(btScalar(0.9), 2, 0));
    EXPECT_FALSE(meets(btScalar(1.1), 2, btScalar(0.09)));
    EXPECT_TRUE(meets(btScalar(1.1), 2, btScalar(0.11)));
    EXPECT_FALSE(meets(0, std::nanf(""), 9));
    const SurfaceBox bounds = surfaceBounds(plane, pose, {btVector3(-9, 0, -9), btVector3(9, 2, 9)});
    EXPECT_NEAR(bounds.m_low.y(), 1, 1e-4);
    EXPECT_NEAR(bounds.m_high.y(), 1, 1e-4);
    EXPECT_LT(bounds.m_low.x(), -1e5);
    EXPECT_GT(bounds.m_high.z(), 1e5);
}
}  // namespace drape::test
