// Contacts that are left out because others imply them: what stays keeps them, whatever the nodes do within their tube.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "scenes/vector3.h"
#include "tests/support/backends.h"
#include "tests/support/oracle.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr float kTubeShare = 0.5f;    // of the thickness, as the solver's at the default activation
constexpr double kPromised = 0.02;    // of the thickness: what pipeline.h says of contacts left out
constexpr double kOneFeature = 0.01;  // of the thickness: a node's contacts against one another
constexpr double kRounding = 2e-6;    // m, of gaps and levels at these sizes
// Hits of a slot that a GPU's group holds; a CPU sorts more than half of them by heap.
constexpr std::size_t kCrowded = 256;

// All contacts of a case and those that a pipeline keeps, in one pipeline.
struct Reduced
{
    StepCase m_case;
    std::unique_ptr<Pipeline> m_pipeline;
    std::vector<Contact> m_all, m_kept;
    std::size_t m_counted = 0;

    Reduced(const Settings& settings, const StepCase& step) : m_case(step), m_pipeline(makePipeline(settings))
    {
        if (!m_pipeline) return;
        m_all = runCase(*m_pipeline, step);
        m_pipeline = makePipeline(settings);
        m_kept = runCase(*m_pipeline, step, kTubeShare * step.m_thickness);
        m_counted = m_pipeline->statistics().m_reduced;
    }
};

// A contact as the solver takes it: normal.(sum weight x) >= level.
struct Plane
{
    int m_count = 0;
    std::array<std::uint32_t, 3> m_nodes = {};
    std::array<double, 3> m_weights = {};
    Vector3 m_normal;
    double m_level = 0;
    double m_lengths2 = 0;  // sum of the weights' squares
};

Vector3 vectorOf(const float v[3])
{
    return {double(v[0]), double(v[1]), double(v[2])};
}

Plane planeOf(const Pipeline& pipeline, const Contact& contact, double thickness)
{
    Plane plane;
    const ClothFeature feature = pipeline.clothFeature(contact);
    for (std::size_t k = 0; k < 3 && feature.m_nodes[k] >= 0; ++k, ++plane.m_count)
    {
        plane.m_nodes[k] = std::uint32_t(feature.m_nodes[k]);
        plane.m_weights[k] = double(contact.m_weights[k]);
        plane.m_lengths2 += plane.m_weights[k] * plane.m_weights[k];
    }
    plane.m_normal = vectorOf(contact.m_normal);
    plane.m_level = dot(plane.m_normal, vectorOf(contact.m_point)) + thickness;
    return plane;
}

// Places of the nodes of one dropped contact, drawn at random within their tubes and pushed until the kept ones hold.
class Sample
{
public:
    Sample(const StepCase& step, const Plane& dropped) : m_radius(double(kTubeShare * step.m_thickness))
    {
        for (std::size_t k = 0; k < std::size_t(dropped.m_count); ++k)
        {
            m_start[k] = position(step.m_cloth.m_positions, dropped.m_nodes[k]);
            m_way[k] = position(step.m_end, dropped.m_nodes[k]) - m_start[k];
            m_place[dropped.m_nodes[k]] = k;
        }
    }

    // Half of the draws go as far against the dropped contact as the tube lets them.
    void draw(const Plane& dropped, Random& random)
    {
        for (std::size_t k = 0; k < std::size_t(dropped.m_count); ++k)
        {
            Vector3 off = -1.0 * dropped.m_normal;
            if (random.below(2) == 0)
                off = {double(random.uniform(-1, 1)), double(random.uniform(-1, 1)), double(random.uniform(-1, 1))};
            const double share = random.below(2) == 0 ? 1.0 : double(random.uniform(0, 1));
            m_x[k] = m_start[k] + share * m_way[k] + m_radius / std::max(length(off), 1e-9) * off;
        }
    }

    double gap(const Plane& plane) const
    {
        double along = -plane.m_level;
        for (std::size_t k = 0; k < std::size_t(plane.m_count); ++k)
            along += plane.m_weights[k] * dot(plane.m_normal, m_x[m_place.at(plane.m_nodes[k])]);
        return along;
    }

    // Whether all hold, and the nodes are in their tubes, in the end.
    bool settle(const std::vector<Plane>& holding)
    {
        for (int round = 0; round < 60; ++round)
        {
            bool held = true;
            for (const Plane& plane : holding)
            {
                const double violation = -gap(plane);
                if (violation <= 0) continue;
                held = held && violation < 1e-7;
                for (std::size_t k = 0; k < std::size_t(plane.m_count); ++k)
                    m_x[m_place.at(plane.m_nodes[k])] +=
                        violation * plane.m_weights[k] / plane.m_lengths2 * plane.m_normal;
            }
            if (!keepInTubes() && held) return true;
        }
        return false;
    }

private:
    // Returns whether any node was out of its tube.
    bool keepInTubes()
    {
        bool any = false;
        for (std::size_t k = 0; k < 3; ++k)
        {
            const double length2 = dot(m_way[k], m_way[k]);
            const double along = length2 > 0 ? dot(m_x[k] - m_start[k], m_way[k]) / length2 : 0;
            const Vector3 on = m_start[k] + std::min(1.0, std::max(0.0, along)) * m_way[k];
            const double far = length(m_x[k] - on);
            if (far <= m_radius + 1e-7) continue;
            m_x[k] = on + m_radius / far * (m_x[k] - on);
            any = true;
        }
        return any;
    }

    double m_radius;
    std::array<Vector3, 3> m_start = {}, m_way = {}, m_x = {};
    std::map<std::uint32_t, std::size_t> m_place;
};

std::vector<Contact> missing(const std::vector<Contact>& all, const std::vector<Contact>& kept)
{
    const auto before = [](const Contact& a, const Contact& b)
    { return std::tie(a.m_slot, a.m_obstacleFeature) < std::tie(b.m_slot, b.m_obstacleFeature); };
    std::vector<Contact> dropped;
    std::set_difference(all.begin(), all.end(), kept.begin(), kept.end(), std::back_inserter(dropped), before);
    return dropped;
}

// Kept contacts of the same feature, and of its nodes: a node's slot is its number.
std::vector<Plane> holdingOf(const Reduced& reduced, const Contact& dropped, const Plane& plane)
{
    std::vector<Plane> holding;
    for (const Contact& contact : reduced.m_kept)
    {
        const auto last = plane.m_nodes.begin() + plane.m_count;
        const bool ofNode = std::find(plane.m_nodes.begin(), last, contact.m_slot) != last;
        if (contact.m_slot == dropped.m_slot || ofNode)
            holding.push_back(planeOf(*reduced.m_pipeline, contact, double(reduced.m_case.m_thickness)));
    }
    return holding;
}

// A cloth at rest: each node about the thickness above what is below it, and in the step as much lower as it falls.
StepCase restingCase(const TriangleMesh& obstacle, int nodes, float size, float thickness, std::uint32_t seed)
{
    Random random(seed);
    StepCase step = {"cloth at rest", seed, makeClothGrid(nodes, nodes, size, 1.0f).m_mesh, obstacle, {}, thickness};
    translate(step.m_cloth.m_positions, random.uniform(-0.1f, 0.1f), 0, random.uniform(-0.1f, 0.1f));
    drapeOver(obstacle, step.m_cloth, 0.99f * thickness, 1.02f * thickness, random);
    step.m_end = step.m_cloth.m_positions;
    translate(step.m_end, 0, -0.1f * thickness, 0);
    disturb(step.m_end, 0.05f * thickness, random);
    return step;
}

std::vector<StepCase> cases()
{
    std::vector<StepCase> all;
    std::uint32_t seed = 1400;
    for (const char* shape : {"sphere", "box", "torus", "terrain"})
    {
        all.push_back(restingCase(shapeNamed(shape), 33, 1.1f, 0.03f, ++seed));
        all.push_back(restingCase(shapeNamed(shape), 9, 1.1f, 0.1f, ++seed));
        all.push_back(drapedCase(shape, 9, 0.03f, ++seed));
        all.push_back(fallingCase(shape, 25, 0.03f, ++seed));
    }
    return all;
}

// Faces and edges with hundreds of contacts each, on a fine, nearly flat obstacle.
std::vector<StepCase> crowdedCases()
{
    std::vector<StepCase> all;
    for (std::uint32_t seed = 1600; seed < 1604; ++seed)
    {
        const TriangleMesh ground = makeTerrain(2.0f, seed % 2 == 0 ? 0.01f : 0.05f, 60, seed);
        all.push_back(restingCase(ground, 3 + int(seed % 2), 1.1f, 0.03f, seed));
    }
    return all;
}
}  // namespace

TEST(Reduction, WhatStaysKeepsWhatIsLeftOut)
{
    std::size_t settled = 0, left = 0, tight = 0;
    double least = 0;  // share of the promise
    std::vector<StepCase> all = cases();
    for (const StepCase& step : crowdedCases())
        all.push_back(step);
    for (const StepCase& step : all)
    {
        SCOPED_TRACE(step.trace());
        const Reduced reduced(allBackends()[0].m_settings, step);
        ASSERT_TRUE(reduced.m_pipeline);
        const std::vector<Contact> dropped = missing(reduced.m_all, reduced.m_kept);
        EXPECT_EQ(dropped.size(), reduced.m_counted);
        EXPECT_EQ(dropped.size() + reduced.m_kept.size(), reduced.m_all.size());
        left += dropped.size();
        Random random(step.m_seed);
        const double thickness = double(step.m_thickness);
        for (const Contact& contact : dropped)
        {
            const Plane plane = planeOf(*reduced.m_pipeline, contact, thickness);
            const std::vector<Plane> holding = holdingOf(reduced, contact, plane);
            for (int draw = 0; draw < 12; ++draw)
            {
                Sample sample(step, plane);
                sample.draw(plane, random);
                if (!sample.settle(holding)) continue;
                ++settled;
                const double gap = sample.gap(plane);
                tight += gap < 0.1 * thickness;
                least = std::min(least, gap / (kPromised * thickness));
                ASSERT_GE(gap, -kPromised * thickness - kRounding) << "draw " << draw << ": " << describe(contact);
            }
        }
    }
    EXPECT_GT(left, 500u);
    EXPECT_GT(settled, 3 * left);
    EXPECT_GT(tight, left / 4) << "samples that come near to what was left out";
    EXPECT_LT(least, -0.1) << "the tolerance is made use of";
}

// A contact that met during the step stays; so does one of every feature that had any, or of each of its nodes.
TEST(Reduction, MeetingsAndTheNodesOfContactsStay)
{
    std::size_t met = 0;
    for (const StepCase& step : cases())
    {
        SCOPED_TRACE(step.trace());
        const Reduced reduced(allBackends()[0].m_settings, step);
        ASSERT_TRUE(reduced.m_pipeline);
        std::vector<bool> before(step.m_cloth.vertexCount()), after(before);
        const auto mark = [&](const Contact& contact, std::vector<bool>& nodes)
        {
            const ClothFeature feature = reduced.m_pipeline->clothFeature(contact);
            for (std::size_t k = 0; k < 3 && feature.m_nodes[k] >= 0; ++k)
                nodes[std::size_t(feature.m_nodes[k])] = true;
        };
        for (const Contact& contact : reduced.m_all)
            mark(contact, before);
        for (const Contact& contact : reduced.m_kept)
            mark(contact, after);
        EXPECT_EQ(before, after);
        for (const Contact& contact : missing(reduced.m_all, reduced.m_kept))
            EXPECT_EQ(contact.m_time, 1.0f) << describe(contact);
        met += std::size_t(std::count_if(reduced.m_all.begin(), reduced.m_all.end(),
                                         [](const Contact& contact) { return contact.m_time < 1; }));
    }
    EXPECT_GT(met, 100u);
}

// Of two kept contacts of a node the deeper does not imply the other within the tolerance, by numbers of its own.
TEST(Reduction, KeptContactsOfANodeDisagree)
{
    std::size_t pairs = 0;
    for (const StepCase& step : cases())
    {
        SCOPED_TRACE(step.trace());
        const Reduced reduced(allBackends()[0].m_settings, step);
        ASSERT_TRUE(reduced.m_pipeline);
        const double thickness = double(step.m_thickness);
        for (const Contact& deeper : reduced.m_kept)
        {
            if (deeper.m_kind != DRAPE_NODE_FACE || double(deeper.m_gap0) < 0.9 * thickness + kRounding) continue;
            for (const Contact& other : reduced.m_kept)
            {
                if (other.m_slot != deeper.m_slot || other.m_time < 1 || !(deeper.m_gap1 < other.m_gap1)) continue;
                const Vector3 turn = vectorOf(other.m_normal) - vectorOf(deeper.m_normal);
                const Vector3 way = position(step.m_end, deeper.m_clothFeature) -
                                    position(step.m_cloth.m_positions, deeper.m_clothFeature);
                const double need = double(kTubeShare) * thickness * length(turn) + std::max(0.0, dot(turn, way));
                EXPECT_LT(double(other.m_gap1) - double(deeper.m_gap1) + kOneFeature * thickness, need + kRounding)
                    << describe(deeper) << '\n'
                    << describe(other);
                ++pairs;
            }
        }
    }
    EXPECT_GT(pairs, 20u);
}

// Beside a solid no two contacts of a node push against each other; at the edges of a box, square to one another.
TEST(Reduction, NodesOverConvexEdgesHaveNoOpposingNormals)
{
    std::size_t pairs = 0;
    for (std::uint32_t seed = 1500; seed < 1506; ++seed)
    {
        const StepCase step = drapedCase(seed % 2 == 0 ? "box" : "sphere", 33, 0.03f, seed);
        SCOPED_TRACE(step.trace());
        const Reduced reduced(allBackends()[0].m_settings, step);
        ASSERT_TRUE(reduced.m_pipeline);
        for (const Contact& a : reduced.m_kept)
        {
            if (a.m_kind != DRAPE_NODE_FACE) continue;
            for (const Contact& b : reduced.m_kept)
            {
                if (b.m_slot != a.m_slot || b.m_obstacleFeature <= a.m_obstacleFeature) continue;
                EXPECT_GT(dot(vectorOf(a.m_normal), vectorOf(b.m_normal)), -0.01) << describe(a) << describe(b);
                ++pairs;
            }
        }
    }
    EXPECT_GT(pairs, 0u);
}

// The obstacle's triangles in reverse: the deepest contact of each feature is the same place, and as many stay but for
// ties at seams, which either neighbour may report.
TEST(Reduction, NumberingDoesNotMatter)
{
    for (const StepCase& step : cases())
    {
        SCOPED_TRACE(step.trace());
        StepCase reversed = step;
        std::vector<std::int32_t>& triangles = reversed.m_obstacle.m_triangles;
        for (std::size_t t = 0; t < step.m_obstacle.triangleCount(); ++t)
            std::copy_n(step.m_obstacle.m_triangles.end() - std::ptrdiff_t(3 * (t + 1)), 3,
                        triangles.begin() + std::ptrdiff_t(3 * t));
        const Reduced first(allBackends()[0].m_settings, step), second(allBackends()[0].m_settings, reversed);
        ASSERT_TRUE(first.m_pipeline && second.m_pipeline);
        std::map<std::uint32_t, float> deepest[2];
        const std::vector<Contact>* lists[2] = {&first.m_kept, &second.m_kept};
        for (int k = 0; k < 2; ++k)
            for (const Contact& contact : *lists[k])
            {
                const auto at = deepest[k].emplace(contact.m_slot, contact.m_gap1).first;
                at->second = std::min(at->second, contact.m_gap1);
            }
        std::size_t alone = 0;
        for (const auto& slot : deepest[0])
        {
            const auto other = deepest[1].find(slot.first);
            if (other == deepest[1].end())
                ++alone;
            else
                EXPECT_NEAR(slot.second, other->second, 1e-5f) << "slot " << slot.first;
        }
        EXPECT_LE(50 * alone, deepest[0].size());
        EXPECT_NEAR(double(first.m_kept.size()), double(second.m_kept.size()), 0.02 * double(first.m_kept.size()));
    }
}

namespace
{
// Two long slopes that meet in a ridge along z at the height 0; the angle is each one's fall.
TriangleMesh roof(double angle)
{
    const float x = float(std::cos(angle)), y = float(-std::sin(angle));
    TriangleMesh mesh;
    mesh.m_positions = {0, 0, -2, 0, 0, 2, x, y, -2, x, y, 2, -x, y, -2, -x, y, 2};
    mesh.m_triangles = {0, 1, 2, 1, 3, 2, 0, 4, 1, 1, 4, 5};
    return mesh;
}
}  // namespace

// A node that slides over a ridge at the thickness: the direction of its deepest contact turns with it around the
// ridge, and by no more in a step than the node moves, seen from there.
TEST(Reduction, NormalsTurnSteadilyOverARidge)
{
    constexpr float kThickness = 0.02f;
    constexpr double kAngle = 0.5, kMove = 0.0005;  // rad; m a step
    const std::unique_ptr<Pipeline> pipeline = makePipeline(allBackends()[0].m_settings);
    ASSERT_TRUE(pipeline);
    const MeshId obstacle = addObstacle(*pipeline, roof(kAngle));
    const TriangleMesh cloth = looseTriangles({0, 0, 0, 0, 0.3f, 0.1f, 0.1f, 0.3f, 0});
    const MeshId id = addCloth(*pipeline, cloth);
    std::vector<float> before;
    double turned = 0, last = 0;
    for (int step = 0; step < 120; ++step)
    {
        // Along the left slope, around the ridge, down the right one; path length from the ridge's middle.
        const double at = (step - 60) * kMove, arc = kThickness * kAngle;
        const double turn = std::max(-kAngle, std::min(kAngle, at / kThickness));
        const double beyond = std::abs(at) > arc ? (at > 0 ? at - arc : at + arc) : 0;
        std::vector<float> now = cloth.m_positions;
        translate(now, float(kThickness * std::sin(turn) + beyond * std::cos(turn)),
                  float(kThickness * std::cos(turn) - beyond * std::sin(turn)), 0.013f);
        setMotion(*pipeline, id, before.empty() ? now : before, now);
        pipeline->addPair(id, obstacle, kThickness, kTubeShare * kThickness);
        before = now;
        float least = 1;
        Vector3 normal = {0, 0, 0};
        for (const Contact& contact : runStep(*pipeline))
        {
            if (contact.m_kind != DRAPE_NODE_FACE || contact.m_slot != 0 || contact.m_gap1 >= least) continue;
            least = contact.m_gap1;
            normal = vectorOf(contact.m_normal);
        }
        ASSERT_NEAR(length(normal), 1, 1e-5) << "step " << step;
        const double angle = std::atan2(normal.x, normal.y);
        if (step > 0)
            EXPECT_LE(std::abs(angle - last), kMove / kThickness + 1e-3) << "step " << step;
        else
            EXPECT_NEAR(angle, -kAngle, 1e-3);
        turned += std::abs(angle - last) * (step > 0);
        last = angle;
    }
    EXPECT_NEAR(turned, 2 * kAngle, 0.01) << "there and not back";
}

class ReductionTest : public BackendTest
{
};

// Slots of a few contacts and of hundreds: what stays is the same on every back end.
TEST_P(ReductionTest, LeavesTheSameOnHostAndDevice)
{
    std::vector<StepCase> all = cases();
    for (const StepCase& step : crowdedCases())
        all.push_back(step);
    all.push_back(soupCase(300, 3000, false, 1610));
    all.push_back(restingCase(makeTerrain(2.0f, 0.01f, 160, 1611), 3, 1.1f, 0.03f, 1611));
    std::size_t many = 0, crowded = 0;
    for (const StepCase& step : all)
    {
        SCOPED_TRACE(step.trace());
        const Reduced host(allBackends()[0].m_settings, step), device(GetParam().m_settings, step);
        ASSERT_TRUE(host.m_pipeline && device.m_pipeline);
        ASSERT_TRUE(sameBytes(device.m_kept, host.m_kept)) << difference(device.m_kept, host.m_kept);
        EXPECT_EQ(device.m_counted, host.m_counted);
        std::map<std::uint32_t, std::size_t> bySlot;
        for (const Contact& contact : host.m_all)
        {
            const std::size_t count = ++bySlot[contact.m_slot];
            many += count == DRAPE_RANKED + 1;
            crowded += count == kCrowded + 1;
        }
    }
    EXPECT_GT(many, 10u);
    EXPECT_GT(crowded, 2u);
}

// Which slots are put in order on the way differs between them.
TEST_P(ReductionTest, StepsWithAndWithoutItTakeTurns)
{
    for (const StepCase& step : crowdedCases())
    {
        SCOPED_TRACE(step.trace());
        const Reduced host(allBackends()[0].m_settings, step);
        const std::unique_ptr<Pipeline> pipeline = makePipeline(GetParam().m_settings);
        ASSERT_TRUE(host.m_pipeline && pipeline);
        const MeshId cloth = addCloth(*pipeline, step.m_cloth), obstacle = addObstacle(*pipeline, step.m_obstacle);
        for (const bool reduces : {false, true, true, false, true})
        {
            setMotion(*pipeline, cloth, step.m_cloth.m_positions, step.m_end);
            pipeline->addPair(cloth, obstacle, step.m_thickness, reduces ? kTubeShare * step.m_thickness : -1.0f);
            const std::vector<Contact> found = runStep(*pipeline), &expected = reduces ? host.m_kept : host.m_all;
            EXPECT_TRUE(sameBytes(found, expected)) << difference(found, expected);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, ReductionTest, testing::ValuesIn(openClBackends()), backendName);
}  // namespace drape::test
