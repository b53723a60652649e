// Scene files: what they say happens, mistakes are named, and built-in scenes are the same as files.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/tools/scene_files.h"
#include "tools/cloth_drop/run_record.h"
#include "tools/scene_file/built_in_scene.h"
#include "tools/scene_file/materials.h"
#include "tools/scene_file/write_scene.h"

namespace drape::test
{
namespace
{
class BuiltInScenes : public SceneFiles, public testing::WithParamInterface<const char*>
{
};
}  // namespace

// The program's scene is that of tests and benchmarks, and the file gives the same positions.
TEST_P(BuiltInScenes, AFileGivesTheSamePositions)
{
    constexpr int kFrames = 3;
    ClothScene scene;
    ASSERT_TRUE(makeClothScene(GetParam(), ClothSceneSize(), 2, scene));
    Plugin plugin(hostAlone());
    SceneWorld world(scene, plugin);
    std::uint64_t hash = kHashStart;
    for (int frame = 0; frame < kFrames; ++frame)
    {
        for (int step = 0; step < scene.m_stepsPerFrame; ++step)
            world.step(scene.m_frameTime / scene.m_stepsPerFrame);
        hash = hashFloats(hash, world.positions());
    }
    const std::vector<std::string> named = {"--scene", GetParam(), "--seed", "2", "--steps", std::to_string(kFrames)};
    EXPECT_EQ(hashOf(named), hashText(hash));
    std::vector<std::string> writing = named;
    writing.insert(writing.end(), {"--write-scene", path("written.json")});
    ASSERT_EQ(run(writing).m_exitCode, 0);
    EXPECT_EQ(hashOf({"--scene", path("written.json")}), hashText(hash));
}

INSTANTIATE_TEST_SUITE_P(Scenes, BuiltInScenes,
                         testing::Values("twist", "funnel", "knot", "dressed", "cape", "wringer", "sheets_on_cylinder"),
                         [](const testing::TestParamInfo<const char*>& test) { return std::string(test.param); });

TEST_F(SceneFiles, TheDropIsAScene)
{
    const std::vector<std::string> drop = {"--cloth", "9x7",           "--obstacle", "torus",    "--steps",
                                           "20",      "--drop-speed",  "1.5",        "--layers", "3",
                                           "--self",  "--drop-height", "0.05"};
    std::vector<std::string> writing = drop;
    writing.insert(writing.end(), {"--write-scene", path("drop.json")});
    ASSERT_EQ(run(writing).m_exitCode, 0);
    EXPECT_EQ(hashOf({"--scene", path("drop.json")}), hashOf(drop));
}

TEST_F(SceneFiles, AWrittenSceneIsWrittenTheSameAgain)
{
    SceneFile file;
    ASSERT_TRUE(makeBuiltInScene("cape", ClothSceneSize(), 1, file));
    file.m_frames = 2;
    const SceneJson document = sceneDocument(file, path(""));
    const SceneFile again = read(sceneText(document));
    EXPECT_EQ(sceneDocument(again, path("")), document);
}

TEST_F(SceneFiles, PinnedNodesAndObstaclesGoWhereTheMotionsSay)
{
    const SceneFile file =
        read(sceneWith(sheetWith(R"(, "position": [0, 2, 0], "pins": [
            {"corners": ["x_min_z_max"]},
            {"edges": ["x_max"], "motion": {"velocity": [0, 0, 3], "from": 0.5}},
            {"nodes": [1], "motion": {"keyframes": [{"time": 1, "shift": [0, 1, 0]}]}},
            {"box": {"min": [-0.6, 1, -0.6], "max": [-0.4, 3, 0.1]},
             "motion": {"angular_velocity": [0, 1.5707963267948966, 0], "centre": [-0.5, 2, 0]}}])"),
                       R"(, "obstacles": [{"shape": {"type": "box", "size": [1, 1, 1]}, "position": [5, 0, 0],
             "rotation": {"axis": [0, 2, 0], "angle": 1}, "motion": {"velocity": [1, 0, 0]}}])"));
    ASSERT_EQ(file.m_scene.m_cloths[0].m_pins.size(), 4u);
    EXPECT_EQ(file.m_scene.m_cloths[0].m_pins[0].m_nodes, std::vector<int>{6});
    EXPECT_EQ(file.m_scene.m_cloths[0].m_pins[1].m_nodes, (std::vector<int>{2, 5, 8}));
    EXPECT_EQ(file.m_scene.m_cloths[0].m_pins[3].m_nodes, (std::vector<int>{0, 3}));
    Plugin plugin(hostAlone());
    SceneWorld world(file.m_scene, plugin);
    for (int step = 0; step < 60; ++step)
        world.step(1.0 / 60);
    const auto at = [&](int node) { return world.cloth(0).m_nodes[node].m_x; };
    EXPECT_NEAR(at(6).y(), 2, 1e-5) << "held in place";
    EXPECT_NEAR(at(5).z(), 1.5, 1e-4) << "half a second at 3 m/s";
    EXPECT_NEAR(at(1).y(), 3, 1e-5);
    EXPECT_NEAR(at(0).x(), -1, 1e-4) << "a quarter turn about the other node of its box";
    EXPECT_NEAR(at(3).x(), -0.5, 1e-4);
    EXPECT_NEAR(world.obstaclePose(0).getOrigin().x(), 6, 1e-4);
    EXPECT_NEAR(world.obstaclePose(0).getRotation().getAngle(), 1, 1e-4);
}

TEST_F(SceneFiles, DynamicObstaclesFallAndStopOnClothAndFloor)
{
    const SceneFile file = read(sceneWith(
        R"({"shape": {"type": "grid", "columns": 9, "rows": 9, "size": 1}, "position": [0, 1, 0],
            "pins": [{"edges": ["x_min", "x_max", "z_min", "z_max"]}]})",
        R"(, "obstacles": [{"shape": {"type": "sphere", "radius": 0.1}, "position": [0, 1.2, 0], "mass": 0.05},
             {"shape": {"type": "capsule", "radius": 0.1, "length": 0.2}, "position": [3, 1, 0], "mass": 1},
             {"shape": {"type": "plane"}}])"));
    Plugin plugin(hostAlone());
    SceneWorld world(file.m_scene, plugin);
    for (int step = 0; step < 120; ++step)
        world.step(1.0 / 60);
    EXPECT_GT(world.obstaclePose(0).getOrigin().y(), 0.5) << "the cloth carries the ball";
    EXPECT_NEAR(world.obstaclePose(1).getOrigin().y(), 0.2, 0.11) << "the capsule lies or stands on the floor";
}

TEST_F(SceneFiles, WindAndGravityAreThoseOfTheFile)
{
    const SceneFile file = read(sceneWith(sheetWith(""), R"(, "gravity": [0, 0, 0], "wind": {"velocity": [0, 4, 0]})"));
    Plugin plugin(hostAlone());
    SceneWorld world(file.m_scene, plugin);
    for (int step = 0; step < 30; ++step)
        world.step(1.0 / 60);
    EXPECT_GT(world.cloth(0).m_nodes[4].m_x.y(), 0.05);
}

TEST_F(SceneFiles, MaterialsHaveBasesAndMassesFollow)
{
    const SceneFile file = read(sceneWith(sheetWith(R"(, "material": "heavy")") + "," + sheetWith(R"(, "mass": 3)"),
                                          R"(, "materials": {"heavy": {"base": "denim", "density": 2}})"));
    EXPECT_NEAR(file.m_scene.m_cloths[0].m_mass, 2, 1e-6);
    EXPECT_EQ(file.m_scene.m_cloths[0].m_material.m_bending, 0.2) << "denim's";
    EXPECT_EQ(file.m_scene.m_cloths[1].m_mass, 3);
    EXPECT_EQ(file.m_scene.m_cloths[1].m_material.m_bending, materialPresets().front().m_material.m_bending);
}

TEST_F(SceneFiles, MistakesAreNamedWithTheirPath)
{
    const std::string sheet = sheetWith("");
    expectMistake("", {"empty"});
    expectMistake("{\n \"frames\": 3,,}", {"not JSON", "line 2"});
    expectMistake(R"({"frames": 1e999, "cloths": []})", {"not JSON"});
    expectMistake(R"({"frames": 3, "frames": 4})", {"'frames' is given twice"});
    expectMistake("[]", {": /: expected an object, found an array of 0"});
    expectMistake(R"({"frames": 4})", {"/: the key 'cloths' is missing"});
    expectMistake(sceneWith(sheet, R"(, "thicknes": 0.1)"), {"/thicknes: unknown key", "did you mean thickness?"});
    expectMistake(sceneWith(sheet, R"(, "thickness": "2 cm")"), {"/thickness: expected a number", "found \"2 cm\""});
    expectMistake(sceneWith(sheet, R"(, "time_step": 0)"), {"/time_step: expected a number from 1e-06 to 1, found 0"});
    expectMistake(sceneWith(sheet, R"(, "iterations": 2.5)"), {"/iterations: expected a whole number from 1 to 1000"});
    expectMistake(sceneWith(sheetWith(R"(, "material": "coton")")), {"/cloths/0/material", "did you mean cotton?"});
    expectMistake(sceneWith(sheetWith(R"(, "pins": [{"corners": ["y_max_x_min"]}])")), {"/cloths/0/pins/0/corners/0"});
    expectMistake(sceneWith(sheetWith(R"(, "pins": [{"nodes": [9]}])")), {"/nodes/0", "from 0 to 8, found 9"});
    expectMistake(sceneWith(sheetWith(R"(, "pins": [{"nodes": [2]}, {"edges": ["x_max"]}])")),
                  {"/cloths/0/pins/1: node 2 is pinned twice"});
    expectMistake(sceneWith(sheetWith(R"(, "positions": [1, 2, 3])")), {"/cloths/0/positions: expected", "= 27"});
    expectMistake(sceneWith(R"({"shape": {"type": "mesh", "file": "none.obj"}})"),
                  {"/cloths/0/shape/file", "none.obj"});
    expectMistake(sceneWith(sheet, R"(, "obstacles": [{"shape": {"type": "plane"}, "mass": 1}])"),
                  {"/obstacles/0/mass: a plane or height field cannot be dynamic"});
    expectMistake(sceneWith(sheet, R"(, "obstacles": [{"shape": {"type": "ball"}}])"), {"/obstacles/0/shape/type"});
    expectMistake(
        sceneWith(sheetWith(R"(, "pins": [{"nodes": [0], "motion": {"keyframes": [{"time": 1}, {"time": 1}]}}])")),
        {"/motion/keyframes/1/time: times of keyframes must increase"});
}

TEST_F(SceneFiles, OptionsAndNamesAreChecked)
{
    expectRefused(run({"--scene", "twst"}), {"there is no 'twst'", "did you mean twist?"});
    expectRefused(run({"--scene", path("none.json")}), {"none.json"});
    expectRefused(run({"--scene", "twist", "--cloth", "9x9"}), {"--cloth has no effect with --scene"});
    expectRefused(run({"--detail", "2"}), {"--detail needs a built-in scene"});
    const std::string scene = write("scene.json", sceneWith(sheetWith("")));
    expectRefused(run({"--scene", scene, "--json", scene}), {"--json would write over the file of --scene"});
    expectRefused(run({"--scene", scene, "--write-scene", scene}), {"--write-scene would write over"});
    const ToolRun scenes = run({"--list-scenes"}), materials = run({"--list-materials"});
    for (const std::string& name : clothSceneNames())
        EXPECT_NE(scenes.m_out.find(name + " "), std::string::npos) << name;
    for (const std::string& name : materialNames())
        EXPECT_NE(materials.m_out.find(name + " "), std::string::npos) << name;
}

// A scene that somebody else made writes nowhere but below the working folder, and over no mesh that it reads.
TEST_F(SceneFiles, WriteOnlyBelowTheWorkingFolder)
{
    for (const std::string& outside : {path("out.csv"), std::string("a/../../out.csv")})
    {
        const std::string scene =
            write("scene.json", sceneWith(sheetWith(""), R"(, "recording": {"csv": ")" + outside + R"("})"));
        expectRefused(run({"--scene", scene}), {"/recording/csv: expected a path below the working folder"});
    }
    const std::string mesh = write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    expectRefused(run({"--obstacle", mesh, "--write-scene", mesh}), {"--write-scene would write over the mesh"});
    EXPECT_NE(readAll(mesh).find("f 1 2 3"), std::string::npos);
}

// A scene that the reader would refuse is not written.
TEST_F(SceneFiles, OnlyWhatCanBeReadIsWritten)
{
    const std::string written = write("written.json", "{}");
    const ToolRun endless = run({"--cloth", "3x3", "--steps", "2000000000", "--write-scene", written});
    EXPECT_NE(endless.m_exitCode, 0);
    EXPECT_NE(endless.m_err.find("this scene cannot be a scene file"), std::string::npos) << endless.m_err;
    EXPECT_EQ(readAll(written), "{}");
    const std::string mesh = write("far.obj", "v 0 0 0\nv 3e6 0 0\nv 0 0 3e6\nf 1 2 3\n");
    const ToolRun far = run({"--cloth", "3x3", "--obstacle", mesh, "--write-scene", written});
    if (far.m_exitCode == 0)
        EXPECT_EQ(run({"--scene", written, "--write-scene", path("again.json")}).m_exitCode, 0);
    else
        EXPECT_EQ(readAll(written), "{}");
}

TEST_F(SceneFiles, LinesOfTheLogNameBodiesAsTheSceneDoes)
{
    const std::string box = R"({"shape": {"type": "box", "size": [2, 0.2, 2]}, "position": [0, 0.1, 0])";
    const std::string scene = write("scene.json", sceneWith(sheetWith(R"(, "name": "sheet")"),
                                                            R"(, "obstacles": [)" + box + R"(, "name": "block"}])"));
    const ToolRun named = run({"--scene", scene, "--backend", "host", "--quiet"});
    EXPECT_NE(named.m_err.find(R"(cloth "sheet" begins a step with)"), std::string::npos) << named.m_err;
    EXPECT_NE(named.m_err.find(R"(of obstacle "block" ()"), std::string::npos) << named.m_err;
    const std::string other = write("other.json", sceneWith(sheetWith(""), R"(, "obstacles": [)" + box + "}]"));
    const ToolRun numbered = run({"--scene", other, "--backend", "host", "--quiet"});
    EXPECT_NE(numbered.m_err.find("cloth 0 begins a step with"), std::string::npos) << numbered.m_err;
    EXPECT_NE(numbered.m_err.find("of obstacle 0 ("), std::string::npos) << numbered.m_err;
    const std::string alike = box + R"(, "name": "block"})";
    const std::string twice =
        write("twice.json", sceneWith(sheetWith(""), R"(, "obstacles": [)" + alike + ", " + alike + "]"));
    const ToolRun both = run({"--scene", twice, "--backend", "host", "--quiet"});
    EXPECT_NE(both.m_err.find(R"(of obstacle "block" 1 ()"), std::string::npos) << both.m_err;
}

// Bullet's own collision runs the same scene in a child, and outputs named in the file are written.
TEST_F(SceneFiles, RunsAreComparedAndRecorded)
{
    const std::string scene = write(
        "scene.json", sceneWith(sheetWith(R"(, "name": "sheet", "position": [0, 0.2, 0])"),
                                R"(, "obstacles": [{"name": "block", "shape": {"type": "box", "size": [0.5, 0.1, 0.5]},
                       "motion": {"velocity": [0, 1, 0]}}],
                       "recording": {"json": "summary.json", "point_cache": "cache", "frames": "frames"})"));
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(path("."));
    const ToolRun result = run({"--scene", scene, "--backend", "host", "--compare", "--quiet"});
    std::filesystem::current_path(before);
    ASSERT_EQ(result.m_exitCode, 0) << result.m_err;
    const auto summary = nlohmann::json::parse(readAll(path("summary.json")));
    for (const char* name : {"drape", "bullet_stock", "bullet_tuned"})
        EXPECT_EQ(summary.at(name).at("steps"), 4) << name;
    EXPECT_NE(readAll(path("cache/001_sheet.obj")), "");
    EXPECT_NE(readAll(path("frames/obstacle_0004.ply")), "");
}
}  // namespace drape::test
