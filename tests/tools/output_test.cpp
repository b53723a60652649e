// Output files and exit codes of cloth_drop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>
#include <png.h>

#include "bullet_plugin/core/pipeline/pipeline.h"
#include "scenes/mesh_loader.h"
#include "scenes/mesh_writer.h"
#include "tests/tools/tool.h"
#include "tools/cloth_drop/step_parts.h"

namespace drape::test
{
namespace
{
using Json = nlohmann::json;

bool isHash(const std::string& text)
{
    return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// Expects every key of a run, each with its type.
void expectRun(const Json& run, int steps)
{
    for (const char* key : {"backend", "device", "device_reason", "solver", "hash"})
        EXPECT_TRUE(run.at(key).is_string()) << key;
    for (const char* key :
         {"steps", "cloth_triangles", "obstacle_triangles", "contacts_max", "nodes_below_surface", "nodes_through",
          "intersecting_pairs_end", "intersecting_pairs_max", "intersecting_pairs_max_step", "nan_nodes"})
        EXPECT_TRUE(run.at(key).is_number_unsigned()) << key;
    for (const char* key : {"thickness_m", "penetration_max_m", "penetration_p99_m", "gap_min_m", "stretch_mean",
                            "stretch_max", "rest_speed_mm_s"})
        EXPECT_TRUE(run.at(key).is_number()) << key;
    for (const char* key : {"step_ms", "collision_ms"})
        for (const char* part : {"first", "median", "p95", "max"})
            EXPECT_TRUE(run.at(key).at(part).is_number()) << key << " " << part;
    EXPECT_EQ(run.at("steps"), steps);
    EXPECT_EQ(run.at("cloth_triangles"), 128);
    EXPECT_TRUE(isHash(run.at("hash"))) << run.at("hash");
}

// Returns the cells of a CSV file by row.
std::vector<std::vector<std::string>> cellsOf(const std::string& csv)
{
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);)
    {
        rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');)
            rows.back().push_back(cell);
    }
    return rows;
}

std::uint32_t bigEndian(const std::string& bytes, std::size_t at)
{
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}
}  // namespace

using Outputs = ToolTest;

TEST_F(Outputs, JsonHasEveryKey)
{
    const Json run = Json::parse(summaryOf({}));
    expectRun(run, 10);
    EXPECT_EQ(run.at("backend"), "host");
    EXPECT_GT(run.at("contacts_max"), 0);
    EXPECT_GT(run.at("collision_ms").at("median"), 0);
    EXPECT_LE(run.at("collision_ms").at("median"), run.at("collision_ms").at("max"));
    for (const NamedPart& part : stepParts())
    {
        EXPECT_GE(run.at("step_parts_ms").at(part.m_name), 0) << part.m_name;
        EXPECT_LE(run.at("step_parts_ms").at(part.m_name), run.at("step_ms").at("max")) << part.m_name;
    }
    for (const char* part : {"predict", "wait", "solve", "normals"})
        EXPECT_GT(run.at("step_parts_ms").at(part), 0) << part;
    EXPECT_GT(run.at("finding_ms").at("median"), 0);
    EXPECT_LT(run.at("finding_ms").at("median"), run.at("collision_ms").at("median"));
    EXPECT_EQ(run.at("penetration_max_m"), 0);
    EXPECT_EQ(run.at("nodes_below_surface"), 0);
    EXPECT_EQ(run.at("nodes_through"), 0);
    EXPECT_EQ(run.at("intersecting_pairs_end"), 0);
    EXPECT_EQ(run.at("nan_nodes"), 0);
    EXPECT_EQ(run.at("work").at("steps_on_host"), 10);
    EXPECT_EQ(run.at("work").at("obstacles_kept"), 10) << "brought before the first step";
    EXPECT_EQ(run.at("work").at("cloths_skipped"), 0);
    EXPECT_EQ(run.at("work").at("steps_skipped"), 0);
    EXPECT_NEAR(run.at("thickness_m"), 0.02, 1e-9);
}

TEST_F(Outputs, TheSolverOfTheLinksIsChosenAndReported)
{
    const Json usual = Json::parse(summaryOf({})), bullet = Json::parse(summaryOf({"--solver", "bullet"}));
    const Json drape = Json::parse(summaryOf({"--solver", "drape"}));
    EXPECT_EQ(usual.at("solver"), "drape");
    EXPECT_EQ(drape.at("solver"), "drape");
    EXPECT_EQ(drape.at("hash"), usual.at("hash"));
    EXPECT_EQ(bullet.at("solver"), "bullet");
    EXPECT_NE(bullet.at("hash"), usual.at("hash"));
    EXPECT_GT(bullet.at("step_parts_ms").at("bullet_links"), 0);
    EXPECT_EQ(usual.at("step_parts_ms").at("bullet_links"), 0);
    EXPECT_LE(drape.at("stretch_mean"), drape.at("stretch_max"));
    EXPECT_GT(drape.at("rest_speed_mm_s"), 0);
}

TEST_F(Outputs, HostAndOpenClGiveTheSameHash)
{
    DRAPE_NEED_DEVICE();
    const Json host = Json::parse(summaryOf({"--backend", "host"}));
    const Json device = Json::parse(summaryOf({"--backend", "opencl"}));
    EXPECT_EQ(host.at("backend"), "host");
    EXPECT_EQ(device.at("backend"), "opencl");
    EXPECT_EQ(host.at("hash"), device.at("hash"));
    EXPECT_GT(device.at("contacts_max"), 0);
}

TEST_F(Outputs, ValidateHashDecidesTheExitCode)
{
    std::string hash = Json::parse(summaryOf({})).at("hash");
    EXPECT_EQ(runSmall({"--validate-hash", hash}).m_exitCode, 0);
    std::transform(hash.begin(), hash.end(), hash.begin(), [](unsigned char c) { return std::toupper(c); });
    EXPECT_EQ(runSmall({"--validate-hash", hash}).m_exitCode, 0);
    const ToolRun other = runSmall({"--validate-hash", "0123456789abcdef", "--json", path("still.json")});
    EXPECT_EQ(other.m_exitCode, 3);
    EXPECT_NE(other.m_err.find("0123456789abcdef"), std::string::npos) << other.m_err;
    EXPECT_TRUE(Json::accept(readAll(path("still.json")))) << "the results are written all the same";
}

TEST_F(Outputs, CsvHasARowForEachStep)
{
    ASSERT_EQ(runSmall({"--csv", path("steps.csv")}).m_exitCode, 0);
    const std::string csv = readAll(path("steps.csv"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 11);
    const std::string heading = csv.substr(0, csv.find('\n'));
    const std::ptrdiff_t commas = std::count(heading.begin(), heading.end(), ',');
    EXPECT_EQ(std::count(csv.begin(), csv.end(), ','), 11 * commas);
    EXPECT_NE(csv.find("\n10,"), std::string::npos);
}

TEST_F(Outputs, LayersMeetUnlessTheyCollide)
{
    const auto drop = [&](const char* file, const char* how)
    {
        return run({"--cloth", "13x13", "--backend", "host", "--steps", "60", "--layers", "3", how, "--json",
                    path(file)})
            .m_exitCode;
    };
    ASSERT_EQ(drop("apart.json", "--quiet"), 0);
    ASSERT_EQ(drop("self.json", "--self"), 0);
    const Json apart = Json::parse(readAll(path("apart.json"))), self = Json::parse(readAll(path("self.json")));
    EXPECT_GT(apart["self_intersecting_pairs_max"], 0);
    EXPECT_EQ(self["self_intersecting_pairs_max"], 0);
    EXPECT_EQ(self["self_intersecting_pairs_end"], 0);
}

TEST_F(Outputs, ThePartsOfAStepAddUpToTheWhole)
{
    constexpr std::size_t kFirstPart = 13;  // column
    for (const char* solver : {"drape", "bullet"})
    {
        SCOPED_TRACE(solver);
        ASSERT_EQ(runSmall({"--cloth", "33x33", "--solver", solver, "--csv", path("steps.csv")}).m_exitCode, 0);
        const std::vector<std::vector<std::string>> rows = cellsOf(readAll(path("steps.csv")));
        EXPECT_EQ(rows.at(0).at(kFirstPart), "rigid_ms");
        EXPECT_EQ(rows.at(0).size(), kFirstPart + stepParts().size());
        double whole = 0, parts = 0;
        for (std::size_t i = 1; i < rows.size(); ++i)
        {
            whole += std::stod(rows[i].at(2));
            for (std::size_t column = kFirstPart; column < rows[i].size(); ++column)
                parts += std::stod(rows[i][column]);
        }
        EXPECT_GT(parts, 0.95 * whole);
        EXPECT_LT(parts, 1.001 * whole);
    }
}

// Cloth that flew past the obstacle is not below its surface.
TEST_F(Outputs, NodesThatWentThroughAreCounted)
{
    for (const char* mode : {"discrete", "automatic"})
    {
        SCOPED_TRACE(mode);
        const Json run = Json::parse(summaryOf({"--mode", mode, "--drop-speed", "1000", "--csv", path("steps.csv")}));
        EXPECT_EQ(run.at("nodes_below_surface"), 0);
        const std::size_t through = run.at("nodes_through");
        if (mode == std::string("automatic"))
            EXPECT_EQ(through, 0u);
        else
            EXPECT_GT(through, 10u);
        const std::string csv = readAll(path("steps.csv"));
        EXPECT_EQ(cellsOf(csv).back().at(11), std::to_string(through)) << csv;
    }
}

// Fast cloth intersects the obstacle during the run and has left it at the end.
TEST_F(Outputs, TheMostIntersectingPairsOfAnyStepAreCounted)
{
    const auto expectMost = [this](const Json& run)
    {
        std::istringstream rows(readAll(path("steps.csv")));
        std::size_t step = 0, most = 0, mostStep = 0;
        std::string row;
        std::getline(rows, row);
        for (; std::getline(rows, row); ++step)
        {
            std::istringstream cells(row);
            std::string cell;
            for (int column = 0; column < 9; ++column)
                std::getline(cells, cell, ',');
            const std::size_t pairs = std::stoul(cell);
            if (pairs <= most) continue;
            most = pairs;
            mostStep = step + 1;
        }
        EXPECT_EQ(run.at("intersecting_pairs_max"), most);
        EXPECT_EQ(run.at("intersecting_pairs_max_step"), mostStep);
        return most;
    };
    const std::vector<std::string> fast = {"--drop-speed", "60", "--csv", path("steps.csv")};
    for (const char* backend : {"host", "bullet"})
    {
        SCOPED_TRACE(backend);
        std::vector<std::string> arguments = {"--backend", backend, "--mode", "discrete"};
        arguments.insert(arguments.end(), fast.begin(), fast.end());
        const Json run = Json::parse(summaryOf(arguments));
        EXPECT_GT(expectMost(run), run.at("intersecting_pairs_end")) << "not the last step's alone";
    }
    const Json held = Json::parse(summaryOf(fast));
    EXPECT_EQ(expectMost(held), 0u);
}

TEST_F(Outputs, ARunWithoutContactsHasNoTimesOfContacts)
{
    const Json run = Json::parse(summaryOf({"--drop-height", "1", "--steps", "2"}));
    EXPECT_EQ(run.at("steps_in_contact"), 0);
    for (const char* key : {"step_ms", "collision_ms", "finding_ms", "step_parts_ms", "penetration_p99_m"})
        EXPECT_TRUE(run.at(key).is_null()) << key;
    EXPECT_GT(run.at("gap_min_m"), 0);
}

TEST_F(Outputs, FramesAreOneMeshForEachStep)
{
    ASSERT_EQ(runSmall({"--frames", path("frames")}).m_exitCode, 0);
    int cloths = 0, others = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path("frames")))
        ++(entry.path().filename().string().rfind("cloth_", 0) == 0 ? cloths : others);
    EXPECT_EQ(cloths, 11);  // the start and each step
    EXPECT_EQ(others, 1);   // the obstacle
    TriangleMesh mesh;
    std::string error;
    ASSERT_TRUE(loadMesh(path("frames/cloth_0010.ply"), mesh, error)) << error;
    EXPECT_EQ(mesh.triangleCount(), 128u);
    ASSERT_TRUE(loadMesh(path("frames/obstacle.ply"), mesh, error)) << error;
}

// The first bytes of a frame may look like the end of a line.
TEST_F(Outputs, AFrameIsReadWhateverItsFirstVertex)
{
    for (const char* bytes : {"\x0a\x98\x8b\xbf", "\x0a\x0a\x0a\x3f", "\x0d\x0a\x8b\xbf", "\x20\x0a\x8b\xbf"})
    {
        TriangleMesh written, read;
        float x = 0;
        std::memcpy(&x, bytes, sizeof x);
        written.m_positions = {x, 0, 0, 2, 0, 0, 0, 1, 0};
        written.m_triangles = {0, 1, 2};
        std::string error;
        ASSERT_TRUE(writeMesh(path("frame.ply"), written, error)) << error;
        ASSERT_TRUE(loadMesh(path("frame.ply"), read, error)) << error;
        EXPECT_EQ(read.m_positions, written.m_positions);
    }
}

// The run is in a child process, which sends the positions. The comparison below shows Drape's own run.
TEST_F(Outputs, PictureIsAPng)
{
    const ToolRun run = runSmall({"--steps", "2", "--backend", "bullet", "--obstacle", "stairs", "--time-limit", "600",
                                  "--picture", path("last.png")});
    ASSERT_EQ(run.m_exitCode, 0) << run.m_err;
    const std::string png = readAll(path("last.png"));
    ASSERT_GT(png.size(), 1000u);
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(png.substr(12, 4), "IHDR");
    EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
    for (const std::size_t at : {16u, 20u})
    {
        EXPECT_GE(bigEndian(png, at), 200u);
        EXPECT_LE(bigEndian(png, at), 10000u);
    }
}

TEST_F(Outputs, APictureOfAComparisonShowsEveryRun)
{
    const ToolRun run =
        this->run({"--obstacle", "stairs", "--cloth", "9x9", "--backend", "host", "--steps", "40", "--drop-speed", "20",
                   "--compare", "--picture", path("all.PNG"), "--json", path("all.json")});
    ASSERT_EQ(run.m_exitCode, 0) << run.m_err;
    EXPECT_NE(run.m_err.find("picture: 100 % (row 2160 of 2160)"), std::string::npos) << run.m_err;
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&header, path("all.PNG").c_str()), 0) << header.message;
    header.format = PNG_FORMAT_RGB;
    constexpr std::size_t kWidth = 720, kHeight = 720, kGap = 8;
    ASSERT_EQ(header.width, 3 * kWidth + 2 * kGap);
    ASSERT_EQ(header.height, kHeight);
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(header));
    ASSERT_NE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr), 0) << header.message;
    const auto pixel = [&](std::size_t x, std::size_t y) { return &pixels[3 * (y * header.width + x)]; };
    std::set<std::string> panels, labels;
    for (std::size_t panel = 0; panel < 3; ++panel)
    {
        const std::size_t left = panel * (kWidth + kGap);
        if (panel > 0)
        {
            EXPECT_EQ(pixel(left - 1, kHeight / 2)[0], 255) << "between two";
        }
        std::size_t cloth = 0, ink = 0;
        std::string all, label;
        for (std::size_t y = 0; y < kHeight; ++y)
            for (std::size_t x = left; x < left + kWidth; ++x)
            {
                const std::uint8_t* colour = pixel(x, y);
                cloth += colour[0] > 2 * colour[2];  // the cloth is red in front and yellow at the back
                const bool dark = y < 100 && colour[0] == 40 && colour[1] == 42 && colour[2] == 46;
                ink += dark;
                if (y < 100) label += dark ? '#' : ' ';
                if (y >= 100) all.append(colour, colour + 3);
            }
        EXPECT_GT(ink, 1000u) << "title and remark of panel " << panel;
        if (panel == 0)
        {
            EXPECT_GT(cloth, 10000u);
        }
        panels.insert(all);
        labels.insert(label);
    }
    EXPECT_GE(panels.size(), 2u) << "Bullet's cloth lies elsewhere";
    EXPECT_EQ(labels.size(), 3u);
}

TEST_F(Outputs, APictureThatIsNoPngIsRefused)
{
    for (const char* name : {"last.jpg", "last.JPEG", "last.gif", "last.png.bak", "last.pngg"})
    {
        expectRefused(runSmall({"--picture", path(name)}), {"--picture", "PNG", name});
        EXPECT_FALSE(std::filesystem::exists(path(name)));
    }
}

TEST_F(Outputs, UnwritableFilesAreReportedBeforeTheRun)
{
    for (const char* option : {"--json", "--csv", "--picture"})
    {
        SCOPED_TRACE(option);
        expectRefused(runSmall({option, path("no/such/folder/file.png")}), {"no/such/folder"});
        expectRefused(runSmall({option, ""}), {option, "empty"});
    }
    write("file", "");
    expectRefused(runSmall({"--frames", path("file")}), {path("file")});
    expectRefused(runSmall({"--frames", path("both"), "--csv", path("both")}), {"is a folder"});
    expectRefused(runSmall({"--picture", "-"}), {"--picture"});
}

TEST_F(Outputs, AFailedWriteIsAFailedRun)
{
    ASSERT_TRUE(std::filesystem::is_character_file("/dev/full"));
    std::filesystem::create_symlink("/dev/full", path("full"));
    const ToolRun run = runSmall({"--json", path("full")});
    EXPECT_EQ(run.m_exitCode, 1);
    EXPECT_NE(run.m_err.find("full: cannot write"), std::string::npos) << run.m_err;
}

TEST_F(Outputs, AFullStandardOutputIsReported)
{
    expectFullOutputTold({"--help"});
    expectFullOutputTold({"--list-devices"});
    expectFullOutputTold({"--backend", "host", "--cloth", "3x3", "--steps", "1", "--json", "-", "--quiet"});
}

TEST_F(Outputs, TwoOutputsNeedTwoFiles)
{
    std::filesystem::create_symlink("a", path("link"));
    expectRefused(runSmall({"--csv", path("a"), "--json", path("a")}), {"--csv and --json"});
    expectRefused(runSmall({"--json", path("./a"), "--picture", path("a")}), {"--json and --picture"});
    expectRefused(runSmall({"--csv", "-", "--json", "-"}), {"--csv and --json"});
    write("a", "");
    expectRefused(runSmall({"--csv", path("link"), "--json", path("a")}), {"--csv and --json"});
    EXPECT_EQ(runSmall({"--csv", "/dev/null", "--json", "/dev/null"}).m_exitCode, 0);
}

TEST_F(Outputs, CsvOnStandardOutputEqualsTheFile)
{
    for (const char* name : {"-", "/dev/stdout"})
    {
        SCOPED_TRACE(name);
        const ToolRun run = runSmall({"--steps", "2", "--csv", name});
        ASSERT_EQ(run.m_exitCode, 0) << run.m_err;
        EXPECT_EQ(run.m_out.rfind("step,time_s,", 0), 0u) << run.m_out;
        EXPECT_EQ(std::count(run.m_out.begin(), run.m_out.end(), '\n'), 3);
    }
}

TEST_F(Outputs, QuietPrintsNothingAndHelpSucceeds)
{
    const ToolRun quiet = runSmall({});
    EXPECT_EQ(quiet.m_exitCode, 0);
    EXPECT_EQ(quiet.m_out + quiet.m_err, "");
    const ToolRun help = run({"--help"});
    EXPECT_EQ(help.m_exitCode, 0);
    for (const char* option : {"--obstacle", "--cloth", "--backend", "--compare", "--validate-hash", "--picture"})
        EXPECT_NE(help.m_out.find(option), std::string::npos) << option;
}

TEST_F(Outputs, ListDevicesNamesThemAll)
{
    const ToolRun result = run({"--list-devices"});
    EXPECT_EQ(result.m_exitCode, 0);
    EXPECT_FALSE(result.m_out.empty());
    for (const DeviceInfo& device : listDevices())
        EXPECT_NE(result.m_out.find(device.m_name), std::string::npos) << result.m_out;
}

TEST_F(Outputs, EveryShapeRuns)
{
    for (const char* shape : {"sphere", "bowl", "stairs"})
    {
        SCOPED_TRACE(shape);
        const Json run = Json::parse(summaryOf({"--obstacle", shape, "--cloth", "9x9"}));
        expectRun(run, 10);
        EXPECT_EQ(run.at("penetration_max_m"), 0);
    }
}

// Uses the limits of the arguments.
TEST_F(Outputs, TheLargestScenesAndTheFastestClothCollide)
{
    const Json large = Json::parse(summaryOf({"--obstacle-size", "1e4", "--cloth-size", "1e4"}));
    EXPECT_EQ(large.at("steps_in_contact"), 10);
    const Json thick = Json::parse(summaryOf({"--thickness", "1e4"}));
    EXPECT_EQ(thick.at("steps_in_contact"), 10);
    const Json fast = Json::parse(summaryOf({"--drop-speed", "5.9e6", "--drop-height", "0", "--steps", "30"}));
    EXPECT_GT(fast.at("steps_in_contact"), 0);
    for (const Json& run : {large, thick, fast})
    {
        EXPECT_EQ(run.at("nodes_through"), 0);
        EXPECT_EQ(run.at("intersecting_pairs_end"), 0);
    }
}

TEST_F(Outputs, TheBuiltInBackEndRunsAlone)
{
    const Json run = Json::parse(summaryOf({"--backend", "bullet", "--obstacle", "stairs", "--steps", "3"}));
    expectRun(run, 3);
    EXPECT_NE(std::string(run.at("backend")).find("bullet"), std::string::npos);
}

// The limit is exceeded at once: every back end writes the steps until then.
TEST_F(Outputs, ALimitOfTimeKeepsTheStepsDone)
{
    const Json run = Json::parse(summaryOf({"--time-limit", "1e-9", "--csv", path("steps.csv")}));
    expectRun(run, 1);
    EXPECT_EQ(run.at("capped_at_step"), 1);
    const std::string csv = readAll(path("steps.csv"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
    // Bullet's own collision may not end a step. The current step is then given up, and the last complete one is none.
    const Json builtIn =
        Json::parse(summaryOf({"--backend", "bullet", "--obstacle", "stairs", "--time-limit", "1e-9"}));
    EXPECT_EQ(builtIn.at("capped_at_step"), 0);
    EXPECT_EQ(builtIn.at("steps"), 0);
}

TEST_F(Outputs, ALimitOfTimeThatIsNotReachedChangesNothing)
{
    for (const char* backend : {"host", "bullet"})
    {
        SCOPED_TRACE(backend);
        const std::vector<std::string> arguments = {"--backend", backend, "--obstacle", "stairs", "--steps", "3"};
        std::vector<std::string> limited = arguments;
        limited.insert(limited.end(), {"--time-limit", "600"});
        const Json run = Json::parse(summaryOf(limited)), other = Json::parse(summaryOf(arguments));
        expectRun(run, 3);
        EXPECT_FALSE(run.contains("capped_at_step"));
        for (const char* key : {"backend", "device", "hash", "contacts_max", "nodes_below_surface"})
            EXPECT_EQ(run.at(key), other.at(key)) << key;
    }
}

TEST_F(Outputs, CompareHasThreeRunsAndTwoRatios)
{
    const Json all = Json::parse(summaryOf({"--obstacle", "stairs", "--compare", "--compare-cap", "10"}));
    for (const char* name : {"drape", "bullet_stock", "bullet_tuned"})
    {
        SCOPED_TRACE(name);
        const Json& run = all.at(name);
        expectRun(run, run.value("capped_at_step", 10));
    }
    EXPECT_FALSE(all.at("drape").contains("capped_at_step"));
    EXPECT_EQ(all.at("drape").at("penetration_max_m"), 0);
    for (const char* name : {"bullet_stock", "bullet_tuned"})  // whose solver's time is no part of either
        EXPECT_EQ(all.at(name).at("finding_ms"), all.at(name).at("collision_ms")) << name;
    for (const char* ratio : {"ratio_stock", "ratio_tuned", "ratio_stock_finding", "ratio_tuned_finding"})
    {
        ASSERT_TRUE(all.at(ratio).is_number()) << ratio;
        EXPECT_GT(all.at(ratio), 0) << ratio;
    }
}
}  // namespace drape::test
