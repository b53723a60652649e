// Files become meshes: what kinds of file are refused at once, which vertices are one, and what rounding loses.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <utility>

#include <sys/stat.h>

#include "scenes/mesh_loader.h"
#include "tests/mesh_io/box.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
class MeshLoader : public testing::Test
{
protected:
    std::string path(const std::string& name) const { return m_folder.path() + "/" + name; }
    std::string write(const std::string& name, const std::string& bytes) const
    {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }
    void expectRefused(const std::string& file, const std::vector<std::string>& words) const
    {
        TriangleMesh mesh;
        std::string error;
        EXPECT_FALSE(loadMesh(file, mesh, error));
        for (const std::string& word : words)
            EXPECT_NE(error.find(word), std::string::npos) << error;
        EXPECT_EQ(error.find('\n'), std::string::npos);
    }
    TriangleMesh load(const std::string& file, Joining joining, LoadReport& report) const
    {
        TriangleMesh mesh;
        std::string error;
        EXPECT_TRUE(loadMesh(file, joining, mesh, report, error)) << error;
        return mesh;
    }

private:
    const TemporaryFolder m_folder;
};

const std::string kBox = boxVertexLines("v ") + boxFaceLines("f", 1);

// Returns the box far from the origin, with coordinates that floats cannot distinguish there.
std::string farBox(double x, double y, double z, double size)
{
    std::string text;
    char line[160];
    for (const auto& v : kBoxVertices)
    {
        std::snprintf(line, sizeof line, "v %.9f %.9f %.9f\n", x + size * v[0], y + size * v[1], z + size * v[2]);
        text += line;
    }
    return text + boxFaceLines("f", 1);
}
}  // namespace

TEST_F(MeshLoader, RefusesAtOnceWhatIsNoRegularFile)
{
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(mkfifo(path("pipe.obj").c_str(), 0600), 0);
    std::filesystem::create_directory(path("folder.obj"));
    std::filesystem::create_symlink("/dev/zero", path("zero.obj"));
    std::filesystem::create_symlink(path("pipe.obj"), path("link.ply"));
    expectRefused(path("pipe.obj"), {"pipe.obj", "is a pipe"});
    expectRefused(path("link.ply"), {"link.ply", "is a pipe"});
    expectRefused(path("folder.obj"), {"folder.obj", "is a folder"});
    expectRefused(path("zero.obj"), {"zero.obj", "is a device"});
    expectRefused(path("nowhere.obj"), {"nowhere.obj", "no such file"});
    expectRefused(write("empty.obj", ""), {"empty.obj", "is empty"});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST_F(MeshLoader, ReadsDocumentedFormatsAlone)
{
    LoadReport report;
    EXPECT_EQ(load(write("box.OBJ", kBox), Joining::ByPosition, report).triangleCount(), 12u);
    for (const char* ending : {".off", ".x", ".dae", ".obj.txt", ""})
        expectRefused(write("box" + std::string(ending), kBox), {"not a mesh", ".obj", ".glb"});
    // Each kind of glTF may have either extension.
    expectRefused(write("empty.glb", "{}"), {"empty.glb", "no triangles"});
    expectRefused(write("cut.gltf", "glTF"), {"cut.gltf", "not binary glTF"});
    expectRefused(write("obj.ply", kBox), {"obj.ply", "no PLY header"});
}

TEST_F(MeshLoader, ReadsBuffersBesideTheFile)
{
    const std::string gltf =
        R"({"buffers":[{"uri":"some%20data.bin"}],"bufferViews":[{"buffer":0}],"nodes":[{"mesh":0}],)"
        R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})";
    expectRefused(write("triangle.gltf", gltf), {"triangle.gltf", "some data.bin", "no such file"});
    std::string data;
    for (const float value : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f})
        data += bytesOf(value);
    write("some data.bin", data);
    LoadReport report;
    EXPECT_EQ(load(path("triangle.gltf"), Joining::ByIndex, report).m_positions,
              std::vector<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}));
}

TEST_F(MeshLoader, CentresBeforeItRounds)
{
    LoadReport report;
    const TriangleMesh mesh =
        load(write("far.obj", farBox(5400000.1, 480000.7, 312.3, 0.001)), Joining::ByIndex, report);
    ASSERT_EQ(mesh.vertexCount(), 8u);
    EXPECT_TRUE(report.isCentred());
    EXPECT_LT(report.m_rounding, 1e-9);
    ASSERT_EQ(report.m_notes.size(), 1u);
    EXPECT_NE(report.m_notes[0].find("5400000."), std::string::npos) << report.m_notes[0];
    const Bounds bounds = boundsOf(mesh);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(bounds.extent(axis), 0.002, 1e-8);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(mesh.m_positions[i] + report.m_centre[i],
                    (i == 0   ? 5400000.1
                     : i == 1 ? 480000.7
                              : 312.3) +
                        0.001 * kBoxVertices[kBoxTriangles[0][0]][i],
                    2e-9);
}

TEST_F(MeshLoader, LeavesPositionsThatFloatsHold)
{
    LoadReport report;
    const TriangleMesh near = load(write("near.obj", farBox(0.1, 0.7, -0.3, 1.1)), Joining::ByIndex, report);
    EXPECT_FALSE(report.isCentred());
    EXPECT_GT(report.m_rounding, 0);
    EXPECT_LT(report.m_rounding, 1e-7);
    EXPECT_TRUE(report.m_notes.empty());
    // The box is far from the origin, but every coordinate is a float.
    const TriangleMesh exact = load(write("exact.obj", farBox(4194304, 0, 0, 0.5)), Joining::ByIndex, report);
    EXPECT_FALSE(report.isCentred());
    EXPECT_EQ(report.m_rounding, 0);
    EXPECT_EQ(exact.m_positions[0], 4194304 + 0.5f * kBoxVertices[kBoxTriangles[0][0]][0]);
}

TEST_F(MeshLoader, PutsTwoMeshesIntoOneFrame)
{
    const std::string a = write("a.obj", farBox(5400000.1, 0, 0, 0.5)),
                      b = write("b.obj", farBox(5400001.3, 0, 0, 0.5));
    TriangleMesh first, second;
    LoadReport report;
    std::string error;
    ASSERT_TRUE(loadMeshes(a, b, Joining::ByIndex, first, second, report, error)) << error;
    EXPECT_NEAR(boundsOf(second).m_low[0] - boundsOf(first).m_high[0], 0.2, 1e-6);
    std::vector<float> end;
    ASSERT_TRUE(loadMotion(a, b, Joining::ByIndex, first, end, report, error)) << error;
    for (std::size_t i = 0; i < end.size(); ++i)
        EXPECT_NEAR(end[i] - first.m_positions[i], i % 3 == 0 ? 1.2 : 0, 1e-6);
}

TEST_F(MeshLoader, JoinsByPositionWhereAFileHasNoIndicesOrWhereAsked)
{
    // The triangles are side by side, and their common edge has vertices of its own on either side.
    const std::string split =
        write("split.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 -0\nv 1 1 0\nf 1 2 3\nf 4 6 5\n");
    std::string stl = "solid s\n";
    for (const char* corners : {"vertex 0 0 0 vertex 1 0 0 vertex 0 1 0", "vertex 1 0 0 vertex 1 1 0 vertex 0 1 0"})
        stl += std::string("facet normal 0 0 1 outer loop\n") + replaced(corners, " v", "\nv") + "\nendloop endfacet\n";
    const std::string soup = write("soup.stl", stl + "endsolid\n");
    LoadReport report;
    EXPECT_EQ(load(split, Joining::ByIndex, report).vertexCount(), 6u);
    EXPECT_FALSE(report.m_isJoined);
    EXPECT_EQ(load(split, Joining::ByPosition, report).vertexCount(), 4u);
    EXPECT_TRUE(report.m_isJoined);
    EXPECT_EQ(load(soup, Joining::ByIndex, report).vertexCount(), 4u);
    EXPECT_TRUE(report.m_isJoined);
    // A triangle without area whose indices differ stays, one that repeats an index does not.
    const std::string thin = write("thin.obj", "v 0 0 0\nv 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 2\nf 1 2 4\n");
    EXPECT_EQ(load(thin, Joining::ByIndex, report).triangleCount(), 2u);
    EXPECT_EQ(report.m_notes.size(), 1u);
    EXPECT_EQ(load(thin, Joining::ByPosition, report).triangleCount(), 1u);
}

TEST_F(MeshLoader, RefusesCoordinatesThatFacesUseAlone)
{
    for (const auto& [bad, word] : {std::pair<const char*, const char*>{"nan", "NaN"},
                                    {"inf", "infinite"},
                                    {"1e400", "infinite"},
                                    {"1e39", "float"}})
    {
        SCOPED_TRACE(bad);
        const std::string vertices = "v 0 0 0\nv 1 " + std::string(bad) + " 0\nv 0 1 0\nv 0 0 1\n";
        expectRefused(write("bad.obj", vertices + "f 1 2 3\n"), {"bad.obj", word});
        LoadReport report;
        EXPECT_EQ(load(write("good.obj", vertices + "f 1 3 4\n"), Joining::ByPosition, report).triangleCount(), 1u);
        EXPECT_TRUE(std::isfinite(report.m_rounding));
    }
}

TEST_F(MeshLoader, MotionNeedsTheSameFaces)
{
    const std::string start = write("start.obj", kBox);
    TriangleMesh mesh;
    std::vector<float> end;
    std::string error;
    // Polygons are split alike, however the end's lie.
    const std::string square = "f 1 2 3 4\n";
    ASSERT_TRUE(loadMotion(write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n" + square),
                           write("b.obj", "v 0 0 0\nv 1 1 0\nv 2 0 0\nv 1 3 0\n" + square), mesh, end, error))
        << error;
    EXPECT_EQ(mesh.m_triangles, std::vector<std::int32_t>({0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(end, std::vector<float>({0, 0, 0, 1, 1, 0, 2, 0, 0, 1, 3, 0}));
    EXPECT_FALSE(loadMotion(start, write("more.obj", "v 9 9 9\n" + kBox), mesh, end, error));
    EXPECT_NE(error.find("9 vertices"), std::string::npos) << error;
    EXPECT_FALSE(loadMotion(start, write("other.obj", boxVertexLines("v ") + boxFaceLines("f", -8) + "f 1 2 3\n"), mesh,
                            end, error));
    EXPECT_NE(error.find("same order"), std::string::npos) << error;
}
}  // namespace drape::test
