// drape_check: its numbers on small inputs with a known truth, on every back end, and the inputs that it refuses.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "bullet_plugin/core/pipeline/pipeline.h"
#include "tests/tools/tool.h"

namespace drape::test
{
namespace
{
using Json = nlohmann::json;

// Returns a record's bytes in the file's format.
std::string record(const std::vector<float>& coordinates, const std::vector<std::int32_t>& numbers)
{
    std::string bytes(4 * (coordinates.size() + numbers.size()), '\0');
    std::memcpy(bytes.data(), coordinates.data(), 4 * coordinates.size());
    std::memcpy(bytes.data() + 4 * coordinates.size(), numbers.data(), 4 * numbers.size());
    return bytes;
}

const std::vector<float> kFace = {-3, -3, 0, 3, -3, 0, 0, 3, 0};

// Returns the record of a vertex that goes from z = 1 to `end` over the face at rest, with the given answer.
std::string motionRecord(float end, std::int32_t answer)
{
    std::vector<float> points = {0, 0, 1};
    points.insert(points.end(), kFace.begin(), kFace.end());
    points.insert(points.end(), {0, 0, end});
    points.insert(points.end(), kFace.begin(), kFace.end());
    return record(points, {0, answer});
}

std::string triangleRecord(float height, std::int32_t answer)
{
    std::vector<float> corners = kFace;
    corners.insert(corners.end(), {0, 0, height, 1, 0, height + 1, 0, 1, height + 1});
    return record(corners, {answer});
}

// Returns a grid of two triangles, and one loose triangle at a height above them.
std::string meshAt(float height)
{
    const std::string z = std::to_string(height);
    return "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 0.5 " + z + "\nv 3 0.5 " + z + "\nv 3 1.5 " + z +
           "\nf 1 2 3\nf 1 3 4\nf 5 6 7\n";
}
}  // namespace

class Check : public ToolTest
{
protected:
    const char* programVariable() const override { return "DRAPE_CHECK"; }

    // Returns the answer of the back ends, which must be equal apart from back end, device and times.
    Json answer(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.end(), {"--json", "-", "--backend", "host"});
        const Json host = answerOf(arguments);
        if (listDevices().empty()) return host;
        arguments.back() = "opencl";
        const Json device = answerOf(arguments);
        EXPECT_EQ(host.value("backend", ""), "host");
        EXPECT_EQ(device.value("backend", ""), "opencl");
        EXPECT_EQ(withoutTimes(host), withoutTimes(device));
        return host;
    }

private:
    Json answerOf(const std::vector<std::string>& arguments) const
    {
        const ToolRun result = run(arguments);
        EXPECT_EQ(result.m_exitCode, 0) << result.m_err;
        return Json::parse(result.m_out, nullptr, false);
    }
    static Json withoutTimes(Json json)
    {
        for (const char* key : {"backend", "device", "prepare_ms", "ms", "us_per_query"})
            json.erase(key);
        return json;
    }
};

TEST_F(Check, CcdCountsMissesAndFalseHits)
{
    // The records are a true hit and a true miss, a hit recorded as a miss, and a miss recorded as a hit.
    const std::string file =
        write("motions.bin", motionRecord(-1, 1) + motionRecord(0.1f, 0) + motionRecord(-1, 0) + motionRecord(0.1f, 1));
    const Json json = answer({"ccd", file});
    EXPECT_EQ(json.at("queries"), 4);
    EXPECT_EQ(json.at("misses"), 1);
    EXPECT_EQ(json.at("false_hits"), 1);
    EXPECT_GT(json.at("us_per_query"), 0);
    // All four touch within the separation.
    const Json near = answer({"ccd", file, "--separation", "0.2"});
    EXPECT_EQ(near.at("misses"), 0);
    EXPECT_EQ(near.at("false_hits"), 2);
    const Json timed = answer({"ccd", file, "--time-tolerance", "0.001", "--tolerance", "1e-5"});
    EXPECT_EQ(timed.at("misses"), 1);
}

TEST_F(Check, TrianglesAreCountedInEveryMode)
{
    const std::string file = write("pairs.bin", triangleRecord(-0.5f, 1) + triangleRecord(0.001f, 0));
    for (const char* mode : {"fast", "exact"})
    {
        SCOPED_TRACE(mode);
        const Json json = answer({"triangles", file, "--mode", mode});
        EXPECT_EQ(json.at("queries"), 2);
        EXPECT_EQ(json.at("misses"), 0);
        EXPECT_EQ(json.at("false_hits"), 0);
    }
    // The fast mode cannot decide below the rounding of floats.
    const std::string close = write("close.bin", triangleRecord(1e-44f, 0));
    EXPECT_EQ(answer({"triangles", close, "--mode", "exact"}).at("false_hits"), 0);
}

TEST_F(Check, PairsOfOneMeshAndOfTwoAreCounted)
{
    const std::string near = write("near.obj", meshAt(0.01f)), through = write("through.obj", meshAt(-0.5f));
    const Json alone = answer({"pairs", near, "--thickness", "0.011"});
    EXPECT_EQ(alone.at("candidates"), 1);
    EXPECT_EQ(alone.at("pairs_within"), 1);
    EXPECT_EQ(alone.at("intersecting_pairs"), 0);
    EXPECT_EQ(answer({"pairs", near, "--thickness", "0.009"}).at("pairs_within"), 0);
    // The grid lies in the other's grid: 4 pairs; the loose triangles are 0.51 apart, and 0.01 or 0.5 from the grids.
    const Json both = answer({"pairs", near, through, "--thickness", "0.02"});
    EXPECT_EQ(both.at("intersecting_pairs"), 4);
    EXPECT_EQ(both.at("pairs_within"), 5);
}

TEST_F(Check, StepFindsPassingFeatures)
{
    const std::string above = write("above.obj", meshAt(0.5f)), below = write("below.obj", meshAt(-0.5f));
    const Json passing = answer({"step", above, below});
    EXPECT_EQ(passing.at("vf_hits"), 3);  // the loose triangle's corners pass the first triangle of the grid
    EXPECT_EQ(passing.at("ee_hits"), 0);
    EXPECT_GE(passing.at("vf_candidates"), 3);
    EXPECT_EQ(answer({"step", above, above}).at("vf_hits"), 0);
    EXPECT_EQ(answer({"step", above, above, "--separation", "0.6"}).at("vf_hits"), 3);
}

TEST_F(Check, StepNeedsTheFacesInTheirOrder)
{
    const std::string vertices = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\n", faces = "f 1 2 3\nf 1 3 4\n";
    const std::string start = write("start.obj", vertices + "usemtl a\n" + faces);
    for (const char* others : {"f 1 3 4\nf 1 2 3\n", "f 2 3 1\nf 1 3 4\n", "f 1 2 3\nf 1 2 4\n"})
        expectRefused(run({"step", start, write("end.obj", vertices + "usemtl a\n" + others)}),
                      {"end.obj", "start.obj", "order"});
    // Materials and groups do not reorder faces.
    const std::string sorted =
        write("sorted.obj", vertices + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nusemtl a\n" + faces);
    const std::string others =
        write("others.obj", vertices + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\nusemtl c\n" + faces);
    EXPECT_EQ(answer({"step", sorted, others}).at("vf_hits"), 0);
    // This mesh differs in names only.
    const std::string renamed = "mtllib end.mtl\n" + vertices + "# end\nusemtl b\nf 1//1 -3 -2\nf 1 3/1 4\nvn 0 0 1\n";
    EXPECT_EQ(answer({"step", start, write("renamed.obj", renamed)}).at("vf_hits"), 0);
}

// Four bars meet at one position, each with a vertex of its own there: they touch. Bars that share the vertex by index
// do not count.
TEST_F(Check, PairsUseTheIndicesOfIndexedFiles)
{
    const char* ends[4] = {"1 0 0\nv 1 0 1", "0 1 0\nv 0 1 1", "-1 0 0\nv -1 0 1", "0 -1 0\nv 0 -1 1"};
    std::string apart, faces, shared = "v 0 0 0\n", sharedFaces, stl = "solid bars\n";
    for (int i = 0; i < 4; ++i)
    {
        apart += "v 0 0 0\nv " + std::string(ends[i]) + "\n";
        faces +=
            "f " + std::to_string(3 * i + 1) + " " + std::to_string(3 * i + 2) + " " + std::to_string(3 * i + 3) + "\n";
        shared += "v " + std::string(ends[i]) + "\n";
        sharedFaces += "f 1 " + std::to_string(2 * i + 2) + " " + std::to_string(2 * i + 3) + "\n";
        const std::string end = ends[i];
        const std::size_t second = end.find('v');
        stl += "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex " + end.substr(0, second) + "vertex " +
               end.substr(second + 2) + "\nendloop\nendfacet\n";
    }
    const std::string apartFile = write("apart.obj", apart + faces), stlFile = write("bars.stl", stl + "endsolid\n");
    const Json byIndex = answer({"pairs", apartFile});
    EXPECT_EQ(byIndex.at("vertices"), "by index");
    EXPECT_EQ(byIndex.at("pairs_within"), 6);
    EXPECT_EQ(byIndex.at("intersecting_pairs"), 6);
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"pairs", apartFile, "--join"}, {"pairs", stlFile}})
    {
        const Json joined = answer(arguments);
        EXPECT_EQ(joined.at("vertices"), "joined by position");
        EXPECT_EQ(joined.at("pairs_within"), 0);
    }
    EXPECT_EQ(answer({"pairs", write("shared.obj", shared + sharedFaces)}).at("pairs_within"), 0);
    const Json step = answer({"step", apartFile, apartFile});
    EXPECT_EQ(step.at("vertices"), "by index");
    EXPECT_GT(step.at("vf_hits"), 0);
    EXPECT_EQ(answer({"step", apartFile, apartFile, "--join"}).at("vf_hits"), 0);
    for (const char* command : {"pairs", "step"})
    {
        const ToolRun help = run({command, "--help"});
        for (const char* word : {"--join", "STL", "OBJ, PLY, STL, glTF"})
            EXPECT_NE(help.m_out.find(word), std::string::npos) << help.m_out;
    }
}

// Surveys have such coordinates; float32 would lose half a metre.
TEST_F(Check, CoordinatesFarFromTheOriginKeepTheirDigits)
{
    const auto triangleAt = [](double x)
    {
        char text[160];
        std::snprintf(text, sizeof text, "v %.6f 480000.1 0\nv %.6f 480001.1 0\nv %.6f 480000.1 1\nf 1 2 3\n", x, x, x);
        return std::string(text);
    };
    const std::string a = write("a.obj", triangleAt(5400000.1)), b = write("b.obj", triangleAt(5400000.11));
    EXPECT_EQ(answer({"pairs", a, b, "--thickness", "0.0101"}).at("pairs_within"), 1);
    const Json apart = answer({"pairs", a, b, "--thickness", "0.0099"});
    EXPECT_EQ(apart.at("pairs_within"), 0);
    ASSERT_TRUE(apart.contains("centre"));
    EXPECT_NEAR(apart.at("centre").at(0).get<double>(), 5400000, 1);
    EXPECT_LT(apart.at("rounding_error").get<double>(), 1e-7);
    EXPECT_NE(apart.at("notes").at(0).get<std::string>().find("centred"), std::string::npos);
}

TEST_F(Check, ReadsOnlyDocumentedFormats)
{
    expectRefused(run({"pairs", write("mesh.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")}),
                  {"mesh.off", "not a mesh", ".ply"});
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    expectRefused(run({"pairs", path("pipe")}), {"is a pipe"});
    expectRefused(run({"ccd", path("pipe")}), {"is a pipe", "file of records"});
}

// A hundred thousand triangles at one position, almost coincident so that none is a repeated one. Every back end
// reports the exact number at once.
TEST_F(Check, TooManyPairsAreCountedAndRefused)
{
    std::string text = "v 0 0 0\nv 0 1 0\n";
    for (int i = 0; i < 100000; ++i)
        text += "v 1 0 " + std::to_string(i) + "e-9\nf 1 2 " + std::to_string(i + 3) + "\n";
    const std::string crowd = write("crowd.obj", text);
    const std::vector<std::string> backends =
        listDevices().empty() ? std::vector<std::string>{"host"} : std::vector<std::string>{"host", "opencl"};
    for (const std::string& backend : backends)
    {
        SCOPED_TRACE(backend);
        const std::string json = path(backend + ".json");
        expectRefused(run({"pairs", crowd, crowd, "--backend", backend, "--json", json}),
                      {"crowd.obj", "10000000000", "--candidate-limit"});
        const Json answer = Json::parse(readAll(json));
        EXPECT_EQ(answer.at("candidates"), 10000000000u);
        EXPECT_EQ(answer.at("limit_reached"), true);
        EXPECT_FALSE(answer.contains("pairs_within"));
        const ToolRun step = run({"step", crowd, crowd, "--backend", backend, "--json", "-"});
        EXPECT_EQ(step.m_exitCode, 2);
        EXPECT_NE(step.m_err.find("4999950000"), std::string::npos) << step.m_err;
        EXPECT_EQ(Json::parse(step.m_out).at("triangle_pairs"), 4999950000u);
    }
    // Counts features, which come from the pairs of triangles that may be tested.
    const std::string above = write("above.obj", meshAt(0.5f)), below = write("below.obj", meshAt(-0.5f));
    const Json whole = answer({"step", above, below});
    const std::string limit = std::to_string(whole.at("triangle_pairs").get<int>());
    ASSERT_GT(whole.at("vf_candidates").get<int>() + whole.at("ee_candidates").get<int>(), std::stoi(limit));
    expectRefused(run({"step", above, below, "--candidate-limit", limit, "--json", path("features.json")}),
                  {"features", "above.obj", "--candidate-limit " + limit});
    const Json features = Json::parse(readAll(path("features.json")));
    for (const char* key : {"triangle_pairs", "vf_candidates", "ee_candidates"})
        EXPECT_EQ(features.at(key), whole.at(key)) << key;
    EXPECT_FALSE(features.contains("vf_hits"));
    expectRefused(run({"pairs", above, "--candidate-limit", "0"}), {"--candidate-limit"});
}

TEST_F(Check, WritesItsAnswer)
{
    const std::string file = write("motions.bin", motionRecord(-1, 1));
    const ToolRun plain = run({"ccd", file, "--backend", "host"});
    EXPECT_EQ(plain.m_exitCode, 0);
    for (const char* key : {"queries 1\n", "misses 0\n", "false_hits 0\n", "us_per_query "})
        EXPECT_NE(plain.m_out.find(key), std::string::npos) << plain.m_out;
    const ToolRun quiet = run({"--backend", "host", "--quiet", "--json", path("answer.json"), "ccd", file});
    EXPECT_EQ(quiet.m_exitCode, 0);
    EXPECT_EQ(quiet.m_out + quiet.m_err, "");
    EXPECT_EQ(Json::parse(readAll(path("answer.json"))).at("queries"), 1);
    const ToolRun help = run({"--help"});
    EXPECT_EQ(help.m_exitCode, 0);
    for (const char* word : {"ccd", "triangles", "pairs", "step", "--backend", "--device", "--json"})
        EXPECT_NE(help.m_out.find(word), std::string::npos) << word;
    EXPECT_EQ(run({"--list-devices"}).m_exitCode, 0);
}

TEST_F(Check, RefusesBadInput)
{
    const std::string good = write("good.bin", motionRecord(-1, 1));
    const std::string mesh = write("mesh.obj", meshAt(1));
    expectRefused(run({}), {"command"});
    expectRefused(run({"ccd"}), {"FILE"});
    expectRefused(run({"ccd", good, "--tolerance", "0"}), {"--tolerance"});
    expectRefused(run({"ccd", good, "--backend", "abacus"}), {"abacus"});
    expectRefused(run({"ccd", good, "--backend", "host", "--device", "gpu"}), {"--device"});
    expectRefused(run({"triangles", good, "--mode", "guess"}), {"guess"});
    for (const char* value : {"-1", "1e39", "1e-50"})
        expectRefused(run({"pairs", mesh, "--thickness", value}), {"--thickness"});
    expectRefused(run({"pairs", path("nowhere.ply")}), {"nowhere.ply", "no such file"});
    expectRefused(run({"step", mesh}), {"A1"});
    expectRefused(run({"step", mesh, write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}),
                  {"other.obj", "mesh.obj"});
}

TEST_F(Check, RefusesBadRecords)
{
    const std::string good = motionRecord(-1, 1);
    expectRefused(run({"ccd", path("nowhere.bin")}), {"nowhere.bin", "no such file"});
    expectRefused(run({"ccd", path("")}), {"folder"});
    expectRefused(run({"ccd", write("empty.bin", "")}), {"empty.bin", "empty"});
    expectRefused(run({"ccd", write("short.bin", good + "abc")}), {"short.bin", "104"});
    expectRefused(run({"triangles", write("short.bin", good)}), {"short.bin", "76"});
    std::string bad = good;
    bad[96] = 7;
    expectRefused(run({"ccd", write("kind.bin", good + bad)}), {"kind.bin", "record 2", "kind"});
    bad = good;
    bad[100] = 2;
    expectRefused(run({"ccd", write("truth.bin", bad)}), {"truth.bin", "record 1", "answer"});
    expectRefused(run({"ccd", write("nan.bin", motionRecord(std::nanf(""), 0))}), {"nan.bin", "finite"});
}

TEST_F(Check, UnwritableFilesAreReportedBefore)
{
    const std::string file = write("motions.bin", motionRecord(-1, 1));
    expectRefused(run({"ccd", file, "--backend", "host", "--json", path("no/such/folder/a.json")}), {"no/such/folder"});
    expectRefused(run({"ccd", file, "--backend", "host", "--json", ""}), {"--json", "empty"});
}

TEST_F(Check, AFullStandardOutputIsReported)
{
    expectFullOutputTold({"--help"});
    expectFullOutputTold({"step", "--help"});
    expectFullOutputTold({"--list-devices"});
    expectFullOutputTold({"ccd", write("motions.bin", motionRecord(-1, 1)), "--backend", "host"});
}
}  // namespace drape::test
