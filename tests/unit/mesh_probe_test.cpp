// What lies where beside a mesh: inside and outside whatever the winding, the nearest place, and which triangles meet.
#include "bullet_plugin/core/queries/mesh_probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/lib/vec3.h"
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
        // On lines through corners and edges, where a ray along an axis would run into them.
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

TEST(MeshProbe, NearestIsAsNearAsTheNearestOfAllTriangles)
{
    const TriangleMesh mesh = makeTorus(1, 0.3f, 24, 12);
    const MeshProbe probe = probeOf(mesh);
    Random random(2);
    for (int i = 0; i < 500; ++i)
    {
        const Vec3 p = randomPlace(random, 4);
        const float aside = std::sqrt(p.x * p.x + p.z * p.z) - 1;
        const float toTube = std::fabs(std::sqrt(aside * aside + p.y * p.y) - 0.3f);
        EXPECT_NEAR(vec3Length(vec3Sub(probe.nearest(p), p)), toTube, 0.02f);
    }
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
    EXPECT_EQ(probe.wayOutOfBox({vec3(0.4f, 0.1f, 0), vec3(0.6f, 0, 0)}).x, 1.0f);
    EXPECT_EQ(probe.wayOutOfBox({vec3(0, -0.9f, 0), vec3(0.1f, -1.5f, 0)}).y, -1.0f);
}
}  // namespace drape::test
