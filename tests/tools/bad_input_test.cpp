// Inputs that cloth_drop refuses with one clear line and exit code 2. Nothing runs and nothing is written.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include <sys/stat.h>

#include "bullet_plugin/core/pipeline/pipeline.h"
#include "tests/support/environment.h"
#include "tests/tools/tool.h"

namespace drape::test
{
using BadInput = ToolTest;

TEST_F(BadInput, AMissingFileIsRefused)
{
    expectRefused(runSmall({"--obstacle", path("nowhere.obj")}), {"nowhere.obj", "no such file"});
}

TEST_F(BadInput, AFolderIsRefused)
{
    expectRefused(runSmall({"--obstacle", path("")}), {"folder"});
}

TEST_F(BadInput, AFileThatIsNoMeshIsRefused)
{
    expectRefused(runSmall({"--obstacle", write("letter.txt", "Dear reader,\n")}), {"letter.txt", "not a mesh"});
    expectRefused(runSmall({"--obstacle", write("empty.ply", "")}), {"empty.ply", "empty"});
    expectRefused(runSmall({"--obstacle", write("broken.ply", "ply\nformat ascii 1.0\nelement")}), {"broken.ply"});
    expectRefused(runSmall({"--obstacle", write("broken.stl", "sol")}), {"broken.stl", "not a mesh"});
    // A file's extension decides its format, even if another reader could read it.
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    expectRefused(runSmall({"--obstacle", write("ply.glb", ply)}), {"ply.glb", "not a mesh"});
}

TEST_F(BadInput, ABinaryFileWithAWrongLengthIsRefused)
{
    const std::string json = "{\"asset\":{\"version\":\"2.0\"}}  ", chunk = "JSON" + json;
    const auto header = [](std::uint32_t version, std::size_t length)
    { return "glTF" + littleEndian(version) + littleEndian(std::uint32_t(length)); };
    const std::size_t whole = 12 + 8 + json.size();
    const std::string size = littleEndian(std::uint32_t(json.size()));
    expectRefused(runSmall({"--obstacle", write("header.glb", header(2, 0x7d5d0228u) + size + chunk)}),
                  {"header.glb", "header: says 2103247400 bytes"});
    expectRefused(runSmall({"--obstacle", write("chunk.glb", header(2, whole) + littleEndian(0x6e222c5du) + chunk)}),
                  {"chunk.glb", "chunk 1: says 1847733341 bytes"});
    expectRefused(runSmall({"--obstacle", write("second.glb", header(2, whole + 8) + size + chunk +
                                                                  littleEndian(1u << 31) + "BIN ")}),
                  {"second.glb", "chunk 2: says 2147483648 bytes where there are 0"});
    expectRefused(
        runSmall({"--obstacle", write("old.glb", header(1, whole) + littleEndian(1u << 30) + littleEndian(0) + json)}),
        {"old.glb", "content: says 1073741824 bytes"});
    expectRefused(runSmall({"--obstacle", write("new.glb", header(3, whole) + size + chunk)}),
                  {"new.glb", "version 3"});
    expectRefused(runSmall({"--obstacle", write("none.glb", header(2, whole) + size + chunk)}), {"none.glb"});
}

// Readers of the nodes call themselves for every level.
TEST_F(BadInput, GltfNestedTooDeepIsRefused)
{
    expectRefused(runSmall({"--obstacle", write("deep.gltf", std::string(200000, '['))}), {"deep.gltf", "deeper"});
    std::string chain = "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}", twice = chain, quoted = chain;
    for (int node = 0; node < 20000; ++node)
        chain += ",{\"children\":[" + std::to_string(node) + "]}";
    for (int node = 0; node < 26; ++node)
        twice += ",{\"children\":[" + std::to_string(node) + "," + std::to_string(node) + "]}";
    expectRefused(runSmall({"--obstacle", write("chain.gltf", chain + "]}")}), {"chain.gltf", "deeper"});
    expectRefused(runSmall({"--obstacle", write("twice.gltf", twice + "]}")}), {"twice.gltf", "two parents"});
    expectRefused(runSmall({"--obstacle", write("far.gltf", "{\"nodes\":[{\"children\":[7]}]}")}), {"out of range"});
    const std::string name = ",{\"name\":\"\\\"" + std::string(600, '[') + "\"}";  // brackets of a string are none
    const ToolRun result = runSmall({"--obstacle", write("quoted.gltf", quoted + name + "]}")});
    EXPECT_EQ(result.m_err.find("deeper"), std::string::npos) << result.m_err;
}

TEST_F(BadInput, AnIncompleteStlIsRefused)
{
    const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n";
    const std::string whole = "solid a\n" + facet + "endfacet\n";
    expectRefused(runSmall({"--obstacle", write("end.stl", whole)}), {"end.stl", "too early", "1 facet"});
    expectRefused(runSmall({"--obstacle", write("open.stl", whole + facet)}), {"open.stl", "too early"});
    expectRefused(runSmall({"--obstacle", write("next.stl", "solid a\n" + facet + facet)}), {"line 8", "facet 1"});
    expectRefused(
        runSmall({"--obstacle", write("four.stl", "solid a\n" + facet + "vertex 1 1 0\nendfacet\nendsolid\n")}),
        {"four.stl", "4 vertices"});
    expectRefused(runSmall({"--obstacle", write("comma.stl", "solid a\nfacet normal 0 0 1\nvertex 1,5 0 0\n")}),
                  {"line 3", "'1,5' is not a decimal number"});
    std::string binary(80, ' ');
    binary += littleEndian(2) + std::string(50, '\0');
    expectRefused(runSmall({"--obstacle", write("short.stl", binary)}), {"2 triangles", "184 bytes", "134"});
}

TEST_F(BadInput, PipesAndDevicesAreNotWaitedFor)
{
    ASSERT_EQ(mkfifo(path("pipe.obj").c_str(), 0600), 0);
    expectRefused(runSmall({"--obstacle", path("pipe.obj")}), {"pipe.obj", "is a pipe"});
    expectRefused(runSmall({"--obstacle", "/dev/zero"}), {"/dev/zero", "is a device"});
}

// Accepts input that other readers open.
TEST_F(BadInput, FilesThatOtherReadersOpenAreAccepted)
{
    const auto obj = [](const std::string& vertex) { return "v 0 0 0\nv " + vertex + "\nv 0 1 0\nf 1 2 3\n"; };
    const std::string strips =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (const std::string& file : {write("dot.obj", obj("1 .5 0")), write("seven.obj", obj("1 0 0 1 1 1 1")),
                                    write("mark.obj", "\xef\xbb\xbf" + obj("1 0 0")), write("strips.ply", strips)})
    {
        const ToolRun result = runSmall({"--obstacle", file, "--steps", "1"});
        EXPECT_EQ(result.m_exitCode, 0) << result.m_err;
        EXPECT_EQ(result.m_err, "");
    }
    expectRefused(runSmall({"--obstacle", write("hex.obj", obj("0x1p0 0 0"))}), {"line 2", "'0x1p0'", "decimal"});
}

// Reports parts that are left out or lost by rounding.
TEST_F(BadInput, LossesAreReported)
{
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const ToolRun two = runSmall({"--obstacle", write("two.obj", obj + "f 1 2\n"), "--steps", "1"});
    EXPECT_EQ(two.m_exitCode, 0);
    EXPECT_NE(two.m_err.find("two.obj: 1 face with fewer than three corners"), std::string::npos) << two.m_err;
    const std::string away = "v 5400000.1 0 0\nv 5400001.3 0 0\nv 5400000.1 1.1 0\nf 1 2 3\n";
    const ToolRun far = runSmall({"--obstacle", write("far.obj", away), "--steps", "1"});
    EXPECT_EQ(far.m_exitCode, 0);
    EXPECT_NE(far.m_err.find("far.obj: centred"), std::string::npos) << far.m_err;
}

TEST_F(BadInput, InputFilesAreNotOverwritten)
{
    const std::string mesh = write("in.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (const char* option : {"--json", "--csv", "--picture"})
        expectRefused(runSmall({"--obstacle", mesh, option, mesh}), {option, "write over", "in.obj"});
    const std::string frames = path("frames");
    std::filesystem::create_directories(frames);
    write("frames/obstacle.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    expectRefused(runSmall({"--obstacle", frames + "/obstacle.ply", "--frames", frames}), {"--frames"});
    expectRefused(runSmall({"--csv", frames + "/cloth_0001.ply", "--frames", frames}), {"--frames"});
    std::filesystem::remove_all(frames);
    expectRefused(runSmall({"--frames", mesh}), {"in.obj", "folder"});
}

TEST_F(BadInput, AMeshWithoutTrianglesIsRefused)
{
    expectRefused(runSmall({"--obstacle", write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")}), {"points.obj"});
    expectRefused(runSmall({"--obstacle", write("repeats.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n")}),
                  {"repeats.obj", "no triangles"});
}

TEST_F(BadInput, AnIndexOutOfRangeIsRefused)
{
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    expectRefused(runSmall({"--obstacle", write("high.obj", vertices + "f 1 2 4\n")}), {"high.obj", "out of range"});
    expectRefused(runSmall({"--obstacle", write("low.obj", vertices + "f 1 2 -4\n")}), {"low.obj", "out of range"});
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    expectRefused(runSmall({"--obstacle", write("high.ply", ply + "3 0 1 3\n")}),
                  {"high.ply", "face 1", "out of range"});
    expectRefused(runSmall({"--obstacle", write("low.ply", ply + "3 0 1 -1\n")}),
                  {"low.ply", "face 1", "out of range"});
}

TEST_F(BadInput, AVertexThatIsNoNumberIsRefused)
{
    for (const char* bad : {"nan", "inf", "-inf", "1e39", "x"})
    {
        SCOPED_TRACE(bad);
        const std::string text = std::string("v 0 0 0\nv 1 ") + bad + " 0\nv 0 1 0\nf 1 2 3\n";
        expectRefused(runSmall({"--obstacle", write("bad.obj", text)}), {"bad.obj", "vertex 2"});
    }
}

TEST_F(BadInput, BadNumbersAreRefused)
{
    for (const char* option : {"--obstacle-size", "--cloth-size", "--steps", "--dt", "--thickness", "--time-limit"})
        for (const char* value :
             {"-1", "0", "nan", "inf", "1e39", "1e-50", "two", ""})  // programs compute with float32
        {
            SCOPED_TRACE(std::string(option) + " " + value);
            expectRefused(runSmall({option, value}), {option});
        }
    expectRefused(runSmall({"--drop-height", "-0.1"}), {"--drop-height"});
    expectRefused(runSmall({"--drop-speed", "-1"}), {"--drop-speed"});
    expectRefused(runSmall({"--steps", "2.5"}), {"--steps"});
    expectRefused(runSmall({"--thickness", "0.00009"}), {"--thickness", "0.0001"});
}

// Bullet would leave the cloth out of collision without a message.
TEST_F(BadInput, ScenesOutOfBulletsReachAreRefused)
{
    for (const char* option : {"--obstacle-size", "--cloth-size", "--drop-height", "--thickness"})
        for (const char* value : {"10001", "1e10", "1e38"})
            expectRefused(runSmall({option, value}), {option, value, "10000 at most"});
    for (const char* speed : {"6.1e6", "1e8", "1e38"})
        expectRefused(runSmall({"--drop-speed", speed}), {"--drop-speed", "100000 m in a step"});
    expectRefused(runSmall({"--dt", "110"}), {"--dt", "100000 m in a step"});
    expectRefused(runSmall({"--drop-speed", "1e3", "--dt", "100"}), {"--dt", "100000 m in a step"});
}

TEST_F(BadInput, BadClothSizesAreRefused)
{
    for (const char* value : {"9", "9x", "x9", "1x9", "9x1", "0x0", "-9x9", "9x9x9", "99999x9"})
    {
        SCOPED_TRACE(value);
        expectRefused(runSmall({"--cloth", value}), {"--cloth"});
    }
}

TEST_F(BadInput, UnknownAndContradictoryOptionsAreRefused)
{
    expectRefused(runSmall({"--no-such-option"}), {"--no-such-option"});
    expectRefused(runSmall({"--backend", "abacus"}), {"abacus"});
    expectRefused(runSmall({"--backend", "bullet", "--compare"}), {"--compare"});
    expectRefused(runSmall({"--backend", "host", "--device", "gpu"}), {"--device"});
    expectRefused(runSmall({"--validate-hash", "12"}), {"12"});
    expectRefused(runSmall({"--backend", "bullet", "--time-limit", "9", "--frames", path("frames")}), {"--time-limit"});
}

TEST_F(BadInput, AnUnknownDeviceIsRefusedWithAListOfDevices)
{
    DRAPE_NEED_DEVICE();
    std::vector<std::string> words = {"no such device"};
    for (const DeviceInfo& device : listDevices())
        words.push_back(device.m_name);
    expectRefused(runSmall({"--device", "no such device"}), words);
    expectRefused(runSmall({"--backend", "opencl", "--device", "no such device"}), words);
}

TEST_F(BadInput, ACrossoverThatIsNoNumberIsRefused)
{
    DRAPE_NEED_DEVICE();
    const ScopedVariable byCost("DRAPE_DEVICE", nullptr), crossover("DRAPE_CROSSOVER", "many");
    expectRefused(runSmall({"--backend", "auto"}), {"DRAPE_CROSSOVER", "many"});
}

TEST_F(BadInput, RefusedRunsWriteNothing)
{
    expectRefused(runSmall({"--obstacle", path("nowhere.obj"), "--json", path("a.json"), "--csv", path("a.csv"),
                            "--frames", path("frames"), "--picture", path("a.png")}),
                  {"nowhere.obj"});
    for (const char* name : {"a.json", "a.csv", "frames", "a.png"})
        EXPECT_FALSE(std::filesystem::exists(path(name))) << name;
}
}  // namespace drape::test
