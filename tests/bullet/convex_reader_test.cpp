// Meshes of Bullet's convex shapes.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_plugin/adapter/mirrors/convex_reader.h"
#include "bullet_plugin/adapter/mirrors/mesh_reader.h"

namespace drape::test
{
namespace
{
// A sixth of the determinant, summed over the triangles: positive if they are outward.
double volumeOf(const WorldMesh& mesh)
{
    double volume = 0;
    for (std::size_t i = 0; i < mesh.m_triangles.size(); i += 3)
    {
        double p[3][3];
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                p[k][axis] = double(mesh.m_positions[3 * std::size_t(mesh.m_triangles[i + k]) + axis]);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
            volume += p[0][axis] * (p[1][b] * p[2][c] - p[1][c] * p[2][b]) / 6;
        }
    }
    return volume;
}

WorldMesh meshOfShape(const btCollisionShape& shape)
{
    WorldMesh mesh;
    readMesh(shape, btTransform::getIdentity(), ReadPart(), mesh);
    return mesh;
}

// Every edge has one triangle on either side.
void expectClosed(const WorldMesh& mesh)
{
    std::vector<std::pair<int, int>> edges;
    for (std::size_t i = 0; i < mesh.m_triangles.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            edges.emplace_back(mesh.m_triangles[i + k], mesh.m_triangles[i + (k + 1) % 3]);
    for (const auto& edge : edges)
        EXPECT_EQ(std::count(edges.begin(), edges.end(), std::make_pair(edge.second, edge.first)), 1);
}
}  // namespace

TEST(ConvexReader, MeshesAreClosedAndHaveTheShapesVolume)
{
    btBoxShape box(btVector3(1, 2, 3));
    btSphereShape ball(2);
    btCapsuleShapeX capsule(1, 3);
    btCylinderShapeZ cylinder(btVector3(1, 1, 2));
    btConeShape cone(1, 3);
    btConvexHullShape hull;
    for (const btVector3& point : {btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0), btVector3(0, 0, 1),
                                   btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1))})
        hull.addPoint(point);
    hull.setLocalScaling(btVector3(2, 1, 1));
    btTriangleMesh triangles;
    triangles.addTriangle(btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 1, 0));
    triangles.addTriangle(btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 0, 1));
    btConvexTriangleMeshShape convexMesh(&triangles);
    const double pi = 3.14159265358979;
    const struct
    {
        const btCollisionShape* m_shape;
        double m_volume, m_lacks;  // share that flat sides may lack of the volume
    } rows[] = {{&box, 48, 1e-6},  {&ball, 32 * pi / 3, 0.03}, {&capsule, 13 * pi / 3, 0.03}, {&cylinder, 4 * pi, 0.01},
                {&cone, pi, 0.01}, {&hull, 1.0 / 3, 1e-6},     {&convexMesh, 1.0 / 6, 1e-6}};
    for (const auto& row : rows)
    {
        SCOPED_TRACE(row.m_shape->getName());
        ASSERT_TRUE(isReadable(*row.m_shape));
        EXPECT_FALSE(isMeshShape(*row.m_shape));
        const WorldMesh mesh = meshOfShape(*row.m_shape);
        expectClosed(mesh);
        EXPECT_LE(volumeOf(mesh), row.m_volume * (1 + 1e-6));
        EXPECT_GE(volumeOf(mesh), row.m_volume * (1 - row.m_lacks - 1e-6));
    }
    EXPECT_EQ(meshMargin(hull), hull.getMargin());
    EXPECT_EQ(meshMargin(cone), cone.getMargin());
    EXPECT_EQ(meshMargin(box), 0);
    EXPECT_EQ(meshMargin(ball), 0);
}

TEST(ConvexReader, TheSignatureChangesWithTheSurface)
{
    btSphereShape ball(1);
    const std::uint64_t before = meshSignature(ball, ReadPart());
    EXPECT_EQ(meshSignature(ball, ReadPart()), before);
    ball.setUnscaledRadius(2);
    EXPECT_NE(meshSignature(ball, ReadPart()), before);
}
}  // namespace drape::test
