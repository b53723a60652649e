// Normal cones hold the normals around their feature and no more than two degrees besides; open surroundings admit all.
#include "bullet_plugin/core/scene/normal_cones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "kernels/lib/narrow_phase/feature_contact.h"
#include "scenes/cloth_grid.h"
#include "tests/support/cases.h"
#include "tests/support/oracle.h"

namespace drape::test
{
namespace
{
struct Cones
{
    Topology m_topology;
    std::vector<NormalCone> m_vertices, m_edges;
    SurfaceCones m_true;
};

Cones conesOf(const TriangleMesh& mesh)
{
    Cones cones;
    cones.m_topology = buildTopology(mesh.m_triangles.data(), mesh.triangleCount(), mesh.vertexCount());
    computeNormalCones(cones.m_topology, mesh.m_positions.data(), cones.m_vertices, cones.m_edges);
    cones.m_true = surfaceCones(cones.m_topology.m_triangles, cones.m_topology.m_edges.size(), mesh.m_positions);
    EXPECT_EQ(cones.m_vertices.size(), mesh.vertexCount());
    EXPECT_EQ(cones.m_edges.size(), cones.m_topology.m_edges.size());
    return cones;
}

void expectHoldNormals(const TriangleMesh& mesh, const Cones& cones)
{
    for (const Triangle& triangle : cones.m_topology.m_triangles)
    {
        const Vector3 a = position(mesh.m_positions, triangle.m_vertices[0]);
        const Vector3 normal = normalized(cross(position(mesh.m_positions, triangle.m_vertices[1]) - a,
                                                position(mesh.m_positions, triangle.m_vertices[2]) - a));
        const Vec3 direction = vec3(float(normal.x), float(normal.y), float(normal.z));
        for (int i = 0; i < 3; ++i)
        {
            EXPECT_TRUE(coneAdmits(cones.m_vertices[triangle.m_vertices[i]], direction));
            EXPECT_TRUE(coneAdmits(cones.m_edges[triangle.m_edges[i]], direction));
            EXPECT_TRUE(coneAdmits(cones.m_edges[triangle.m_edges[i]], vec3Scale(direction, -1.0f)));
        }
    }
}

// The half-angle exceeds the true one by its documented share and two degrees, more or less a rounding.
void expectTight(const std::vector<NormalCone>& cones, const std::vector<DirectionCone>& truth)
{
    for (std::size_t i = 0; i < cones.size(); ++i)
    {
        const double half = 1.35 * std::acos(std::min(1.0, truth[i].m_cosine)) + 0.035;
        if (truth[i].m_everything || half >= 1.57)
        {
            EXPECT_EQ(cones[i].m_cosine, -1.0f);
            continue;
        }
        EXPECT_NEAR(std::acos(double(cones[i].m_cosine)), half, 2e-3);
        const Vector3 axis = {cones[i].m_axis.x, cones[i].m_axis.y, cones[i].m_axis.z};
        EXPECT_NEAR(length(axis), 1.0, 1e-6);
        EXPECT_GT(dot(axis, truth[i].m_axis), 1 - 1e-6);
    }
}

// Winds about every third triangle the other way, in an order of its own for each seed.
TriangleMesh rewound(TriangleMesh mesh, std::uint32_t seed)
{
    Random random(seed);
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        if (random.below(3) == 0) std::swap(mesh.m_triangles[3 * t + 1], mesh.m_triangles[3 * t + 2]);
    return mesh;
}

void expectSameCone(const NormalCone& cone, const NormalCone& other)
{
    EXPECT_NEAR(cone.m_cosine, other.m_cosine, 1e-6f);
    if (cone.m_cosine < 0) return;
    const float along = vec3Dot(cone.m_axis, other.m_axis);
    EXPECT_NEAR(std::abs(along), 1.0f, 1e-5f);
}
}  // namespace

TEST(NormalCones, HoldEveryNormalAroundAFeature)
{
    for (const char* name : {"sphere", "box", "torus", "bowl", "stairs", "terrain"})
    {
        SCOPED_TRACE(name);
        const TriangleMesh mesh = shapeNamed(name);
        const Cones cones = conesOf(mesh);
        expectHoldNormals(mesh, cones);
        expectTight(cones.m_vertices, cones.m_true.m_vertices);
        expectTight(cones.m_edges, cones.m_true.m_edges);
    }
}

TEST(NormalCones, WindingMakesNoDifference)
{
    for (const char* name : {"sphere", "box", "torus", "bowl", "stairs", "terrain"})
    {
        for (std::uint32_t seed = 1; seed <= 5; ++seed)
        {
            SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
            const TriangleMesh mesh = shapeNamed(name), mixed = rewound(mesh, seed);
            const Cones even = conesOf(mesh);
            const Topology topology =
                buildTopology(mixed.m_triangles.data(), mixed.triangleCount(), mixed.vertexCount());
            std::vector<NormalCone> vertices, edges;
            computeNormalCones(topology, mixed.m_positions.data(), vertices, edges);
            for (std::size_t v = 0; v < vertices.size(); ++v)
                expectSameCone(vertices[v], even.m_vertices[v]);
            std::map<std::pair<std::uint32_t, std::uint32_t>, NormalCone> byEnds;
            for (std::size_t e = 0; e < edges.size(); ++e)
                byEnds[std::minmax(topology.m_edges[e].m_vertices[0], topology.m_edges[e].m_vertices[1])] = edges[e];
            for (std::size_t e = 0; e < edges.size(); ++e)
            {
                const std::uint32_t* ends = even.m_topology.m_edges[e].m_vertices;
                expectSameCone(byEnds.at(std::minmax(ends[0], ends[1])), even.m_edges[e]);
            }
        }
    }
}

// A Möbius strip of n quads: no winding of it is even, and each inner edge has a side all the same.
TEST(NormalCones, StripWithoutSidesHasConesOfItsNormals)
{
    constexpr int kQuads = 24;
    TriangleMesh mesh;
    for (int i = 0; i < kQuads; ++i)
    {
        const double around = 2 * 3.14159265358979 * i / kQuads, twist = around / 2;
        for (const double across : {-0.2, 0.2})
            for (const double coordinate : {(1 + across * std::cos(twist)) * std::cos(around), across * std::sin(twist),
                                            (1 + across * std::cos(twist)) * std::sin(around)})
                mesh.m_positions.push_back(float(coordinate));
        const int next = i + 1 == kQuads ? 1 : 2 * i + 2, nextOther = i + 1 == kQuads ? 0 : 2 * i + 3;
        for (const int corner : {2 * i, 2 * i + 1, next, next, 2 * i + 1, nextOther})
            mesh.m_triangles.push_back(corner);
    }
    const Topology topology = buildTopology(mesh.m_triangles.data(), mesh.triangleCount(), mesh.vertexCount());
    std::vector<NormalCone> vertices, edges;
    computeNormalCones(topology, mesh.m_positions.data(), vertices, edges);
    for (std::size_t e = 0; e < edges.size(); ++e)
    {
        if (topology.m_edgeUses[e] != 2) continue;
        EXPECT_GT(edges[e].m_cosine, 0.9f) << "edge " << e;
    }
}

TEST(NormalCones, FlatInteriorAdmitsItsNormalOnly)
{
    const TriangleMesh mesh = makeClothGrid(5, 5, 1.0f, 0.0f).m_mesh;
    const Cones cones = conesOf(mesh);
    const NormalCone& middle = cones.m_vertices[2 * 5 + 2];
    EXPECT_TRUE(coneAdmits(middle, vec3(0, 1, 0)));
    EXPECT_TRUE(coneAdmits(middle, vec3(0, -1, 0)));
    EXPECT_FALSE(coneAdmits(middle, vec3(0.06f, 0.9982f, 0))) << "3.4 degrees off";
    EXPECT_FALSE(coneAdmits(middle, vec3(1, 0, 0)));
}

TEST(NormalCones, BordersAdmitEveryDirection)
{
    const TriangleMesh mesh = makeClothGrid(4, 4, 1.0f, 0.0f).m_mesh;
    const Cones cones = conesOf(mesh);
    for (std::uint32_t e = 0; e < cones.m_topology.m_edges.size(); ++e)
    {
        if (cones.m_topology.m_edgeUses[e] == 2) continue;
        EXPECT_TRUE(coneAdmits(cones.m_edges[e], vec3(1, 0, 0)));
        for (std::uint32_t vertex : cones.m_topology.m_edges[e].m_vertices)
        {
            EXPECT_TRUE(coneAdmits(cones.m_vertices[vertex], vec3(0.6f, 0, 0.8f)));
        }
    }
}

TEST(NormalCones, ZeroAreaAndNonManifoldAdmitEveryDirection)
{
    TriangleMesh mesh = looseTriangles({0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 0, 1});
    mesh.m_triangles = {0, 1, 2, 0, 3, 1};  // the first has no area
    const Cones sliver = conesOf(mesh);
    for (std::uint32_t edge : sliver.m_topology.m_triangles[0].m_edges)
        EXPECT_TRUE(coneAdmits(sliver.m_edges[edge], vec3(0, 0, 1)));

    TriangleMesh fan = looseTriangles({0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 0, 0, 0, 0, 1});
    fan.m_triangles = {0, 1, 2, 0, 1, 3, 0, 1, 4};
    const Cones cones = conesOf(fan);
    const std::uint32_t shared = cones.m_topology.m_triangles[0].m_edges[0];
    EXPECT_EQ(cones.m_topology.m_edgeUses[shared], 3);
    for (const Vec3& direction : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)})
    {
        EXPECT_TRUE(coneAdmits(cones.m_edges[shared], direction));
    }
}

TEST(NormalCones, NanPositionsStayWithTheirNeighbours)
{
    TriangleMesh mesh = makeClothGrid(9, 9, 1.0f, 0.0f).m_mesh;
    mesh.m_positions[0] = std::nanf("");
    const Cones cones = conesOf(mesh);
    for (const NormalCone& cone : cones.m_vertices)
        EXPECT_TRUE(vec3IsFinite(cone.m_axis) && drapeIsFinite(cone.m_cosine));
    EXPECT_FALSE(coneAdmits(cones.m_vertices[4 * 9 + 4], vec3(1, 0, 0)));
}
}  // namespace drape::test
