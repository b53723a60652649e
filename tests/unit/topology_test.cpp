// Edges, owners and opposite vertices: closed, open, non-manifold and degenerate meshes.
#include "bullet_plugin/core/scene/topology.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "scenes/cloth_grid.h"
#include "tests/support/cases.h"

namespace drape::test
{
namespace
{
constexpr std::uint32_t kUnused = 0xffffffffu;

Topology topologyOf(const TriangleMesh& mesh)
{
    return buildTopology(mesh.m_triangles.data(), mesh.triangleCount(), mesh.vertexCount());
}

// Checks the invariants of every topology, whatever the mesh.
void expectSound(const Topology& topology)
{
    std::map<std::uint32_t, int> vertexOwners, edgeOwners, edgeUses;
    std::set<std::uint32_t> usedVertices;
    for (std::uint32_t t = 0; t < topology.m_triangles.size(); ++t)
    {
        const Triangle& triangle = topology.m_triangles[t];
        for (int i = 0; i < 3; ++i)
        {
            const std::uint32_t vertex = triangle.m_vertices[i], edge = triangle.m_edges[i];
            usedVertices.insert(vertex);
            ++edgeUses[edge];
            if (triangle.m_owned & DRAPE_OWNS_VERTEX(i))
            {
                ++vertexOwners[vertex];
                EXPECT_EQ(topology.m_vertexTriangle[vertex], t);
            }
            if (triangle.m_owned & DRAPE_OWNS_EDGE(i))
            {
                ++edgeOwners[edge];
                EXPECT_EQ(topology.m_edgeTriangle[edge], t);
            }
            const std::uint32_t next = triangle.m_vertices[(i + 1) % 3];
            ASSERT_LT(edge, topology.m_edges.size());
            const Edge& record = topology.m_edges[edge];
            EXPECT_EQ((std::set<std::uint32_t>{record.m_vertices[0], record.m_vertices[1]}),
                      (std::set<std::uint32_t>{vertex, next}));
        }
    }
    EXPECT_EQ(vertexOwners.size(), usedVertices.size());
    EXPECT_EQ(edgeOwners.size(), topology.m_edges.size());
    for (const auto& owner : vertexOwners)
        EXPECT_EQ(owner.second, 1) << "vertex " << owner.first;
    for (const auto& owner : edgeOwners)
        EXPECT_EQ(owner.second, 1) << "edge " << owner.first;
    for (const auto& uses : edgeUses)
        EXPECT_EQ(topology.m_edgeUses[uses.first], uses.second);
    for (std::uint32_t v = 0; v < topology.m_vertexCount; ++v)
    {
        EXPECT_EQ(topology.m_vertexTriangle[v] == kUnused, usedVertices.count(v) == 0);
    }
}

// Each edge's two opposites are the third vertices of its triangles.
void expectOpposites(const Topology& topology)
{
    std::map<std::uint32_t, std::multiset<std::uint32_t>> thirds;
    for (const Triangle& triangle : topology.m_triangles)
    {
        for (int i = 0; i < 3; ++i)
            thirds[triangle.m_edges[i]].insert(triangle.m_vertices[(i + 2) % 3]);
    }
    for (std::uint32_t e = 0; e < topology.m_edges.size(); ++e)
    {
        std::multiset<std::uint32_t> expected = thirds[e];
        if (expected.size() == 1) expected.insert(*expected.begin());
        if (expected.size() > 2) continue;
        const Edge& edge = topology.m_edges[e];
        EXPECT_EQ((std::multiset<std::uint32_t>{edge.m_opposite[0], edge.m_opposite[1]}), expected) << "edge " << e;
    }
}
}  // namespace

TEST(Topology, ClosedShapesHaveTwoTrianglesAtEveryEdge)
{
    for (const char* name : {"sphere", "box", "torus", "bowl", "stairs"})
    {
        SCOPED_TRACE(name);
        const TriangleMesh mesh = shapeNamed(name);
        const Topology topology = topologyOf(mesh);
        EXPECT_EQ(topology.m_triangles.size(), mesh.triangleCount());
        EXPECT_EQ(topology.m_edges.size() * 2, mesh.triangleCount() * 3);
        expectSound(topology);
        expectOpposites(topology);
        for (std::uint8_t uses : topology.m_edgeUses)
            EXPECT_EQ(uses, 2);
    }
}

TEST(Topology, OpenSheetRepeatsTheOppositeAtItsBorder)
{
    const Topology topology = topologyOf(makeClothGrid(5, 7, 1.0f, 0.0f).m_mesh);
    expectSound(topology);
    expectOpposites(topology);
    std::size_t border = 0;
    for (std::uint32_t e = 0; e < topology.m_edges.size(); ++e)
    {
        const bool open = topology.m_edgeUses[e] == 1;
        border += open;
        EXPECT_EQ(topology.m_edges[e].m_opposite[0] == topology.m_edges[e].m_opposite[1], open);
    }
    EXPECT_EQ(border, 2u * (4 + 6));
}

TEST(Topology, TrianglesThatRepeatAnIndexAreDropped)
{
    const std::int32_t triangles[] = {0, 0, 1, 0, 1, 2, 2, 1, 2, 3, 3, 3, 2, 1, 3};
    const Topology topology = buildTopology(triangles, 5, 5);
    ASSERT_EQ(topology.m_triangles.size(), 2u);
    EXPECT_EQ(topology.m_sourceTriangle, (std::vector<std::uint32_t>{1, 4}));
    EXPECT_EQ(topology.m_edges.size(), 5u);
    EXPECT_EQ(topology.m_vertexTriangle[4], kUnused);
    expectSound(topology);
    expectOpposites(topology);
}

// Any three vertices make one triangle, however often, in whatever order they come and however many share an edge.
TEST(Topology, DuplicateFacesAreDropped)
{
    for (std::uint32_t seed = 700; seed < 720; ++seed)
    {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        std::vector<std::int32_t> triangles;
        std::vector<std::uint32_t> first;
        std::set<std::set<std::int32_t>> distinct;
        // The few vertices give up to 5 triangles at an edge, and each of them several times.
        const std::uint32_t vertices = 4 + random.below(4);
        for (std::uint32_t t = 0; t < 200; ++t)
        {
            for (int i = 0; i < 3; ++i)
                triangles.push_back(std::int32_t(random.below(vertices)));
            const std::set<std::int32_t> corners(triangles.end() - 3, triangles.end());
            if (corners.size() == 3 && distinct.insert(corners).second) first.push_back(t);
        }
        const Topology topology = buildTopology(triangles.data(), 200, vertices);
        EXPECT_EQ(topology.m_sourceTriangle, first);
        expectSound(topology);
    }
}

TEST(Topology, NonManifoldEdgesCountTheirUses)
{
    const std::int32_t fan[] = {0, 1, 2, 1, 0, 3, 0, 1, 4};
    const Topology topology = buildTopology(fan, 3, 5);
    expectSound(topology);
    EXPECT_EQ(topology.m_triangles.size(), 3u);
    EXPECT_EQ(topology.m_edges.size(), 7u);
    EXPECT_EQ(topology.m_edgeUses[topology.m_triangles[0].m_edges[0]], 3);

    std::vector<std::int32_t> many;
    for (int i = 0; i < 400; ++i)
        many.insert(many.end(), {0, 1, 2 + i});
    const Topology crowded = buildTopology(many.data(), 400, 402);
    EXPECT_EQ(crowded.m_edgeUses[0], 255) << "255 stands for more";
}

TEST(Topology, NoTrianglesAndOneTriangle)
{
    const Topology none = buildTopology(nullptr, 0, 3);
    EXPECT_TRUE(none.m_triangles.empty() && none.m_edges.empty());
    EXPECT_EQ(none.m_vertexCount, 3u);
    expectSound(none);
    const std::int32_t triangle[] = {2, 0, 1};
    const Topology one = buildTopology(triangle, 1, 3);
    ASSERT_EQ(one.m_triangles.size(), 1u);
    EXPECT_EQ(one.m_triangles[0].m_owned, 63u);
    expectSound(one);
}

TEST(Topology, DependsOnTheInputAlone)
{
    const TriangleMesh mesh = shapeNamed("torus");
    const Topology a = topologyOf(mesh), b = topologyOf(mesh);
    EXPECT_EQ(a.m_edgeTriangle, b.m_edgeTriangle);
    for (std::size_t i = 0; i < a.m_triangles.size(); ++i)
    {
        ASSERT_EQ(std::memcmp(&a.m_triangles[i], &b.m_triangles[i], sizeof(Triangle)), 0);
    }
}
// The mesh has a triangle, one that has a vertex twice, and two vertices without a triangle.
TEST(Topology, PointsAreOfVerticesWithoutATriangle)
{
    const std::int32_t triangles[] = {0, 1, 2, 3, 3, 0};
    Topology topology = buildTopology(triangles, 2, 6);
    ASSERT_EQ(topology.m_triangles.size(), 1u);
    addPoints(topology);
    ASSERT_EQ(topology.m_triangles.size(), 4u);
    EXPECT_EQ(topology.m_edges.size(), 6u);
    for (std::uint32_t i = 0; i < 3; ++i)
    {
        const Triangle& point = topology.m_triangles[1 + i];
        for (int k = 0; k < 3; ++k)
        {
            EXPECT_EQ(point.m_vertices[k], 3 + i);
            EXPECT_EQ(point.m_edges[k], 3 + i);
        }
        EXPECT_EQ(point.m_owned, DRAPE_OWNS_VERTEX(0));
        EXPECT_EQ(topology.m_vertexTriangle[3 + i], 1 + i);
        EXPECT_EQ(topology.m_sourceTriangle[1 + i], kUnused);
    }
    addPoints(topology);
    EXPECT_EQ(topology.m_triangles.size(), 4u) << "each has its own";
}

// The mesh is a triangle with edges: a chain that hangs from it, an edge between two of its vertices, one that is given
// twice, and one from a vertex to itself.
TEST(Topology, EdgesWithoutATriangleAreTrianglesWithoutArea)
{
    const std::int32_t triangles[] = {0, 1, 2};
    const std::int32_t edges[] = {2, 3, 1, 0, 3, 4, 4, 3, 3, 3};
    Topology topology = buildTopology(triangles, 1, 6);
    addEdges(topology, edges, 5);
    ASSERT_EQ(topology.m_triangles.size(), 3u);
    EXPECT_EQ(topology.m_faceCount, 1u);
    ASSERT_EQ(topology.m_edges.size(), 5u);
    const std::uint32_t ends[2][2] = {{2, 3}, {3, 4}};
    for (std::uint32_t i = 0; i < 2; ++i)
    {
        const Triangle& segment = topology.m_triangles[1 + i];
        const std::uint32_t vertices[3] = {ends[i][0], ends[i][1], ends[i][1]};
        for (int k = 0; k < 3; ++k)
        {
            EXPECT_EQ(segment.m_vertices[k], vertices[k]);
            EXPECT_EQ(segment.m_edges[k], 3 + i);
        }
        EXPECT_EQ(segment.m_owned, DRAPE_OWNS_EDGE(0) | DRAPE_OWNS_VERTEX(1)) << "the first has an owner already";
        EXPECT_EQ(topology.m_edges[3 + i].m_vertices[0], ends[i][0]);
        EXPECT_EQ(topology.m_edges[3 + i].m_vertices[1], ends[i][1]);
        EXPECT_EQ(topology.m_edgeTriangle[3 + i], 1 + i);
        EXPECT_EQ(topology.m_vertexTriangle[ends[i][1]], 1 + i);
        EXPECT_EQ(topology.m_sourceTriangle[1 + i], kUnused);
    }
    addPoints(topology);
    ASSERT_EQ(topology.m_triangles.size(), 4u) << "only the last vertex is left";
    EXPECT_EQ(topology.m_triangles[3].m_vertices[0], 5u);
}
}  // namespace drape::test
