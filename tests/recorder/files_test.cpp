// Point caches and glTF of a recording contain its numbers; a page needs three.js; arrays that do not fit are refused.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include <nlohmann/json.hpp>

#include "drape/recording.h"
#include "scenes/mesh_loader.h"
#include "tests/support/environment.h"

namespace drape::test
{
namespace
{
class RecordingFiles : public testing::Test
{
protected:
    // A triangle that rises by 1 m a frame, and a rigid one that turns by 120 degrees about (1 1 1) within two frames.
    RecordingFiles()
    {
        m_run.m_title = "run";
        m_run.m_frameTime = 0.5;
        m_run.m_frameCount = 3;
        m_run.m_bodies.resize(2);
        RecordedBody &soft = m_run.m_bodies[0], &rigid = m_run.m_bodies[1];
        soft.m_name = "cloth/1";
        rigid.m_name = "body 2";
        rigid.m_rigid = true;
        soft.m_triangles = rigid.m_triangles = {0, 1, 2};
        soft.m_vertices = rigid.m_vertices = {1, 0, 0, 0, 0, -1, -1, 0, 0};
        for (std::size_t frame = 0; frame < 3; ++frame)
        {
            for (std::size_t i = 0; i < 9; ++i)
                soft.m_frames.push_back(soft.m_vertices[i] + (i % 3 == 1 ? float(frame) : 0));
            const float half = 0.52359878f * float(frame), axis = std::sin(half) / std::sqrt(3.0f);  // 30 degrees
            rigid.m_frames.insert(rigid.m_frames.end(), {0, -1, 0, axis, axis, axis, std::cos(half)});
        }
    }

    std::string path(const std::string& name) const { return m_folder.path() + "/" + name; }

    static std::string read(const std::string& path)
    {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    template <typename Number>
    static Number numberAt(const std::string& bytes, std::size_t at)
    {
        Number number;
        std::memcpy(&number, &bytes.at(at + sizeof number - 1) - (sizeof number - 1), sizeof number);
        return number;
    }

    void expectRefused(const std::string& word)
    {
        const std::string page = path("page.html");
        for (int kind = 0; kind < 3; ++kind)
        {
            std::string error;
            EXPECT_FALSE(kind == 0   ? writeReplay(page, {&m_run}, {}, error)
                         : kind == 1 ? writePointCaches(path("cache"), m_run, error)
                                     : writeGltf(page, m_run, 9, error));
            EXPECT_NE(error.find(word), std::string::npos) << error;
        }
        EXPECT_FALSE(std::filesystem::exists(page));
        EXPECT_FALSE(std::filesystem::exists(path("cache")));
    }

    Recording m_run;
    const TemporaryFolder m_folder;
};
}  // namespace

TEST_F(RecordingFiles, PointCachesHaveEveryFrame)
{
    std::string error;
    ASSERT_TRUE(writePointCaches(path("cache"), m_run, error)) << error;
    TriangleMesh mesh;
    ASSERT_TRUE(loadMesh(path("cache/000_cloth_1.obj"), mesh, error)) << error;
    EXPECT_EQ(mesh.m_positions, m_run.m_bodies[0].m_vertices);
    EXPECT_EQ(mesh.m_triangles, m_run.m_bodies[0].m_triangles);
    const std::string soft = read(path("cache/000_cloth_1.pc2")), rigid = read(path("cache/001_body_2.pc2"));
    ASSERT_EQ(soft.size(), 32u + 4 * 27);
    EXPECT_EQ(soft.substr(0, 12), std::string("POINTCACHE2\0", 12));
    EXPECT_EQ(numberAt<std::int32_t>(soft, 12), 1);
    EXPECT_EQ(numberAt<std::int32_t>(soft, 16), 3);
    EXPECT_EQ(numberAt<float>(soft, 20), 0);
    EXPECT_EQ(numberAt<float>(soft, 24), 1);
    EXPECT_EQ(numberAt<std::int32_t>(soft, 28), 3);
    for (std::size_t i = 0; i < 27; ++i)
        EXPECT_EQ(numberAt<float>(soft, 32 + 4 * i), m_run.m_bodies[0].m_frames[i]);
    const std::string mdd = read(path("cache/000_cloth_1.mdd"));
    ASSERT_EQ(mdd.size(), 8u + 4 * 3 + 4 * 27);
    EXPECT_EQ(mdd.substr(0, 8), std::string("\0\0\0\3\0\0\0\3", 8));
    EXPECT_EQ(mdd.substr(8 + 4, 4), std::string("\x3f\0\0\0", 4)) << "0.5 s";
    for (std::size_t i = 0; i < 27 * 4; ++i)
        ASSERT_EQ(mdd[20 + i], soft[32 + i / 4 * 4 + 3 - i % 4]);
    // In its last frame the rigid body's x points along y, y along z and z along x, and it is 1 m lower.
    const float last[9] = {0, 0, 0, -1, -1, 0, 0, -2, 0};
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(numberAt<float>(rigid, 32 + 4 * (18 + i)), last[i], 1e-6);
}

TEST_F(RecordingFiles, BodiesAtRestHaveNoPointCache)
{
    RecordedBody& rigid = m_run.m_bodies[1];
    for (std::size_t i = 7; i < 21; ++i)
        rigid.m_frames[i] = rigid.m_frames[i - 7];
    std::string error;
    ASSERT_TRUE(writePointCaches(path("cache"), m_run, error)) << error;
    EXPECT_TRUE(std::filesystem::exists(path("cache/001_body_2.obj")));
    EXPECT_FALSE(std::filesystem::exists(path("cache/001_body_2.pc2")));
}

TEST_F(RecordingFiles, GltfHasATargetForEachFrameButTheFirst)
{
    std::string error;
    ASSERT_TRUE(writeGltf(path("run.glb"), m_run, 9, error)) << error;
    TriangleMesh mesh;
    ASSERT_TRUE(loadMesh(path("run.glb"), mesh, error)) << error;
    EXPECT_EQ(mesh.triangleCount(), 2u);
    const std::string bytes = read(path("run.glb"));
    const auto length = numberAt<std::uint32_t>(bytes, 12);
    EXPECT_EQ(numberAt<std::uint32_t>(bytes, 8), bytes.size());
    const auto json = nlohmann::json::parse(bytes.substr(20, length));
    const auto& targets = json["meshes"][0]["primitives"][0]["targets"];
    ASSERT_EQ(targets.size(), 2u);
    const auto valuesOf = [&](std::size_t accessor)
    {
        const auto& view = json["bufferViews"][json["accessors"][accessor]["bufferView"].get<std::size_t>()];
        std::vector<float> values;
        for (std::size_t i = 0; i < view["byteLength"].get<std::size_t>(); i += 4)
            values.push_back(numberAt<float>(bytes, 28 + length + view["byteOffset"].get<std::size_t>() + i));
        return values;
    };
    EXPECT_EQ(valuesOf(targets[1]["POSITION"]), (std::vector<float>{0, 2, 0, 0, 2, 0, 0, 2, 0}));
    const auto& sampler = json["animations"][0]["samplers"][0];
    EXPECT_EQ(valuesOf(sampler["input"]), (std::vector<float>{0, 0.5f, 1}));
    EXPECT_EQ(valuesOf(sampler["output"]), (std::vector<float>{0, 0, 1, 0, 0, 1}));
    const auto& turn = json["animations"][0]["channels"][1];
    EXPECT_EQ(turn["target"]["path"], "rotation");
}

TEST_F(RecordingFiles, GltfThinsTheFramesOfLongRuns)
{
    std::string error;
    ASSERT_TRUE(writeGltf(path("run.glb"), m_run, 1, error)) << error;
    const std::string bytes = read(path("run.glb"));
    const auto json = nlohmann::json::parse(bytes.substr(20, numberAt<std::uint32_t>(bytes, 12)));
    EXPECT_EQ(json["meshes"][0]["primitives"][0]["targets"].size(), 1u);
    const auto times = json["animations"][0]["samplers"][0]["input"].get<std::size_t>();
    EXPECT_EQ(json["accessors"][times]["max"][0], 1.0);  // s, of the last frame
}

TEST_F(RecordingFiles, PositionsThatAreNotFiniteAreNoObstacle)
{
    m_run.m_bodies[0].m_frames[12] = std::numeric_limits<float>::quiet_NaN();
    std::string error;
    ASSERT_TRUE(writeGltf(path("run.glb"), m_run, 9, error)) << error;
    EXPECT_EQ(read(path("run.glb")).find("null"), std::string::npos);
}

TEST_F(RecordingFiles, APageWithoutThreeSaysWhichPackageHasIt)
{
    ReplaySettings settings;
    settings.m_threeFolder = path("nowhere");
    std::string error;
    EXPECT_FALSE(writeReplay(path("page.html"), {&m_run}, settings, error));
    EXPECT_NE(error.find("nowhere/three.min.js"), std::string::npos) << error;
    EXPECT_NE(error.find("apt-get install libjs-three"), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("page.html")));
}

TEST_F(RecordingFiles, APageHasTheLibraryAndTheTitleInIt)
{
    ReplaySettings settings;
    settings.m_threeFolder = path("three");
    settings.m_title = "a < b & c";
    std::filesystem::create_directories(path("three/examples/js/controls"));
    std::ofstream(path("three/three.min.js")) << "const end = \"</script>\";";
    std::ofstream(path("three/examples/js/controls/OrbitControls.js")) << "orbit();";
    std::string error;
    ASSERT_TRUE(writeReplay(path("page.html"), {&m_run, &m_run}, settings, error)) << error;
    const std::string page = read(path("page.html"));
    EXPECT_NE(page.find("<title>a &lt; b &amp; c</title>"), std::string::npos);
    EXPECT_NE(page.find("const end = \"<\\/script>\";"), std::string::npos);
    EXPECT_NE(page.find("orbit();"), std::string::npos);
    EXPECT_NE(page.find("decodeReplay"), std::string::npos);
    EXPECT_EQ(page.find("<!--"), std::string::npos);
    EXPECT_EQ(page.find("http"), std::string::npos) << "the page asks for another file";
}

TEST_F(RecordingFiles, TrianglesOfMissingVerticesAreRefused)
{
    m_run.m_bodies[0].m_triangles[2] = 3;
    expectRefused("triangles");
}

TEST_F(RecordingFiles, HalfFramesAreRefused)
{
    m_run.m_bodies[1].m_frames.pop_back();
    expectRefused("last frame");
}

TEST_F(RecordingFiles, ChannelsOfOtherLengthsAreRefused)
{
    m_run.m_bodies[0].m_channels = {{"gap", "mm", 0, 1, {1, 2, 3}}};
    expectRefused("channel");
}
}  // namespace drape::test
