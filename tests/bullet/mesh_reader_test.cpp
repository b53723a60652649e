// Bullet's mesh formats give equal triangles: types and strides of vertices and indices, parts, wrong counts.
#include "bullet_plugin/adapter/mirrors/mesh_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h"
#include "BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h"
#include "scenes/shapes.h"

namespace drape::test
{
namespace
{
constexpr std::size_t kPadding = 5;  // bytes behind each vertex and each triangle's indices

template <typename T>
std::vector<unsigned char> strided(const std::vector<T>& values)
{
    const std::size_t row = 3 * sizeof(T), stride = row + kPadding;
    std::vector<unsigned char> bytes(values.size() / 3 * stride, 0xcd);
    for (std::size_t i = 0; i < values.size() / 3; ++i)
        std::memcpy(&bytes[i * stride], &values[3 * i], row);
    return bytes;
}

template <typename To, typename From>
std::vector<To> as(const std::vector<From>& values)
{
    return std::vector<To>(values.begin(), values.end());
}

// Arrays of one part and what says how they are laid out.
struct Part
{
    std::vector<unsigned char> m_vertices, m_indices;
    btIndexedMesh m_layout;
    PHY_ScalarType m_indexType = PHY_INTEGER;

    template <typename Real, typename Index>
    static Part make(const TriangleMesh& mesh, PHY_ScalarType vertexType, PHY_ScalarType indexType)
    {
        Part part;
        part.m_vertices = strided(as<Real>(mesh.m_positions));
        part.m_indices = strided(as<Index>(mesh.m_triangles));
        part.m_layout.m_numVertices = int(mesh.vertexCount());
        part.m_layout.m_vertexStride = int(3 * sizeof(Real) + kPadding);
        part.m_layout.m_vertexType = vertexType;
        part.m_layout.m_numTriangles = int(mesh.triangleCount());
        part.m_layout.m_triangleIndexStride = int(3 * sizeof(Index) + kPadding);
        part.m_indexType = indexType;
        return part;
    }
    void addTo(btTriangleIndexVertexArray& arrays, const Part& verticesOf)
    {
        m_layout.m_triangleIndexBase = m_indices.data();
        m_layout.m_vertexBase = verticesOf.m_vertices.data();
        arrays.addIndexedMesh(m_layout, m_indexType);
    }
};

Part plainPart(const TriangleMesh& mesh)
{
    return Part::make<float, std::int32_t>(mesh, PHY_FLOAT, PHY_INTEGER);
}

// The shape's box is given, so that Bullet itself reads nothing.
WorldMesh read(btTriangleIndexVertexArray& arrays, std::uint64_t* signature = nullptr)
{
    arrays.setPremadeAabb(btVector3(-9, -9, -9), btVector3(9, 9, 9));
    const btBvhTriangleMeshShape shape(&arrays, true, false);
    WorldMesh mesh;
    readMesh(shape, btTransform::getIdentity(), ReadPart(), mesh);
    if (signature) *signature = meshSignature(shape, ReadPart());
    return mesh;
}

WorldMesh read(Part part, std::uint64_t* signature = nullptr)
{
    btTriangleIndexVertexArray arrays;
    part.addTo(arrays, part);
    return read(arrays, signature);
}

void expectSame(const WorldMesh& read, const TriangleMesh& mesh)
{
    EXPECT_EQ(read.m_triangles, mesh.m_triangles);
    EXPECT_EQ(read.m_positions, mesh.m_positions);
}
}  // namespace

TEST(MeshReader, EveryTypeAndStrideGivesTheSameMesh)
{
    const TriangleMesh mesh = makeSphere(1.0f, 2);
    ASSERT_LT(mesh.vertexCount(), 256u);
    expectSame(read(plainPart(mesh)), mesh);
    expectSame(read(Part::make<float, std::uint16_t>(mesh, PHY_FLOAT, PHY_SHORT)), mesh);
    expectSame(read(Part::make<float, std::uint8_t>(mesh, PHY_FLOAT, PHY_UCHAR)), mesh);
    expectSame(read(Part::make<double, std::int32_t>(mesh, PHY_DOUBLE, PHY_INTEGER)), mesh);
    expectSame(read(Part::make<double, std::uint8_t>(mesh, PHY_DOUBLE, PHY_UCHAR)), mesh);
}

TEST(MeshReader, AFilterLeavesTrianglesOfAPartOut)
{
    const TriangleMesh mesh = makeBox(1.0f, 2.0f, 3.0f);
    Part parts[2] = {plainPart(mesh), plainPart(mesh)};
    btTriangleIndexVertexArray arrays;
    for (Part& part : parts)
        part.addTo(arrays, part);
    arrays.setPremadeAabb(btVector3(-9, -9, -9), btVector3(9, 9, 9));
    const btBvhTriangleMeshShape shape(&arrays, true, false);
    const TriangleFilter filter = [](int part, int triangle) { return part == 0 || triangle < 2; };
    WorldMesh read;
    readMesh(shape, btTransform::getIdentity(), {{}, &filter}, read);
    ASSERT_EQ(read.m_triangles.size(), mesh.m_triangles.size() + 6);
    EXPECT_TRUE(std::equal(mesh.m_triangles.begin(), mesh.m_triangles.end(), read.m_triangles.begin()));
    EXPECT_EQ(read.m_triangles.back(), mesh.m_triangles[5] + int(mesh.vertexCount()));
}

TEST(MeshReader, ScalingAndPoseAreApplied)
{
    const TriangleMesh mesh = makeBox(1.0f, 2.0f, 3.0f);
    Part part = plainPart(mesh);
    btTriangleIndexVertexArray arrays;
    part.addTo(arrays, part);
    arrays.setScaling(btVector3(2, 1, 1));
    const btBvhTriangleMeshShape shape(&arrays, true, false);
    WorldMesh moved;
    readMesh(shape, btTransform(btQuaternion::getIdentity(), btVector3(0, 5, 0)), ReadPart(), moved);
    ASSERT_EQ(moved.m_positions.size(), mesh.m_positions.size());
    for (std::size_t i = 0; i < mesh.m_positions.size(); i += 3)
    {
        EXPECT_EQ(moved.m_positions[i], 2 * mesh.m_positions[i]);
        EXPECT_EQ(moved.m_positions[i + 1], 5 + mesh.m_positions[i + 1]);
        EXPECT_EQ(moved.m_positions[i + 2], mesh.m_positions[i + 2]);
    }
}

// Bullet never reads the number of vertices, so apps may pass any.
TEST(MeshReader, TheStatedNumberOfVerticesDoesNotMatter)
{
    const TriangleMesh mesh = makeSphere(1.0f, 1);
    for (const int stated : {0, 1, int(mesh.vertexCount()) - 1, int(mesh.vertexCount()) + 100})
    {
        SCOPED_TRACE(stated);
        Part part = plainPart(mesh);
        part.m_layout.m_numVertices = stated;
        expectSame(read(part), mesh);
    }
}

// Exporters cut one mesh into parts by material, all with the whole array of vertices.
TEST(MeshReader, PartsOfOneArrayReadOnlyTheirVertices)
{
    const TriangleMesh mesh = makeSphere(1.0f, 2);
    constexpr std::size_t kParts = 8;
    ASSERT_EQ(mesh.triangleCount() % kParts, 0u);
    const std::size_t share = mesh.m_triangles.size() / kParts;
    std::vector<Part> parts;
    for (std::size_t p = 0; p < kParts; ++p)
    {
        TriangleMesh piece = mesh;
        piece.m_triangles.assign(mesh.m_triangles.begin() + std::ptrdiff_t(p * share),
                                 mesh.m_triangles.begin() + std::ptrdiff_t((p + 1) * share));
        parts.push_back(plainPart(piece));
    }
    btTriangleIndexVertexArray arrays;
    for (Part& part : parts)
        part.addTo(arrays, parts[0]);
    const WorldMesh whole = read(arrays);
    ASSERT_EQ(whole.m_triangles.size(), mesh.m_triangles.size());
    for (std::size_t i = 0; i < mesh.m_triangles.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_EQ(whole.m_positions[3 * std::size_t(whole.m_triangles[i]) + axis],
                      mesh.m_positions[3 * std::size_t(mesh.m_triangles[i]) + axis]);
    EXPECT_GE(whole.m_positions.size(), mesh.m_positions.size());
    EXPECT_LT(whole.m_positions.size(), 2 * mesh.m_positions.size());
}

TEST(MeshReader, TrianglesThatCannotBeReadAreLeftOut)
{
    TriangleMesh mesh = makeBox(1.0f, 1.0f, 1.0f);
    const std::size_t triangles = mesh.triangleCount();
    mesh.m_triangles[4] = -1;
    EXPECT_EQ(read(plainPart(mesh)).m_triangles.size(), 3 * (triangles - 1));

    mesh = makeBox(1.0f, 1.0f, 1.0f);
    const std::int32_t invalid = mesh.m_triangles[0];
    std::size_t around = 0;
    for (std::size_t t = 0; t < triangles; ++t)
        for (std::size_t k = 0; k < 3; ++k)
            around += mesh.m_triangles[3 * t + k] == invalid;
    for (const float value : {std::nanf(""), std::numeric_limits<float>::infinity()})
    {
        mesh.m_positions[3 * std::size_t(invalid)] = value;
        const WorldMesh left = read(plainPart(mesh));
        EXPECT_EQ(left.m_triangles.size(), 3 * (triangles - around));
        for (const float coordinate : left.m_positions)
            EXPECT_TRUE(std::isfinite(coordinate));
    }

    mesh.m_triangles.clear();
    EXPECT_TRUE(read(plainPart(mesh)).m_positions.empty());
}

// Parts whose indices are far apart are read by their indices, others by the stretch that they span.
TEST(MeshReader, ScatteredIndicesGiveTheSameMesh)
{
    const TriangleMesh box = makeBox(1.0f, 2.0f, 3.0f);
    constexpr std::size_t kApart = 1000;
    TriangleMesh scattered;
    scattered.m_positions.assign(3 * kApart * box.vertexCount(), 0);
    for (std::size_t i = 0; i < box.vertexCount(); ++i)
        std::copy_n(&box.m_positions[3 * i], 3, &scattered.m_positions[3 * kApart * i]);
    for (const std::int32_t index : box.m_triangles)
        scattered.m_triangles.push_back(index * std::int32_t(kApart));
    expectSame(read(plainPart(scattered)), box);
}

TEST(MeshReader, AnyVertexOfASmallMeshMovedInPlaceChangesTheSignature)
{
    TriangleMesh quad;
    quad.m_positions = {0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1};
    quad.m_triangles = {0, 1, 2, 0, 2, 3};
    for (const TriangleMesh& mesh : {quad, makeBox(1.0f, 1.0f, 1.0f)})
        for (const int stated : {0, int(mesh.vertexCount())})
            for (std::size_t moved = 0; moved < mesh.vertexCount(); ++moved)
            {
                Part part = plainPart(mesh);
                part.m_layout.m_numVertices = stated;
                btTriangleIndexVertexArray arrays;
                part.addTo(arrays, part);
                std::uint64_t before, same, after;
                read(arrays, &before);
                read(arrays, &same);
                const float y = mesh.m_positions[3 * moved + 1] - 3;
                std::memcpy(&part.m_vertices[moved * std::size_t(part.m_layout.m_vertexStride) + sizeof y], &y,
                            sizeof y);
                read(arrays, &after);
                EXPECT_EQ(before, same);
                EXPECT_NE(before, after) << "vertex " << moved << " of " << mesh.vertexCount();
            }
}

TEST(MeshReader, ALargeMeshMovedInPlaceChangesTheSignature)
{
    TriangleMesh mesh = makeSphere(1.0f, 5);
    ASSERT_GT(mesh.triangleCount(), 1000u);
    std::uint64_t before, after;
    btTriangleIndexVertexArray arrays;
    Part part = plainPart(mesh);
    part.addTo(arrays, part);
    read(arrays, &before);
    for (std::size_t i = 0; i < mesh.vertexCount(); ++i)
        part.m_vertices[i * std::size_t(part.m_layout.m_vertexStride)] ^= 1;
    read(arrays, &after);
    EXPECT_NE(before, after);
}
}  // namespace drape::test
