// Anchors, pressure, volume and ropes of scene files: what they do, and mistakes in them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "scenes/mesh_loader.h"
#include "scenes/mesh_volume.h"
#include "scenes/mesh_writer.h"
#include "scenes/shapes.h"
#include "tests/tools/scene_files.h"
#include "tools/cloth_drop/stretch_meter.h"
#include "tools/scene_file/write_scene.h"

namespace drape::test
{
namespace
{
// A rope of 11 nodes that lies between (0, 2, 0) and (1, 2, 0) and weighs 0.1 kg.
std::string ropeWith(const std::string& more, const std::string& shape = "")
{
    return R"({"shape": {"type": "rope", "from": [0, 2, 0], "to": [1, 2, 0], "nodes": 11)" + shape +
           R"(}, "mass": 0.1)" + more + "}";
}

// A tetrahedron of 0.5 m at the height of 1 m.
std::string tetrahedronWith(const std::string& more, const std::string& triangles = "0,2,1, 0,1,3, 1,2,3, 0,3,2")
{
    return R"({"shape": {"type": "mesh", "positions": [0,0,0, 0.5,0,0, 0,0.5,0, 0,0,0.5], "triangles": [)" + triangles +
           R"(]}, "position": [0, 1, 0])" + more + "}";
}

const std::string kBox = R"({"name": "box", "shape": {"type": "box", "size": [0.2, 0.2, 0.2]}, "position": )";

class SceneBodies : public SceneFiles
{
protected:
    // Returns a cloth of the file ball.obj, 0.4 m wide.
    std::string ballWith(const std::string& more) const
    {
        TriangleMesh ball = makeSphere(0.2f, 2);
        std::string error;
        EXPECT_TRUE(writeMesh(path("ball.obj"), ball, error)) << error;
        return R"({"shape": {"type": "mesh", "file": "ball.obj"}, "position": [0, 0.21, 0])" + more + "}";
    }

    static void step(SceneWorld& world, int frames)
    {
        for (int i = 0; i < frames; ++i)
            world.step(1.0 / 120);
    }

    static btVector3 node(const SceneWorld& world, int index) { return world.cloth(0).m_nodes[index].m_x; }
};

// Returns the volume that a cloth encloses.
double volumeIn(SceneWorld& world, std::size_t cloth)
{
    return double(world.cloth(cloth).getVolume());
}
}  // namespace

TEST_F(SceneBodies, AnchoredNodesStayWithObstaclesOfAllKinds)
{
    for (const char* kind :
         {"", R"(, "motion": {"velocity": [0, 0.5, 0], "angular_velocity": [0, 0, 1]})", R"(, "mass": 2)"})
    {
        const SceneFile file = read(sceneWith(ropeWith(R"(, "anchors": [{"edges": ["x_max"], "obstacle": "box"}])"),
                                              R"(, "obstacles": [)" + kBox + "[1.2, 2, 0]" + kind + "}]"));
        ASSERT_EQ(file.m_scene.m_cloths[0].m_anchors.size(), 1u);
        EXPECT_EQ(file.m_scene.m_cloths[0].m_anchors[0].m_nodes, std::vector<int>{10});
        Plugin plugin(hostAlone());
        SceneWorld world(file.m_scene, plugin);
        step(world, 60);
        const btVector3 local = world.obstaclePose(0).inverse() * node(world, 10);
        EXPECT_NEAR((local - btVector3(btScalar(-0.2), 0, 0)).length(), 0, 0.02) << kind;
        if (file.m_scene.m_obstacles[0].m_mass > 0) continue;  // all of it falls
        EXPECT_LT(node(world, 0).y(), world.obstaclePose(0).getOrigin().y() - 0.3) << "the rope hangs down: " << kind;
    }
}

TEST_F(SceneBodies, ADynamicObstacleHangsFromARope)
{
    const SceneFile file = read(sceneWith(
        ropeWith(R"(, "pins": [{"nodes": [0]}], "anchors": [{"nodes": [10], "obstacle": "box", "collision": false}])"),
        R"(, "obstacles": [)" + kBox + R"([1.1, 2, 0], "mass": 1}])"));
    Plugin plugin(hostAlone());
    SceneWorld world(file.m_scene, plugin);
    step(world, 240);
    EXPECT_LT((world.obstaclePose(0).getOrigin() - btVector3(0, 2, 0)).length(), 1.2);
    EXPECT_LT((node(world, 10) - node(world, 0)).length(), 1.05);
}

// Without collision the whole cloth passes through the obstacle, and no check counts it.
TEST_F(SceneBodies, AnchorsDetermineWhetherTheObstacleCollides)
{
    for (const bool collides : {true, false})
    {
        const std::string sheet = R"({"shape": {"type": "grid", "columns": 9, "rows": 9, "size": 1},
            "position": [0, 0.2, 0], "anchors": [{"nodes": [0], "obstacle": "box", "collision": )" +
                                  std::string(collides ? "true" : "false") + "}]}";
        const std::string scene = write(
            "scene.json", R"({"frames": 40, "cloths": [)" + sheet + R"(], "obstacles": [)" + kBox + "[0, 0, 0]}]}");
        const ToolRun result = run({"--scene", scene, "--backend", "host", "--quiet", "--json", "-"});
        ASSERT_EQ(result.m_exitCode, 0) << result.m_err;
        const auto summary = nlohmann::json::parse(result.m_out);
        EXPECT_EQ(summary.at("contacts_max") > 0, collides);
        EXPECT_EQ(summary.at("nodes_through"), 0);
        EXPECT_EQ(summary.at("intersecting_pairs_max"), 0);
    }
}

TEST_F(SceneBodies, WeakAnchorsYield)
{
    double apart[2];
    for (const bool weak : {false, true})
    {
        const SceneFile file = read(sceneWith(ropeWith(R"(, "anchors": [{"nodes": [0, 10], "obstacle": "box")" +
                                                       std::string(weak ? R"(, "influence": 0.01)" : "") + "}]"),
                                              R"(, "obstacles": [)" + kBox + "[0.5, 3, 0]}]"));
        Plugin plugin(hostAlone());
        SceneWorld world(file.m_scene, plugin);
        step(world, 60);
        apart[weak] = double((node(world, 0) - btVector3(0, 2, 0)).length());
    }
    EXPECT_LT(apart[0], 0.01);
    EXPECT_GT(apart[1], 2 * apart[0]);
}

TEST_F(SceneBodies, PressureBlowsUpAndVolumeIsConserved)
{
    const std::string floor = R"(, "obstacles": [{"shape": {"type": "plane"}}])";
    const std::string press = R"(, {"shape": {"type": "box", "size": [0.5, 0.1, 0.5]}, "position": [0, 0.5, 0],
        "mass": 1}])";
    double volumes[3];
    const std::string kinds[3] = {"", R"(, "pressure": 1.5)", R"(, "volume_conservation": 10000)"};
    for (int kind = 0; kind < 3; ++kind)
    {
        const SceneFile file = read(sceneWith(ballWith(kinds[kind]), floor.substr(0, floor.size() - 1) + press));
        Plugin plugin(hostAlone());
        SceneWorld world(file.m_scene, plugin);
        const double before = volumeIn(world, 0);
        EXPECT_NEAR(double(world.cloth(0).m_cfg.kPR), kind == 1 ? 1.5 : 0, 1e-6);
        EXPECT_NEAR(double(world.cloth(0).m_pose.m_volume), kind == 2 ? before : 0, 1e-5);
        for (int i = 0; i < 240; ++i)
            world.step(1.0 / 240);
        volumes[kind] = volumeIn(world, 0) / before;
    }
    EXPECT_LT(volumes[0], 0.75) << "the box flattens a ball without air";
    EXPECT_GT(volumes[1], volumes[0] + 0.1);
    EXPECT_GT(volumes[2], volumes[0] + 0.08);
}

// Pressure is that of Bullet's nodes on the true surface: each node has a third of its triangles' areas, on average.
TEST_F(SceneBodies, PressureActsOnTheWholeSurface)
{
    const SceneFile file = read(sceneWith(ballWith(R"(, "pressure": 1)")));
    Plugin plugin(hostAlone());
    SceneWorld world(file.m_scene, plugin);
    double area = 0;
    for (int i = 0; i < world.cloth(0).m_nodes.size(); ++i)
        area += double(world.cloth(0).m_nodes[i].m_area);
    EXPECT_NEAR(area, 4 * 3.14159 * 0.04, 0.03 * area);
}

TEST_F(SceneBodies, MeshesThatFaceInwardsAreTurned)
{
    const SceneFile file = read(sceneWith(tetrahedronWith(R"(, "pressure": 1)", "0,1,2, 0,3,1, 1,3,2, 0,2,3")));
    EXPECT_GT(volumeOf(file.m_scene.m_cloths[0].m_rest.m_mesh), 0);
}

TEST_F(SceneBodies, RopesHangAndRestOnMeshes)
{
    const SceneFile file =
        read(sceneWith(R"({"shape": {"type": "rope", "positions": [-0.9,0.8,0.01, -0.6,0.8,0, -0.3,0.8,0, 0,0.8,0,
            0.3,0.8,0, 0.6,0.8,0, 0.9,0.8,0.01], "bending": true}, "mass": 0.3})",
                       R"(, "obstacles": [{"shape": {"type": "built_in", "name": "torus", "fit": 1.2}}])"));
    EXPECT_EQ(file.m_scene.m_cloths[0].m_rest.m_bendingSprings.size(), 2u * 5);
    Plugin plugin(hostAlone());
    SceneWorld world(file.m_scene, plugin);
    EXPECT_EQ(world.lines(), file.m_scene.m_cloths[0].m_rest.m_edgeSprings);
    double mass = 0;
    for (int i = 0; i < 7; ++i)
        mass += 1 / double(world.cloth(0).m_nodes[i].m_im);
    EXPECT_NEAR(mass, 0.3, 1e-5);
    step(world, 120);
    EXPECT_GT(node(world, 3).y(), 0) << "the ring carries the rope over its hole";
    EXPECT_NEAR(world.stretch().m_mean, 0, 0.02);
}

TEST_F(SceneBodies, RopesAndOtherClothCollideIfSelfCollisionIsOn)
{
    const char* const others[] = {R"(, {"shape": {"type": "grid", "columns": 9, "rows": 9, "size": 1},
                                        "position": [0.5, 1.9, 0], "pins": [{"edges": ["x_min", "x_max"]}]})",
                                  R"(, {"shape": {"type": "rope", "from": [0.51, 1.9, -0.5], "to": [0.51, 1.9, 0.5],
                                                  "nodes": 15}, "mass": 0.1, "pins": [{"nodes": [0, 14]}]})"};
    for (const char* other : others)
    {
        const SceneFile file = read(sceneWith(ropeWith("") + other, R"(, "self_collision": true)"));
        Plugin plugin(hostAlone());
        SceneWorld world(file.m_scene, plugin);
        step(world, 60);
        EXPECT_GT(node(world, 5).y(), 1.7) << other;
    }
}

TEST_F(SceneBodies, AWrittenSceneIsWrittenTheSameAgain)
{
    const SceneFile file = read(
        sceneWith(ropeWith(R"(, "anchors": [{"nodes": [10], "obstacle": "box", "collision": false, "influence": 0.5}])",
                           R"(, "bending": true)") +
                      "," + tetrahedronWith(R"(, "pressure": 3, "volume_conservation": 20)"),
                  R"(, "obstacles": [)" + kBox + "[3, 3, 3]}]"));
    const SceneJson document = sceneDocument(file, path(""));
    const SceneFile again = read(sceneText(document));
    EXPECT_EQ(sceneDocument(again, path("")), document);
    EXPECT_EQ(again.m_scene.m_cloths[0].m_rest.m_mesh.m_positions, file.m_scene.m_cloths[0].m_rest.m_mesh.m_positions);
    EXPECT_EQ(again.m_scene.m_cloths[0].m_nodeMasses, file.m_scene.m_cloths[0].m_nodeMasses);
    EXPECT_EQ(again.m_scene.m_cloths[0].m_anchors[0].m_influence, 0.5);
    EXPECT_FALSE(again.m_scene.m_cloths[0].m_anchors[0].m_collides);
    EXPECT_EQ(document["cloths"][1]["pressure"], 3);
}

// Ropes have no triangles: recordings have lines, frames have edges, pictures and animations have tubes.
TEST_F(SceneBodies, RopesAreRecordedAndDrawn)
{
    const std::string scene = write(
        "scene.json", sceneWith(ropeWith(R"(, "name": "rope", "pins": [{"nodes": [0]}])", R"(, "bending": true)")));
    const ToolRun result = run({"--scene", scene, "--backend", "host", "--compare", "--json", path("a.json"), "--quiet",
                                "--point-cache", path("cache"), "--frames", path("frames"), "--gltf", path("a.glb")});
    ASSERT_EQ(result.m_exitCode, 0) << result.m_err;
    const std::string obj = readAll(path("cache/000_rope.obj"));
    EXPECT_NE(obj.find("l 1 2\n"), std::string::npos) << obj;
    EXPECT_EQ(obj.find("l 1 3\n"), std::string::npos) << "bending links are not drawn";
    const std::string ply = readAll(path("frames/cloth_0004.ply"));
    EXPECT_NE(ply.find("element edge 10\nproperty int vertex1\nproperty int vertex2\n"), std::string::npos);
    TriangleMesh mesh;
    LoadReport report;
    std::string error;
    EXPECT_FALSE(loadMesh(path("frames/cloth_0004.ply"), Joining::ByIndex, mesh, report, error));
    EXPECT_NE(error.find("triangle"), std::string::npos) << error;
    EXPECT_NE(readAll(path("a.glb")).find(R"("mode":1)"), std::string::npos);
    EXPECT_NE(hashOf({"--scene", scene, "--steps", "1", "--animation", path("a.webp")}), "");
    EXPECT_NE(readAll(path("a.webp")), "");
    const auto summary = nlohmann::json::parse(readAll(path("a.json")));
    EXPECT_GT(summary.at("drape").at("stretch_max"), 0);
    EXPECT_EQ(summary.at("drape").at("cloth_triangles"), 0);
}

TEST_F(SceneBodies, StretchCountsLinksOfRopes)
{
    const StretchMeter meter({{0, 0, 0, 1, 0, 0, 3, 0, 0}, {}}, {0, 1, 1, 2});
    const MeshStretch stretch = meter.measure({0, 0, 0, 2, 0, 0, 4, 0, 0});
    EXPECT_NEAR(stretch.m_max, 1, 1e-12);
    EXPECT_NEAR(stretch.m_mean, 0.5, 1e-12);
}

TEST_F(SceneBodies, MistakesInAnchorsAreNamed)
{
    const std::string boxes = R"(, "obstacles": [)" + kBox + "[0, 0, 0]}]";
    const auto anchored = [](const std::string& keys) { return sheetWith(R"(, "anchors": [{)" + keys + "}]"); };
    expectMistake(sceneWith(anchored(R"("nodes": [0])"), boxes), {"/anchors/0: the key 'obstacle' is missing"});
    expectMistake(sceneWith(anchored(R"("nodes": [0], "obstacle": "bix")"), boxes),
                  {"/cloths/0/anchors/0/obstacle: there is no 'bix'", "did you mean box?"});
    expectMistake(sceneWith(anchored(R"("nodes": [0], "obstacle": "box")")),
                  {"/anchors/0/obstacle: no obstacle has a name"});
    expectMistake(sceneWith(anchored(R"("nodes": [0], "obstacle": "box")"),
                            R"(, "obstacles": [)" + kBox + "[0, 0, 0]}, " + kBox + "[1, 0, 0]}]"),
                  {"/anchors/0/obstacle: several obstacles are named 'box'"});
    expectMistake(sceneWith(anchored(R"("obstacle": "box")"), boxes),
                  {"/anchors/0: anchors need nodes, corners, edges or a box"});
    expectMistake(sceneWith(anchored(R"("nodes": [0], "obstacle": "box", "influence": 0)"), boxes),
                  {"/anchors/0/influence: expected a number from 0.001 to 1, found 0"});
    expectMistake(sceneWith(anchored(R"("nodes": [0], "obstacle": "box", "motion": {})"), boxes),
                  {"/anchors/0/motion: unknown key"});
    expectMistake(
        sceneWith(anchored(R"("nodes": [3], "obstacle": "box"}, {"edges": ["x_min"], "obstacle": "box")"), boxes),
        {"/anchors/1: node 3 is anchored twice"});
    expectMistake(
        sceneWith(sheetWith(R"(, "pins": [{"nodes": [4]}], "anchors": [{"nodes": [4], "obstacle": "box"}])"), boxes),
        {"/anchors/0: node 4 is pinned and cannot be anchored"});
}

TEST_F(SceneBodies, MistakesInVolumesAndRopesAreNamed)
{
    expectMistake(sceneWith(sheetWith(R"(, "pressure": 1)")),
                  {"/cloths/0/pressure: only a closed mesh has it: the edge of nodes", "belongs to one triangle only"});
    expectMistake(sceneWith(ropeWith(R"(, "volume_conservation": 1)")),
                  {"/cloths/0/volume_conservation: only a closed mesh has it: it has no triangles"});
    expectMistake(sceneWith(tetrahedronWith(R"(, "pressure": 1)", "0,2,1, 0,1,3, 1,3,2, 0,3,2")),
                  {"/pressure: only a closed mesh has it: the triangles at the edge of nodes", "face opposite sides"});
    expectMistake(sceneWith(tetrahedronWith(R"(, "pressure": -1)")), {"/pressure: expected a number from 0 to 1e+06"});
    const std::string inside = R"({"shape": {"type": "mesh", "positions": [0,0,0, 1,0,0, 0,1,0, 0,0,1],
        "triangles": [0,2,1, 0,1,3, 1,2,3, 0,3,2]}, "positions": [0,0,0, 1,0,0, 0,1,0, 0,0,-1], "pressure": 1})";
    expectMistake(sceneWith(inside), {"/pressure: the cloth encloses no volume where it starts, or is inside out"});
    expectMistake(sceneWith(R"({"shape": {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "nodes": 3}})"),
                  {"/cloths/0: the key 'mass' is missing: a rope has no area"});
    expectMistake(sceneWith(R"({"shape": {"type": "rope"}, "mass": 1})"),
                  {"/shape: a rope needs 'from', 'to' and 'nodes', or 'positions'"});
    expectMistake(sceneWith(R"({"shape": {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0]}, "mass": 1})"),
                  {"/shape: the key 'nodes' is missing"});
    expectMistake(sceneWith(ropeWith("", R"(, "positions": [0, 0, 0, 1, 0, 0])")),
                  {"/shape: 'positions' and 'from' exclude each other"});
    expectMistake(sceneWith(R"({"shape": {"type": "rope", "positions": [0, 0, 0, 1]}, "mass": 1})"),
                  {"/shape/positions: expected three numbers for each of 2 to"});
    expectMistake(sceneWith(R"({"shape": {"type": "rope", "positions": [0, 0, 0, 1, 0, 0, 1, 0, 0]}, "mass": 1})"),
                  {"/shape/positions: nodes 1 and 2 are at one point"});
    expectMistake(
        sceneWith(R"({"shape": {"type": "rope", "from": [1, 0, 0], "to": [1, 0, 0], "nodes": 2}, "mass": 1})"),
        {"/shape: nodes 0 and 1 are at one point"});
    expectMistake(sceneWith(ropeWith("", R"(, "bends": true)")), {"/shape/bends: unknown key", "bending"});
}
}  // namespace drape::test
