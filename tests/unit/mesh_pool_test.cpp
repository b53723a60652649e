// The mesh pool: ids, joined arrays, removal.
#include "bullet_plugin/core/scene/mesh_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
PooledMesh pooled(MeshId id, const TriangleMesh& mesh)
{
    PooledMesh result;
    result.m_id = id;
    result.m_topology = buildTopology(mesh.m_triangles.data(), mesh.triangleCount(), mesh.vertexCount());
    result.m_positions = mesh.m_positions;
    result.m_order.resize(result.m_topology.m_triangles.size());
    std::iota(result.m_order.rbegin(), result.m_order.rend(), 0u);
    return result;
}

void expectJoined(const MeshPool& pool)
{
    std::uint32_t vertex = 0, triangle = 0, edge = 0;
    for (std::size_t slot = 0; slot < pool.meshCount(); ++slot)
    {
        const PooledMesh& mesh = pool.mesh(slot);
        EXPECT_EQ(pool.slot(mesh.m_id), mesh.m_vacant ? pool.meshCount() : slot);
        EXPECT_EQ(mesh.m_firstVertex, vertex);
        EXPECT_EQ(mesh.m_firstTriangle, triangle);
        EXPECT_EQ(mesh.m_firstEdge, edge);
        for (std::size_t t = 0; t < mesh.m_topology.m_triangles.size(); ++t)
        {
            const Triangle &joined = pool.triangles()[triangle + t], &local = mesh.m_topology.m_triangles[t];
            EXPECT_EQ(joined.m_mesh, slot);
            EXPECT_EQ(joined.m_owned, local.m_owned);
            for (int i = 0; i < 3; ++i)
            {
                EXPECT_EQ(joined.m_vertices[i], local.m_vertices[i] + vertex);
                EXPECT_EQ(joined.m_edges[i], local.m_edges[i] + edge);
                EXPECT_EQ(pool.slotOfVertex(joined.m_vertices[i]), slot);
                EXPECT_EQ(pool.slotOfEdge(joined.m_edges[i]), slot);
            }
        }
        for (std::size_t e = 0; e < mesh.m_topology.m_edges.size(); ++e)
        {
            EXPECT_EQ(pool.edges()[edge + e].m_opposite[1], mesh.m_topology.m_edges[e].m_opposite[1] + vertex);
        }
        vertex += std::uint32_t(mesh.m_topology.m_vertexCount);
        triangle += std::uint32_t(mesh.m_topology.m_triangles.size());
        edge += std::uint32_t(mesh.m_topology.m_edges.size());
    }
    EXPECT_EQ(pool.vertexCount(), vertex);
    EXPECT_EQ(pool.triangles().size(), triangle);
    EXPECT_EQ(pool.edges().size(), edge);
}
}  // namespace

TEST(MeshPool, JoinsMeshesEndToEnd)
{
    MeshPool pool;
    pool.add(pooled(3, shapeNamed("box")));
    pool.add(pooled(5, shapeNamed("sphere")));
    pool.add(pooled(9, looseTriangles({0, 0, 0, 1, 0, 0, 0, 1, 0})));
    pool.update();
    EXPECT_EQ(pool.meshCount(), 3u);
    expectJoined(pool);
}

TEST(MeshPool, KeepsIdsWhenOthersGo)
{
    MeshPool pool;
    for (MeshId id : {0u, 2u, 4u, 7u})
        pool.add(pooled(id, shapeNamed("box")));
    pool.update();
    EXPECT_TRUE(pool.remove(2));
    EXPECT_FALSE(pool.remove(2));
    EXPECT_FALSE(pool.remove(3));
    EXPECT_FALSE(pool.remove(kNoMesh));
    pool.update();
    EXPECT_EQ(pool.slot(0), 0u);
    EXPECT_EQ(pool.slot(4), 2u) << "its slot, too";
    EXPECT_EQ(pool.slot(7), 3u);
    EXPECT_EQ(pool.slot(2), pool.meshCount()) << "gone";
    EXPECT_TRUE(pool.mesh(1).m_vacant);
    EXPECT_EQ(pool.slot(100), pool.meshCount());
    EXPECT_EQ(pool.presentTriangles(), 36u);
    expectJoined(pool);
    pool.add(pooled(8, shapeNamed("torus")));
    pool.update();
    EXPECT_EQ(pool.slot(8), 4u);
    expectJoined(pool);
    pool.remove(8);
    EXPECT_EQ(pool.meshCount(), 5u) << "until places are taken anew";
    pool.update();
    EXPECT_EQ(pool.meshCount(), 3u) << "more was vacant than there";
    EXPECT_EQ(pool.slot(4), 1u);
    expectJoined(pool);
}

// Users of the joined arrays must read these slots again.
TEST(MeshPool, TellsFromWhichSlotOnPlacesAreNew)
{
    MeshPool pool;
    for (MeshId id : {0u, 1u, 2u, 3u})
        pool.add(pooled(id, shapeNamed("box")));
    pool.update();
    EXPECT_EQ(pool.firstSince(0), 0u);
    const std::uint32_t four = pool.revision();
    EXPECT_EQ(pool.firstSince(four), 4u);
    EXPECT_EQ(pool.begin(4).m_triangle, pool.triangles().size());

    pool.remove(3);
    pool.update();
    EXPECT_EQ(pool.revision(), four) << "a vacancy changes nothing";
    pool.add(pooled(4, shapeNamed("sphere")));
    pool.update();
    EXPECT_EQ(pool.slot(4), 3u) << "a mesh that comes takes the place of the last that went";
    EXPECT_EQ(pool.firstSince(four), 3u);
    EXPECT_EQ(pool.begin(3).m_triangle, 36u);
    const std::uint32_t sphere = pool.revision();
    expectJoined(pool);
    pool.add(pooled(5, shapeNamed("box")));
    pool.update();
    EXPECT_EQ(pool.firstSince(sphere), 4u);
    expectJoined(pool);

    pool.remove(1);
    pool.remove(4);
    pool.update();
    EXPECT_EQ(pool.firstSince(sphere), 1u) << "those behind the first that went have moved up";
    EXPECT_EQ(pool.meshCount(), 3u);
    expectJoined(pool);
}

// Meshes of a few triangles that come and go beside a large one.
TEST(MeshPool, VacantSlotsStayFew)
{
    MeshPool pool;
    pool.add(pooled(0, shapeNamed("sphere")));
    pool.update();
    MeshId next = 1;
    std::size_t most = 0;
    for (int round = 0; round < 300; ++round)
    {
        pool.add(pooled(next, shapeNamed("box")));
        pool.add(pooled(next + 1, shapeNamed("box")));
        pool.update();
        pool.remove(next);
        next += 2;
        most = std::max(most, pool.meshCount());
        if (round >= 10) pool.remove(next - 21);
    }
    EXPECT_LT(most, 100u);
    EXPECT_EQ(pool.firstSince(1), 1u) << "the large one kept its place";
    pool.update();
    expectJoined(pool);
}

TEST(MeshPool, RevisionCountsChangesOnly)
{
    MeshPool pool;
    const std::uint32_t first = pool.revision();
    pool.update();
    EXPECT_EQ(pool.revision(), first);
    pool.add(pooled(0, shapeNamed("box")));
    pool.add(pooled(1, shapeNamed("box")));
    pool.update();
    EXPECT_EQ(pool.revision(), first + 1);
    pool.update();
    EXPECT_EQ(pool.revision(), first + 1);
    pool.remove(0);
    pool.update();
    EXPECT_EQ(pool.revision(), first + 1) << "as many are there as not";
    pool.remove(1);
    pool.update();
    EXPECT_EQ(pool.revision(), first + 2);
}

TEST(MeshPool, EmptyMeshesAndEmptyPools)
{
    MeshPool pool;
    pool.update();
    EXPECT_EQ(pool.meshCount() + pool.vertexCount() + pool.triangles().size(), 0u);
    pool.add(pooled(0, TriangleMesh()));
    pool.add(pooled(1, shapeNamed("box")));
    pool.add(pooled(2, TriangleMesh()));
    pool.update();
    expectJoined(pool);
    pool.remove(1);
    pool.update();
    EXPECT_EQ(pool.triangles().size(), 0u);
    EXPECT_EQ(pool.meshCount(), 2u);
}
}  // namespace drape::test
