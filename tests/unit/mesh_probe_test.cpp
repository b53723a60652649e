// MeshProbe: inside and outside whatever the winding, the nearest place, and which triangles meet.
#include "bullet_plugin/core/probe/mesh_probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/lib/geometry/closest.h"
#include "scenes/random.h"
#include "scenes/shapes.h"

namespace drape::test
{
namespace
{
MeshProbe probeOf(const TriangleMesh& mesh)
{
    MeshDescription description;
    description.m_triangles = mesh.m_triangles.data();
    description.m_triangleCount = mesh.triangleCount();
    description.m_positions = mesh.m_positions.data();
    description.m_vertexCount = mesh.vertexCount();
    return MeshProbe(description);
}

Vec3 randomPlace(Random& random, float size)
{
    const auto coordinate = [&] { return float(random.within(-0.5, 0.5)) * size; };
    const float x = coordinate(), y = coordinate(), z = coordinate();
    return vec3(x, y, z);
}
}  // namespace

TEST(MeshProbe, InsideOfABoxIsInsideWhateverTheWinding)
{
    TriangleMesh mesh = makeBox(1, 1, 1);
    Random random(1);
    for (int turned = 0; turned < 3; ++turned)
    {
        MeshProbe probe = probeOf(mesh);
        EXPECT_TRUE(probe.isClosed());
        for (int i = 0; i < 2000; ++i)
        {
            const Vec3 p = randomPlace(random, 2);
            const bool inside = std::max(std::fabs(p.x), std::max(std::fabs(p.y), std::fabs(p.z))) < 0.5f;
            ASSERT_EQ(probe.isInside(p), inside) << p.x << " " << p.y << " " << p.z;
        }
        // The points are on lines through corners and edges, where a ray along an axis would meet them.
        EXPECT_TRUE(probe.isInside(vec3(0, 0, 0)));
        EXPECT_FALSE(probe.isInside(vec3(0.75f, 0.5f, 0.5f)));
        for (std::size_t t = std::size_t(turned); t < mesh.triangleCount(); t += 2)
            std::swap(mesh.m_triangles[3 * t], mesh.m_triangles[3 * t + 1]);
    }
}

TEST(MeshProbe, VerticesAtOnePositionAreOneForClosedness)
{
    const TriangleMesh sphere = makeSphere(1, 2);
    TriangleMesh loose;  // every triangle with vertices of its own
    for (const std::int32_t index : sphere.m_triangles)
    {
        loose.m_triangles.push_back(std::int32_t(loose.m_triangles.size()));
        for (int axis = 0; axis < 3; ++axis)
            loose.m_positions.push_back(sphere.m_positions[3 * std::size_t(index) + std::size_t(axis)]);
    }
    MeshProbe probe = probeOf(loose);
    EXPECT_TRUE(probe.isClosed());
    EXPECT_TRUE(probe.isInside(vec3(0.3f, 0.2f, 0.1f)));
    EXPECT_NEAR(probe.volume(), probeOf(sphere).volume(), 1e-6);
    EXPECT_GT(probe.volume(), 3.5);
    loose.m_triangles.resize(loose.m_triangles.size() - 3);
    EXPECT_FALSE(probeOf(loose).isClosed());
    EXPECT_FALSE(probeOf(makeTerrain(2, 0.1f, 8, 1)).isClosed());
}

// Simulates spheres of apps: sines and cosines of a full turn are off by rounding, at the seam and at both poles.
TEST(MeshProbe, SeamsOffByRoundingAreClosed)
{
    constexpr int kSteps = 32;
    const double pi = std::acos(-1.0);
    for (const double size : {0.01, 1.0, 1000.0})
    {
        const auto at = [&](int i, int j)
        {
            const double a = 2 * pi * i / kSteps, b = pi * j / kSteps;
            return vec3(float(size * std::cos(a) * std::sin(b)), float(size * std::cos(b)),
                        float(size * std::sin(a) * std::sin(b)));
        };
        TriangleMesh mesh;
        const auto add = [&](const Vec3& corner)
        {
            mesh.m_triangles.push_back(std::int32_t(mesh.m_triangles.size()));
            mesh.m_positions.insert(mesh.m_positions.end(), {corner.x, corner.y, corner.z});
        };
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; j < kSteps; ++j)
                for (const Vec3& corner :
                     {at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)})
                    add(corner);
        // Volatile, so that the compiler does not compute what the mesh has from the run time's functions.
        volatile int last = kSteps, first = 1;
        const float seam = at(last, first).z;
        ASSERT_NE(at(0, 1).z, seam) << "the seam is exact here";
        MeshProbe probe = probeOf(mesh);
        EXPECT_TRUE(probe.isClosed()) << size;
        Random random(7);
        for (int i = 0; i < 500; ++i)
        {
            const Vec3 p = randomPlace(random, float(3 * size));
            const double distance = std::sqrt(double(p.x) * p.x + double(p.y) * p.y + double(p.z) * p.z) / size;
            if (distance < 0.98 || distance > 1)
            {
                ASSERT_EQ(probe.isInside(p), distance < 1) << distance;
            }
        }
        // The gap is larger than rounding.
        for (float& z : mesh.m_positions)
            if (z == seam) z += float(1e-4 * size);
        EXPECT_FALSE(probeOf(mesh).isClosed()) << size;
    }
}

TEST(MeshProbe, NearestIsAsNearAsTheNearestOfAllTriangles)
{
    const TriangleMesh mesh = makeTorus(1, 0.3f, 24, 12);
    const MeshProbe probe = probeOf(mesh);
    const auto corner = [&](std::size_t index)
    { return vec3Load(mesh.m_positions.data(), std::uint32_t(mesh.m_triangles[index])); };
    Random random(2);
    for (int i = 0; i < 500; ++i)
    {
        const Vec3 p = randomPlace(random, 4);
        float least = 1e9f;
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        {
            const Vec3 a = corner(3 * t), b = corner(3 * t + 1), c = corner(3 * t + 2);
            const Vec3 place = trianglePoint(a, b, c, closestOnTriangle(p, a, b, c));
            least = std::min(least, vec3Length(vec3Sub(place, p)));
        }
        ASSERT_NEAR(vec3Length(vec3Sub(probe.nearest(p), p)), least, 1e-5f);
        MeshProbe::Place place;
        ASSERT_FALSE(probe.nearestWithin(p, 0.99f * least, place));
        ASSERT_TRUE(probe.nearestWithin(p, 1.01f * least, place));
        ASSERT_NEAR(place.m_distance, least, 1e-5f);
    }
}

TEST(MeshProbe, APointGoesWithThePlaceThatItIsNearest)
{
    const TriangleMesh mesh = makeSphere(1, 2);
    MeshProbe probe = probeOf(mesh);
    std::vector<float> turned;  // by a quarter about z, and moved by (1, 2, 3)
    for (std::size_t i = 0; i < mesh.vertexCount(); ++i)
    {
        const float* const p = &mesh.m_positions[3 * i];
        turned.insert(turned.end(), {1 - p[1], 2 + p[0], 3 + p[2]});
    }
    EXPECT_NEAR(probe.mostMotion(turned), std::sqrt(14.0f), 1.5f);
    Random random(3);
    for (int i = 0; i < 200; ++i)
    {
        const Vec3 p = randomPlace(random, 3);
        MeshProbe::Place place;
        ASSERT_TRUE(probe.nearestWithin(p, 10, place));
        const Vec3 there = probe.carriedWith(place, p, turned);
        ASSERT_NEAR(vec3Length(vec3Sub(there, vec3(1 - p.y, 2 + p.x, 3 + p.z))), 0, 1e-5f);
    }
    probe.move(turned);
    EXPECT_TRUE(probe.isInside(vec3(1, 2, 3)));
    EXPECT_FALSE(probe.isInside(vec3(0, 0, 0)));
}

TEST(MeshProbe, ListsTrianglesThatMeetAndTheMiddleOfWhereTheyDo)
{
    const MeshProbe probe = probeOf(makeBox(1, 1, 1));
    const Vec3 through[3] = {vec3(0.2f, 0, -0.1f), vec3(0.2f, 1, -0.1f), vec3(0.2f, 1, 0.1f)};
    std::vector<std::uint32_t> triangles;
    probe.listMeeting(through, triangles);
    ASSERT_FALSE(triangles.empty());
    Vec3 middle;
    ASSERT_TRUE(probe.middleOfMeeting(through, triangles, middle));
    EXPECT_NEAR(middle.y, 0.5f, 1e-6f);
    EXPECT_GT(probe.sumOfNormals(triangles, through[1]).y, 0);
    const Vec3 beside[3] = {vec3(0.6f, 0, 0), vec3(0.6f, 1, 0), vec3(0.6f, 1, 0.1f)};
    probe.listMeeting(beside, triangles);
    EXPECT_TRUE(triangles.empty());
    EXPECT_FALSE(probe.middleOfMeeting(beside, triangles, middle));
}

TEST(MeshProbe, PointsLeaveTheBoxOnTheShortestWay)
{
    const MeshProbe probe = probeOf(makeBox(1, 2, 3));
    EXPECT_EQ(probe.directionOutOfBox({vec3(0.4f, 0.1f, 0), vec3(0.6f, 0, 0)}).x, 1.0f);
    EXPECT_EQ(probe.directionOutOfBox({vec3(0, -0.9f, 0), vec3(0.1f, -1.5f, 0)}).y, -1.0f);
}
}  // namespace drape::test
