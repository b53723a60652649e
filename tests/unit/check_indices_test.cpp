// Meshes with indices out of range are refused wherever a caller hands one over, and change nothing.
#include "bullet_plugin/core/scene/check_indices.h"

#include <gtest/gtest.h>

#include <limits>

#include "scenes/describe_mesh.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/self_cases.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr std::size_t kBadTriangle = 5;

// Makes a sphere whose sixth triangle has the index as a corner.
TriangleMesh withIndex(std::int32_t index, std::size_t corner)
{
    TriangleMesh mesh = makeSphere(0.5f, 1);
    mesh.m_triangles[3 * kBadTriangle + corner] = index;
    return mesh;
}

// Indices are below the range, just past it and far past it.
std::vector<TriangleMesh> badMeshes()
{
    const std::int32_t vertices = std::int32_t(makeSphere(0.5f, 1).vertexCount());
    std::vector<TriangleMesh> meshes;
    for (std::int32_t index : {-1, std::numeric_limits<std::int32_t>::min(), vertices, vertices + 1,
                               std::numeric_limits<std::int32_t>::max()})
        for (std::size_t corner = 0; corner < 3; ++corner)
            meshes.push_back(withIndex(index, corner));
    TriangleMesh withoutVertices = makeSphere(0.5f, 1);
    withoutVertices.m_positions.clear();
    meshes.push_back(withoutVertices);
    return meshes;
}

Settings onHost()
{
    Settings settings;
    settings.m_backend = Backend::Host;
    return settings;
}

void expectNamed(const Error& error, const std::string& call)
{
    EXPECT_TRUE(error.failed());
    EXPECT_EQ(error.m_call, call + ": a mesh with an index out of range");
    EXPECT_NE(error.m_detail.find("triangle "), std::string::npos) << error.m_detail;
}
}  // namespace

TEST(CheckIndices, NamesTheFirstThatIsOutOfRange)
{
    TriangleMesh mesh = withIndex(-7, 1);
    mesh.m_triangles.back() = 1000;
    Error error;
    EXPECT_FALSE(checkIndices(describeMesh(mesh), "call", error));
    EXPECT_EQ(error.text(), "call: a mesh with an index out of range\ntriangle 5 has the index -7 among " +
                                std::to_string(mesh.vertexCount()) + " vertices");
}

TEST(CheckIndices, NamesTheFirstEdgeThatIsOutOfRange)
{
    const TriangleMesh mesh = makeSphere(0.5f, 1);
    MeshDescription description = describeMesh(mesh);
    const std::int32_t edges[] = {0, 1, 1, std::int32_t(mesh.vertexCount())};
    description.m_edges = edges;
    description.m_edgeCount = 1;
    Error error;
    EXPECT_TRUE(checkIndices(description, "call", error));
    description.m_edgeCount = 2;
    EXPECT_FALSE(checkIndices(description, "call", error));
    EXPECT_EQ(error.text(), "call: a mesh with an index out of range\nedge 1 has the index " +
                                std::to_string(mesh.vertexCount()) + " among " + std::to_string(mesh.vertexCount()) +
                                " vertices");
    description.m_edges = nullptr;
    EXPECT_FALSE(checkIndices(description, "call", error));
}

TEST(CheckIndices, AdmitsEveryIndexInRangeAndNoTriangles)
{
    Error error;
    EXPECT_TRUE(checkIndices(MeshDescription(), "call", error));
    const std::int32_t last = std::int32_t(makeSphere(0.5f, 1).vertexCount()) - 1;
    for (std::int32_t index : {0, last})
        EXPECT_TRUE(checkIndices(describeMesh(withIndex(index, 2)), "call", error));
    EXPECT_FALSE(error.failed());
}

// The good meshes beside the bad one give the contacts that they give alone.
TEST(CheckIndices, PipelineRefusesTheMeshAndGoesOn)
{
    const StepCase step = fallingCase("sphere", 12, 0.03f, 41);
    SCOPED_TRACE(step.trace());
    const std::unique_ptr<Pipeline> alone = makePipeline(onHost()), beside = makePipeline(onHost());
    ASSERT_TRUE(alone && beside);
    for (const TriangleMesh& mesh : badMeshes())
    {
        EXPECT_EQ(addCloth(*beside, mesh), kNoMesh);
        expectNamed(beside->lastError(), "addCloth");
        EXPECT_EQ(addObstacle(*beside, mesh), kNoMesh);
        expectNamed(beside->lastError(), "addObstacle");
    }
    const std::vector<Contact> expected = runCase(*alone, step), found = runCase(*beside, step);
    EXPECT_GT(expected.size(), 50u);
    EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
    EXPECT_EQ(beside->statistics().m_clothTriangles, step.m_cloth.triangleCount());
    EXPECT_EQ(beside->statistics().m_obstacleTriangles, step.m_obstacle.triangleCount());
}

TEST(CheckIndices, QueriesRefuseTheMeshAndGoOn)
{
    const std::unique_ptr<Queries> queries = makeQueries(onHost());
    ASSERT_TRUE(queries);
    const TriangleMesh good = makeSphere(0.5f, 1);
    const MeshDescription goodMesh = describeMesh(good);
    MeshPairs pairs;
    MeshMotion motion;
    for (const TriangleMesh& mesh : badMeshes())
    {
        const MeshDescription bad = describeMesh(mesh);
        EXPECT_FALSE(queries->meshPairs(bad, nullptr, 0.1f, pairs));
        EXPECT_FALSE(queries->meshPairs(bad, &goodMesh, 0.1f, pairs));
        EXPECT_FALSE(queries->meshPairs(goodMesh, &bad, 0.1f, pairs));
        expectNamed(queries->error(), "meshPairs");
        EXPECT_TRUE(pairs.m_within.empty());
        EXPECT_FALSE(queries->meshMotion(bad, good.m_positions.data(), defaultCcdSettings(), motion));
        expectNamed(queries->error(), "meshMotion");
    }
    ASSERT_TRUE(queries->meshPairs(goodMesh, &goodMesh, 0.0f, pairs));
    EXPECT_GE(pairs.m_intersecting.size(), good.triangleCount());
    EXPECT_TRUE(queries->meshMotion(goodMesh, good.m_positions.data(), defaultCcdSettings(), motion));
}
}  // namespace drape::test
