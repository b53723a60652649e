#include "scenes/cloth_scene.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenes/cloth_curve.h"
#include "scenes/lathe.h"
#include "scenes/random.h"
#include "scenes/shapes.h"

namespace drape
{
namespace
{
constexpr double kPi = 3.14159265358979323846;
constexpr double kAreaMass = SceneMaterial().m_areaMass;
constexpr double kLayerGap = 1.25;  // distance of layers at the start, in thicknesses

// A flat cloth of columns × rows nodes, its longer side `size` m along x or z, at a height of 0.
SceneCloth flatCloth(int columns, int rows, double size)
{
    SceneCloth cloth;
    cloth.m_rest = makeClothGrid(columns, rows, float(size), 0);
    cloth.m_shape = {ClothShape::Kind::Grid, columns, rows, size, 0};
    cloth.m_positions = cloth.m_rest.m_mesh.m_positions;
    const double cell = size / (std::max(columns, rows) - 1);
    cloth.m_mass = kAreaMass * cell * cell * (columns - 1) * (rows - 1);
    return cloth;
}

void shift(SceneCloth& cloth, const Vector3& by)
{
    for (std::size_t i = 0; i < cloth.m_positions.size(); ++i)
        cloth.m_positions[i] += float(by[int(i % 3)]);
}

// Turns the cloth's start about y.
void turnLevel(SceneCloth& cloth, double angle)
{
    const double c = std::cos(angle), s = std::sin(angle);
    for (std::size_t i = 0; i < cloth.m_positions.size(); i += 3)
    {
        const double x = cloth.m_positions[i], z = cloth.m_positions[i + 2];
        cloth.m_positions[i] = float(c * x + s * z);
        cloth.m_positions[i + 2] = float(c * z - s * x);
    }
}

// Places the cloth in the plane through its z with its own x downwards.
void hang(SceneCloth& cloth)
{
    for (std::size_t i = 0; i < cloth.m_positions.size(); i += 3)
    {
        cloth.m_positions[i + 1] = -cloth.m_positions[i];
        cloth.m_positions[i] = 0;
    }
}

void hold(SceneCloth& cloth, const std::function<bool(const Vector3&)>& isHeld, const SceneMotion& motion)
{
    ScenePins pins;
    pins.m_motion = motion;
    for (std::size_t i = 0; i < cloth.m_positions.size(); i += 3)
        if (isHeld({cloth.m_positions[i], cloth.m_positions[i + 1], cloth.m_positions[i + 2]}))
            pins.m_nodes.push_back(int(i / 3));
    if (!pins.m_nodes.empty()) cloth.m_pins.push_back(pins);
}

// Rises from 0 at `from` to 1 at `to`, without a jump of the speed.
double smoothStep(double time, double from, double to)
{
    const double t = std::clamp((time - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

std::function<ScenePose(double)> standing(const Vector3& at, const Vector3& axis = {0, 1, 0}, double angle = 0)
{
    return [=](double) { return ScenePose{at, axis, angle}; };
}

SceneObstacle table(double size)
{
    return {makeBox(float(size), 0.2f, float(size)), standing({0, -0.1, 0})};
}

// A towel between two clamps that turn against each other, eight turns in all, and come as much nearer as the rope
// that it becomes takes of its length. A square sheet would have to stretch by 41 % at half a turn.
void twist(const ClothSceneSize& size, ClothScene& scene)
{
    constexpr double kLength = 2;
    // Either clamp makes as many; coarse cloth cannot follow more.
    const double turns = 4 * std::min(1.0, size.m_detail / 3.0);
    scene.m_thickness = 0.002;
    scene.m_seconds = 16;
    const int across = 8 * size.m_detail;
    SceneCloth cloth = flatCloth(100 * across / 24 + 1, across + 1, kLength);
    const double seconds = scene.m_seconds;
    for (const double side : {1.0, -1.0})
    {
        const auto turn = [=](double time)
        {
            const double share = std::min(1.0, time / seconds), x = side * kLength / 2;
            return ScenePose{{x * (1 - turns / 8 * share) - x, 0, 0}, {1, 0, 0}, -side * 2 * kPi * turns * share};
        };
        hold(
            cloth, [side](const Vector3& at) { return side * at.x > 0.4999 * kLength; }, turn);
    }
    scene.m_cloths.push_back(cloth);
}

// A sheet over a funnel, and a ball that pushes it through.
void funnel(const ClothSceneSize& size, ClothScene& scene)
{
    scene.m_thickness = 0.005;
    scene.m_seconds = 4;
    const int nodes = 24 * size.m_detail + 1;
    scene.m_cloths.push_back(flatCloth(nodes, nodes, 1.1));
    shift(scene.m_cloths.back(), {0, 0.02, 0});
    const LatheProfile wall = {{0.2, -0.6}, {0.24, -0.6}, {0.24, -0.32}, {0.62, -0.02}, {0.60, 0.0}, {0.2, -0.3}};
    scene.m_obstacles.push_back({makeRing(wall, 48), nullptr});
    scene.m_obstacles.push_back({makeSphere(0.09f, 3), [](double time) {
                                     return ScenePose{{0, 0.25 - 1.1 * smoothStep(time, 0.5, 3.5), 0}, {0, 1, 0}, 0};
                                 }});
}

// Sheets that lie above one another, each turned a little.
void addSheets(const ClothSceneSize& size, double height, ClothScene& scene)
{
    const int nodes = 16 * size.m_detail + 1;
    for (int i = 0; i < size.m_sheets; ++i)
    {
        SceneCloth sheet = flatCloth(nodes, nodes, 1.2);
        turnLevel(sheet, 0.12 * i);
        shift(sheet, {0, height + kLayerGap * scene.m_thickness * i, 0});
        scene.m_cloths.push_back(sheet);
    }
}

void sheetsOnSphere(const ClothSceneSize& size, ClothScene& scene)
{
    scene.m_thickness = 0.01;
    scene.m_seconds = 3;
    addSheets(size, 0.42, scene);
    scene.m_obstacles.push_back({makeSphere(0.4f, 4), nullptr});
}

void sheetsOnCylinder(const ClothSceneSize& size, ClothScene& scene)
{
    scene.m_thickness = 0.01;
    scene.m_seconds = 3;
    addSheets(size, 0.27, scene);
    scene.m_obstacles.push_back({makeCylinder(0.25, 1.6, 0.05, 48), standing({0, 0, 0}, {1, 0, 0}, kPi / 2)});
}

// A roll of cloth that rolls down a ramp and unrolls.
void roll(const ClothSceneSize& size, ClothScene& scene)
{
    constexpr double kInner = 0.04, kTurns = 5, kSlope = 0.25;
    scene.m_thickness = 0.006;
    scene.m_seconds = 4;
    const double gap = kLayerGap * scene.m_thickness;
    const Polyline curve = spiral(kInner, gap, kTurns);
    const int nodes = 96 * size.m_detail + 1;
    SceneCloth cloth = flatCloth(nodes, 12 * size.m_detail + 1, lengthOf(curve));
    cloth.m_positions = placeAlong(cloth.m_rest, nodes, curve, {0, 0, 1});
    shift(cloth, {0, kInner + gap * kTurns + scene.m_thickness, 0});
    scene.m_cloths.push_back(cloth);
    scene.m_obstacles.push_back(
        {makeBox(8, 0.2f, 2), standing({-0.1 * std::sin(kSlope), -0.1 * std::cos(kSlope), 0}, {0, 0, 1}, -kSlope)});
}

// Two strips in a reef knot, pulled tight at their four ends.
void knot(const ClothSceneSize& size, ClothScene& scene)
{
    constexpr double kEnd = 1.2, kTightened = 0.6;
    scene.m_thickness = 0.004;
    scene.m_seconds = 4;
    // One strand's half: from its end past the other's bend, down through the other loop, and out around its legs.
    const Polyline half = {{kEnd, 0.09, 0.10},  {0.55, 0.09, 0.10},  {0.36, 0.09, 0.06},  {0.22, 0.10, -0.06},
                           {0.06, 0.17, -0.12}, {-0.1, 0.26, -0.02}, {-0.24, 0.22, 0.10}, {-0.33, 0.1, 0.14}};
    Polyline points = half;
    for (auto point = half.rbegin(); point != half.rend(); ++point)
        points.push_back({point->x, -point->y, point->z});
    const Polyline curve = smoothCurve(points, 12);
    // A strip whose two legs were straight would reach half of its length.
    const double slack = lengthOf(curve) / 2 - kEnd;
    const double seconds = scene.m_seconds;
    const int nodes = 160 * size.m_detail + 1, rows = 3 * size.m_detail + 1;
    for (const double side : {1.0, -1.0})
    {
        Polyline own = curve;
        for (Vector3& point : own)
            point = {side * point.x, point.y, side * point.z};
        SceneCloth strip = flatCloth(nodes, rows, lengthOf(curve));
        strip.m_positions = placeAlong(strip.m_rest, nodes, own, {0, 0, 1});
        for (const double end : {1.0, -1.0})
        {
            const auto pull = [=](double time) {
                return ScenePose{{end * kTightened * slack * smoothStep(time, 0, seconds), 0, 0}};
            };
            hold(
                strip, [end](const Vector3& at) { return end * at.x > 0.99 * kEnd; }, pull);
        }
        scene.m_cloths.push_back(strip);
    }
}

// A towel folded to eight layers that lies on a table.
void towel(const ClothSceneSize& size, ClothScene& scene)
{
    constexpr double kWidth = 0.4;
    scene.m_thickness = 0.006;
    scene.m_seconds = 3;
    const Polyline curve = zigzag(kWidth, kLayerGap * scene.m_thickness, 8);
    const int nodes = 128 * size.m_detail + 1;
    SceneCloth cloth = flatCloth(nodes, 16 * size.m_detail + 1, lengthOf(curve));
    cloth.m_positions = placeAlong(cloth.m_rest, nodes, curve, {0, 0, 1});
    shift(cloth, {0, kLayerGap * scene.m_thickness, 0});
    scene.m_cloths.push_back(cloth);
    scene.m_obstacles.push_back(table(2));
}

// A dress on a trunk, with an arm that presses it to the trunk's side.
void dressed(const ClothSceneSize& size, ClothScene& scene)
{
    constexpr double kTrunk = 0.16, kArm = 0.05, kDress = 0.2, kLength = 0.9;
    scene.m_thickness = 0.008;
    scene.m_seconds = 4;
    SceneCloth dress;
    dress.m_rest = makeClothTube(32 * size.m_detail, 24 * size.m_detail + 1, float(kDress), float(kLength));
    dress.m_shape = {ClothShape::Kind::Tube, 32 * size.m_detail, 24 * size.m_detail + 1, kDress, kLength};
    dress.m_positions = dress.m_rest.m_mesh.m_positions;
    dress.m_mass = kAreaMass * 2 * kPi * kDress * kLength;
    hold(
        dress, [](const Vector3& at) { return at.y > 0.4999 * kLength; }, nullptr);
    scene.m_cloths.push_back(dress);
    scene.m_obstacles.push_back({makeCapsule(kTrunk, 1.2, 32), nullptr});
    scene.m_obstacles.push_back({makeCapsule(kArm, 0.5, 24), [](double time)
                                 {
                                     const double away = 0.12 * (1 - smoothStep(time, 0.5, 2) + smoothStep(time, 3, 4));
                                     return ScenePose{{kTrunk + kArm + 0.02 + away, 0, 0}, {0, 1, 0}, 0};
                                 }});
}

// A cape on the shoulders of a figure that walks.
void cape(const ClothSceneSize& size, ClothScene& scene)
{
    constexpr double kPace = 1.2, kStride = 0.5, kLift = 0.03;
    scene.m_thickness = 0.01;
    scene.m_seconds = 5;
    const auto at = [](double time)
    {
        const double way = time < 1 ? 0.5 * kPace * time * time : kPace * (time - 0.5);
        return Vector3{way, kLift * std::sin(4 * kPi * time) * std::min(1.0, time), 0};
    };
    SceneCloth cloth = flatCloth(24 * size.m_detail + 1, 18 * size.m_detail + 1, 1.2);
    hang(cloth);
    shift(cloth, {-0.2, 0.85, 0});
    const auto isHeld = [](const Vector3& node) { return node.y > 1.4499 && std::abs(node.z) < 0.3; };
    hold(cloth, isHeld, [at](double time) { return ScenePose{at(time)}; });
    scene.m_cloths.push_back(cloth);
    scene.m_obstacles.push_back({makeCapsule(0.15, 0.5, 32), [at](double time) {
                                     return ScenePose{at(time) + Vector3{0, 1.2, 0}, {0, 1, 0}, 0};
                                 }});
    for (const double side : {1.0, -1.0})
    {
        const auto swing = [at, side](double time)
        {
            const double angle = side * kStride * std::sin(2 * kPi * time) * std::min(1.0, time);
            const Vector3 hip = at(time) + Vector3{0, 0.85, 0.1 * side};
            return ScenePose{hip + Vector3{0.4 * std::sin(angle), -0.4 * std::cos(angle), 0}, {0, 0, 1}, angle};
        };
        scene.m_obstacles.push_back({makeCapsule(0.07, 0.66, 24), swing});
    }
}

// A strip that two rollers draw in and wring.
void wringer(const ClothSceneSize& size, ClothScene& scene)
{
    constexpr double kRadius = 0.1, kTurn = 1.5;  // rad/s
    scene.m_thickness = 0.006;
    scene.m_seconds = 4;
    SceneCloth cloth = flatCloth(32 * size.m_detail + 1, 16 * size.m_detail + 1, 0.8);
    hang(cloth);
    shift(cloth, {0, 0.35, 0});
    scene.m_cloths.push_back(cloth);
    // Room for two layers at the resting distance, and a little more.
    const double apart = kRadius + 1.6 * scene.m_thickness;
    for (const double side : {1.0, -1.0})
    {
        // The axis is first laid along z; a turn about it is a turn about z in the world.
        TriangleMesh roller = makeCylinder(kRadius, 0.7, 0.02, 48);
        for (std::size_t i = 0; i < roller.m_positions.size(); i += 3)
        {
            const float y = roller.m_positions[i + 1];
            roller.m_positions[i + 1] = -roller.m_positions[i + 2];
            roller.m_positions[i + 2] = y;
        }
        scene.m_obstacles.push_back({roller, [=](double time) {
                                         return ScenePose{{side * apart, 0, 0}, {0, 0, 1}, side * kTurn * time};
                                     }});
    }
}

struct NamedScene
{
    const char* m_name;
    void (*m_make)(const ClothSceneSize& size, ClothScene& scene);
    const char* m_text;
};

constexpr NamedScene kScenes[] = {
    {"twist", twist, "a towel between two clamps that turn against each other"},
    {"funnel", funnel, "a sheet over a funnel, and a ball that pushes it through"},
    {"sheets_on_sphere", sheetsOnSphere, "sheets that fall on a sphere, one above the other"},
    {"sheets_on_cylinder", sheetsOnCylinder, "sheets that fall on a lying cylinder, one above the other"},
    {"roll", roll, "a roll of cloth that rolls down a ramp and unrolls"},
    {"knot", knot, "two strips in a reef knot, pulled tight at their four ends"},
    {"towel", towel, "a towel folded to eight layers on a table"},
    {"dressed", dressed, "a dress on a trunk, with an arm that presses it to the side"},
    {"cape", cape, "a cape on the shoulders of a figure that walks"},
    {"wringer", wringer, "a strip that two rollers draw in and wring"}};

const NamedScene* findScene(const std::string& name)
{
    const auto found = std::find_if(std::begin(kScenes), std::end(kScenes),
                                    [&](const NamedScene& known) { return name == known.m_name; });
    return found == std::end(kScenes) ? nullptr : found;
}

// Displaces each cloth, and a little each node that is not held.
void displace(ClothScene& scene, std::uint32_t seed)
{
    Random random(seed);
    for (SceneCloth& cloth : scene.m_cloths)
    {
        const double most = 0.1 * scene.m_thickness, least = 0.02 * scene.m_thickness;
        const Vector3 all = {random.within(-most, most), random.within(0, most), random.within(-most, most)};
        if (cloth.m_pins.empty()) shift(cloth, all);
        std::vector<unsigned char> isHeld(cloth.m_positions.size() / 3);
        for (const ScenePins& pins : cloth.m_pins)
            for (const int node : pins.m_nodes)
                isHeld[std::size_t(node)] = 1;
        for (std::size_t i = 0; i < cloth.m_positions.size(); ++i)
            if (!isHeld[i / 3]) cloth.m_positions[i] += float(random.within(-least, least));
    }
}
}  // namespace

const std::vector<std::string>& clothSceneNames()
{
    static const std::vector<std::string> names = []
    {
        std::vector<std::string> all;
        for (const NamedScene& scene : kScenes)
            all.emplace_back(scene.m_name);
        return all;
    }();
    return names;
}

std::string clothSceneText(const std::string& name)
{
    const NamedScene* const scene = findScene(name);
    return scene == nullptr ? "" : scene->m_text;
}

bool makeClothScene(const std::string& name, const ClothSceneSize& size, std::uint32_t seed, ClothScene& scene)
{
    const NamedScene* const known = findScene(name);
    if (known == nullptr) return false;
    scene = ClothScene();
    scene.m_name = name;
    known->m_make(size, scene);
    displace(scene, seed);
    return true;
}
}  // namespace drape
