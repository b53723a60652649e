// shape_contacts: cloth on Bullet's shapes, with Drape's contacts and with Bullet's: time, depth, motion at rest.
//
// Cloth of 33 x 33 nodes falls on each shape, static or moved by the app, and an independent exact check follows it.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>

#include <unistd.h>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <CLI/CLI.hpp>
#include <drape/drape.h>

#include "benchmarks/support/arguments.h"
#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/samples.h"
#include "oracle/measure.h"
#include "oracle/rest_meter.h"
#include "scenes/shapes.h"
#include "tools/cloth_drop/drop_world.h"
#include "tools/cloth_drop/node_positions.h"
#include "tools/common/program.h"

namespace drape::bench
{
namespace
{
constexpr const char* kProgram = "shape_contacts";
constexpr int kPatchCells = 64;                   // cells around the middle of a height field that the check knows
constexpr double kDt = 1.0 / 60, kMargin = 0.01;  // s, m

const std::vector<std::string> kMethods = {"drape", "bullet_contacts", "stock"};

struct ShapeOptions : CommonOptions
{
    std::vector<std::string> m_shapes, m_methods;
    int m_steps = 360;
    unsigned m_threads = 0;
};

// A shape of Bullet's and the mesh of its surface; the shape may read the heights.
struct ShapeCase
{
    std::string m_name;
    std::shared_ptr<btCollisionShape> m_shape;
    TriangleMesh m_mesh;
    double m_speed = 0;  // m/s upwards, moved by the app; 0: static
    std::shared_ptr<std::vector<float>> m_heights;
};

TriangleMesh meshOfMiddle(const btHeightfieldTerrainShape& field, int points)
{
    TriangleMesh mesh;
    const int first = (points - 1 - kPatchCells) / 2;
    const auto at = [](int i, int j) { return j * (kPatchCells + 1) + i; };
    for (int j = 0; j <= kPatchCells; ++j)
    {
        for (int i = 0; i <= kPatchCells; ++i)
        {
            btVector3 vertex;
            field.getVertex(first + i, first + j, vertex);
            for (int axis = 0; axis < 3; ++axis)
                mesh.m_positions.push_back(float(vertex[axis]));
            if (i == kPatchCells || j == kPatchCells) continue;
            mesh.m_triangles.insert(mesh.m_triangles.end(), {at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j),
                                                             at(i, j + 1), at(i + 1, j + 1)});
        }
    }
    return mesh;
}

// points: along either side; cells of 0.1 m.
ShapeCase makeField(const std::string& name, int points)
{
    ShapeCase field = {name, nullptr, {}, 0, std::make_shared<std::vector<float>>()};
    const int middle = points / 2;
    for (int j = -middle; j <= middle; ++j)
        for (int i = -middle; i <= middle; ++i)
            field.m_heights->push_back(float(0.15 * std::sin(0.3 * i) * std::cos(0.2 * j)));
    auto shape = std::make_shared<btHeightfieldTerrainShape>(points, points, field.m_heights->data(), btScalar(-0.15),
                                                             btScalar(0.15), 1, false);
    shape->setLocalScaling(btVector3(btScalar(0.1), 1, btScalar(0.1)));
    field.m_mesh = meshOfMiddle(*shape, points);
    field.m_shape = shape;
    return field;
}

// Memory of the process, MiB.
double memoryMiB()
{
    std::ifstream file("/proc/self/statm");
    double all = 0, resident = 0;
    file >> all >> resident;
    return resident * double(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

std::vector<ShapeCase> makeCases()
{
    const auto box = std::make_shared<btBoxShape>(btVector3(btScalar(0.3), btScalar(0.2), btScalar(0.3)));
    const auto ball = std::make_shared<btSphereShape>(btScalar(0.3));
    const auto hull = std::make_shared<btConvexHullShape>();
    const auto board = std::make_shared<btBoxShape>(btVector3(btScalar(0.6), btScalar(0.02), btScalar(0.6)));
    const TriangleMesh corners = makeSphere(0.3f, 0), floor = makeBox(20, 1, 20);
    for (std::size_t i = 0; i < corners.m_positions.size(); i += 3)
        hull->addPoint(btVector3(corners.m_positions[i], corners.m_positions[i + 1], corners.m_positions[i + 2]));
    std::vector<ShapeCase> cases = {
        {"box", box, makeBox(0.6f, 0.4f, 0.6f), 0, nullptr},
        {"ball", ball, makeSphere(0.2985f, 4), 0, nullptr},
        {"hull", hull, corners, 0, nullptr},
        {"rising_board", board, makeBox(1.2f, 0.04f, 1.2f), 3, nullptr},
        {"plane", std::make_shared<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0.5)), floor, 0, nullptr},
        makeField("field", 65),
        makeField("large_field", 4097)};
    for (const ShapeCase& made : cases)
        made.m_shape->setMargin(btScalar(kMargin));
    return cases;
}

Settings settingsOf(const ShapeOptions& options, const std::string& method)
{
    Settings settings = options.settings();
    settings.m_threads = options.m_threads;
    settings.m_staticConvex = settings.m_surfaces =
        method == "bullet_contacts" ? ShapeContacts::Bullet : ShapeContacts::Drape;
    return settings;
}

DropScene makeScene(const TriangleMesh& obstacle)
{
    float top = 0;
    for (std::size_t i = 1; i < obstacle.m_positions.size(); i += 3)
        top = std::max(top, obstacle.m_positions[i]);
    DropScene scene;
    scene.m_obstacle = obstacle;
    scene.m_cloth = makeClothGrid(33, 33, 1.2f, top + 0.1f);
    scene.m_dt = kDt;
    scene.m_thickness = 2 * kMargin;
    return scene;
}

// Positions as the obstacle sees them, which is `height` m above its place at the start.
void lower(std::vector<float>& positions, double height)
{
    for (std::size_t i = 1; i < positions.size(); i += 3)
        positions[i] -= float(height);
}

Row measure(const ShapeOptions& options, const ShapeCase& shape, const std::string& method)
{
    std::unique_ptr<Plugin> plugin;
    if (method != "stock") plugin = std::make_unique<Plugin>(settingsOf(options, method));
    std::unique_ptr<btCollisionConfiguration> configuration;
    if (plugin)
        configuration = std::make_unique<CollisionConfiguration>(*plugin);
    else
        configuration = std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>();
    const DropScene scene = makeScene(shape.m_mesh);
    DropWorld world(std::move(configuration), plugin ? std::make_unique<SoftBodySolver>(*plugin) : nullptr);
    btRigidBody body(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, shape.m_shape.get()));
    if (shape.m_speed > 0) body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    body.setActivationState(DISABLE_DEACTIVATION);
    body.setFriction(1);
    world.world().addRigidBody(&body);
    world.addCloth(scene, false);
    PenetrationMeter meter(scene.m_obstacle, scene.m_cloth.m_mesh);
    const double memory = memoryMiB();
    Samples times;
    std::vector<float> positions;
    std::unique_ptr<RestMeter> rest;
    double depth = 0, cpuTicks = 0;
    std::size_t intersecting = 0, below = 0;
    const int rise = shape.m_speed > 0 ? 60 : 0, settle = options.m_steps * 2 / 3;
    for (int step = 0; step < options.m_steps; ++step)
    {
        const double height = shape.m_speed * kDt * std::min(step + 1, rise);
        if (rise > 0)
            body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, btScalar(height), 0)));
        const std::clock_t before = std::clock();
        times.add(world.step(kDt));
        cpuTicks += double(std::clock() - before);
        copyPositions(world.cloth(), positions);
        lower(positions, height);
        const StepMeasure check = meter.measure(positions.data());
        depth = std::max(depth, check.m_penetrationMax);
        intersecting = std::max(intersecting, check.m_intersectingPairs);
        below = std::max(below, check.nodesBelow());
        if (step == settle)
            rest = std::make_unique<RestMeter>(positions);
        else if (rest)
            rest->add(positions, kDt);
    }
    world.world().removeRigidBody(&body);
    Row row;
    row["scene"] = shape.m_name;
    row["method"] = method;
    times.fill(row);
    row["cpu_ms"] = 1e3 * cpuTicks / CLOCKS_PER_SEC / options.m_steps;
    row["depth_max_mm"] = 1e3 * depth;
    row["nodes_below_max"] = below;
    row["intersecting_max"] = intersecting;
    row["speed_mm_s"] = rest ? 1e3 * rest->speed() : 0;
    row["memory_mib"] = memoryMiB() - memory;
    row["hash"] = hashText(hashOf(positions, kEmptyHash));
    return row;
}

int run(int argc, char** argv)
{
    CLI::App app("Measures cloth on Bullet's shapes with Drape's contacts and with Bullet's.", kProgram);
    ShapeOptions options;
    options.m_backend = "host";
    addCommonOptions(app, options);
    const std::vector<ShapeCase> cases = makeCases();
    std::vector<std::string> names;
    for (const ShapeCase& shape : cases)
        names.push_back(shape.m_name);
    app.add_option("--scene", options.m_shapes,
                   "box, ball, hull, rising_board, plane, field or large_field; all by default");
    app.add_option("--method", options.m_methods,
                   "drape, bullet_contacts (with Drape's links) or stock (Bullet alone); all by default");
    app.add_option("--steps", options.m_steps, "steps; the last third counts as rest")
        ->check(CLI::Validator(wholeNumber(3, 1000000), ""));
    app.add_option("--threads", options.m_threads, "see cloth_drop")->check(CLI::Validator(wholeNumber(0, 64), ""));
    int exitCode = kExitGood;
    const auto problem = [&]
    {
        const std::string unknown = unknownName("--scene", options.m_shapes, names);
        return unknown.empty() ? unknownName("--method", options.m_methods, kMethods) : unknown;
    };
    if (!parseArguments(app, argc, argv, problem, exitCode)) return exitCode;
    const auto isChosen = [](const std::vector<std::string>& chosen, const std::string& name)
    { return chosen.empty() || std::find(chosen.begin(), chosen.end(), name) != chosen.end(); };
    Table table;
    for (const ShapeCase& shape : cases)
    {
        if (!isChosen(options.m_shapes, shape.m_name)) continue;
        for (const std::string& method : kMethods)
        {
            if (!isChosen(options.m_methods, method)) continue;
            std::cerr << kProgram << ": " << shape.m_name << ", " << method << std::endl;
            table.add(measure(options, shape, method));
        }
    }
    return finishTable(kProgram, table, options);
}
}  // namespace
}  // namespace drape::bench

int main(int argc, char** argv)
{
    return drape::runGuarded("shape_contacts", [&] { return drape::bench::run(argc, argv); });
}
