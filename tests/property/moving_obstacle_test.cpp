// Obstacles that move in the step: the same contacts as the cloth's motion relative to them gives, on every back end
// and with every traversal.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/lib/rigid_motion.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"
#include "tests/support/traversals.h"

namespace drape::test
{
namespace
{
// A turn by `angle` about a random axis through `centre`, then a shift, in double.
struct Motion
{
    double m_rows[3][4];

    std::array<double, 3> at(const double* p) const
    {
        std::array<double, 3> q;
        for (std::size_t i = 0; i < 3; ++i)
            q[i] = m_rows[i][0] * p[0] + m_rows[i][1] * p[1] + m_rows[i][2] * p[2] + m_rows[i][3];
        return q;
    }
    Pose pose() const
    {
        Pose pose;
        for (std::size_t i = 0; i < pose.size(); ++i)
            pose[i] = float(m_rows[i / 4][i % 4]);
        return pose;
    }
};

Motion motionOf(double angle, const std::array<double, 3>& shift, Random& random)
{
    double axis[3], length = 0;
    for (double& a : axis)
    {
        a = random.uniform(-1.0f, 1.0f);
        length += a * a;
    }
    const double c = std::cos(angle), s = std::sin(angle);
    Motion motion;
    for (int i = 0; i < 3; ++i)
    {
        axis[i] /= std::sqrt(length);
        motion.m_rows[i][3] = shift[std::size_t(i)];
    }
    const double cross[3][3] = {{0, -axis[2], axis[1]}, {axis[2], 0, -axis[0]}, {-axis[1], axis[0], 0}};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            motion.m_rows[i][k] = (i == k ? c : 0) + (1 - c) * axis[i] * axis[k] + s * cross[i][k];
    return motion;
}

// pose after the inverse of `of`, which is rigid.
Motion relative(const Motion& pose, const Motion& of)
{
    Motion result;
    for (int i = 0; i < 3; ++i)
    {
        result.m_rows[i][3] = pose.m_rows[i][3];
        for (int k = 0; k < 3; ++k)
        {
            result.m_rows[i][k] = 0;
            for (int j = 0; j < 3; ++j)
                result.m_rows[i][k] += pose.m_rows[i][j] * of.m_rows[k][j];
        }
        for (int k = 0; k < 3; ++k)
            result.m_rows[i][3] -= result.m_rows[i][k] * of.m_rows[k][3];
    }
    return result;
}

std::vector<float> mapped(const Motion& motion, const std::vector<float>& positions)
{
    std::vector<float> result;
    for (std::size_t i = 0; i < positions.size(); i += 3)
    {
        const double p[3] = {positions[i], positions[i + 1], positions[i + 2]};
        for (double coordinate : motion.at(p))
            result.push_back(float(coordinate));
    }
    return result;
}

const std::array<double, 3> kNoShift = {0, 0, 0};

// What moves how: a cloth at rest or falling over an obstacle that turns and shifts within the step.
struct MovingCase
{
    StepCase m_step;
    Motion m_start, m_end;
};

// The obstacle ends where the case has it, so that the cloth passes it.
MovingCase movingCase(const std::string& shape, double angle, const std::array<double, 3>& shift, std::uint32_t seed)
{
    Random random(seed);
    MovingCase moving = {fallingCase(shape, 20, 0.03f, seed), {}, motionOf(0, kNoShift, random)};
    moving.m_start = motionOf(angle, shift, random);
    return moving;
}

std::vector<Contact> runMoving(Pipeline& pipeline, const MovingCase& moving)
{
    const StepCase& step = moving.m_step;
    const MeshId cloth = addCloth(pipeline, step.m_cloth), obstacle = addObstacle(pipeline, step.m_obstacle);
    pipeline.placeObstacle(obstacle, moving.m_start.pose().data(), moving.m_end.pose().data());
    setMotion(pipeline, cloth, step.m_cloth.m_positions, step.m_end);
    pipeline.addPair(cloth, obstacle, step.m_thickness);
    return runStep(pipeline);
}

// The same with the obstacle at rest at its end and the cloth's start moved instead.
std::vector<Contact> runOpposite(Pipeline& pipeline, const MovingCase& moving)
{
    StepCase step = moving.m_step;
    step.m_cloth.m_positions = mapped(relative(moving.m_end, moving.m_start), step.m_cloth.m_positions);
    step.m_obstacle.m_positions = mapped(moving.m_end, step.m_obstacle.m_positions);
    return runCase(pipeline, step);
}

bool sameFeatures(const Contact& a, const Contact& b)
{
    return a.m_slot == b.m_slot && a.m_kind == b.m_kind && a.m_obstacleFeature == b.m_obstacleFeature;
}

// How many contacts of `a` are in `b` with numbers that differ by rounding only; both in canonical order.
std::size_t countAlike(const std::vector<Contact>& a, const std::vector<Contact>& b)
{
    std::size_t alike = 0;
    for (const Contact& contact : a)
    {
        const auto found =
            std::find_if(b.begin(), b.end(), [&](const Contact& other) { return sameFeatures(contact, other); });
        if (found == b.end()) continue;
        double off = std::fabs(contact.m_gap0 - found->m_gap0) + std::fabs(contact.m_gap1 - found->m_gap1);
        for (int i = 0; i < 3; ++i)
        {
            off = std::max(off, std::fabs(double(contact.m_normal[i]) - double(found->m_normal[i])));
            off = std::max(off, std::fabs(double(contact.m_point[i]) - double(found->m_point[i])));
        }
        if (off < 2e-3) ++alike;
    }
    return alike;
}

const double kAngles[] = {0.0, 0.05, 0.7, 2.5};
}  // namespace

class MovingObstacleTest : public BackendTest
{
protected:
    std::unique_ptr<Pipeline> make() { return makePipeline(GetParam().m_settings); }
};

TEST_P(MovingObstacleTest, GivesWhatTheOppositeMotionOfTheClothGives)
{
    std::uint32_t seed = 900;
    for (double angle : kAngles)
    {
        const MovingCase moving = movingCase("torus", angle, {0.3, -0.2, 0.4}, ++seed);
        SCOPED_TRACE(moving.m_step.trace());
        const std::unique_ptr<Pipeline> pipeline = make(), opposite = make();
        ASSERT_TRUE(pipeline && opposite);
        const std::vector<Contact> contacts = runMoving(*pipeline, moving);
        const std::vector<Contact> expected = runOpposite(*opposite, moving);
        ASSERT_GT(expected.size(), 100u);
        // Rounding decides a few at the edge of the reach and of cones.
        EXPECT_GE(countAlike(contacts, expected), contacts.size() - contacts.size() / 50);
        EXPECT_GE(countAlike(expected, contacts), expected.size() - expected.size() / 50);
    }
}

// The cloth lies on the obstacle and moves with it.
void carryCloth(MovingCase& moving)
{
    const std::vector<float> lying = moving.m_step.m_cloth.m_positions;
    moving.m_step.m_cloth.m_positions = mapped(moving.m_start, lying);
    moving.m_step.m_end = mapped(moving.m_end, lying);
}

// A cloth that moves with the obstacle stays as far from it as it was.
TEST_P(MovingObstacleTest, ClothThatIsCarriedAlongPassesNothing)
{
    Random random(910);
    MovingCase moving = {drapedCase("sphere", 20, 0.03f, 910), motionOf(0.6, {1, 2, 3}, random),
                         motionOf(1.0, {-1, 0.5, 2}, random)};
    SCOPED_TRACE(moving.m_step.trace());
    carryCloth(moving);
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    const std::vector<Contact> contacts = runMoving(*pipeline, moving);
    ASSERT_GT(contacts.size(), 100u);
    for (const Contact& contact : contacts)
    {
        EXPECT_NEAR(contact.m_gap0, contact.m_gap1, 1e-5f) << describe(contact);
        EXPECT_EQ(contact.m_time, 1.0f) << describe(contact);
    }
}

// Pipeline::planeAt() takes the contact's point for its vertex.
TEST_P(MovingObstacleTest, PointOfAVertexIsItsPlaceAtTheEnd)
{
    Random random(915);
    MovingCase moving = {drapedCase("sphere", 12, 0.03f, 915), motionOf(0.6, {1, 2, 3}, random),
                         motionOf(0.7, {1, 2.1, 3}, random)};
    SCOPED_TRACE(moving.m_step.trace());
    carryCloth(moving);
    const std::unique_ptr<Pipeline> pipeline = make();
    ASSERT_TRUE(pipeline);
    const Pose end = moving.m_end.pose();
    std::size_t vertices = 0;
    for (const Contact& contact : runMoving(*pipeline, moving))
    {
        if (contact.m_kind != DRAPE_FACE_VERTEX) continue;
        const Vec3 own = vec3Load(moving.m_step.m_obstacle.m_positions.data(), contact.m_obstacleFeature);
        const Vec3 place = mapPoint(end.data(), own);
        EXPECT_EQ(contact.m_point[0], place.x) << describe(contact);
        EXPECT_EQ(contact.m_point[1], place.y) << describe(contact);
        EXPECT_EQ(contact.m_point[2], place.z) << describe(contact);
        ++vertices;
    }
    EXPECT_GT(vertices, 50u);
}

TEST_P(MovingObstacleTest, EqualPosesAreATeleport)
{
    const MovingCase moving = movingCase("box", 0.0, {0.0, 1.0, 0.0}, 920);
    SCOPED_TRACE(moving.m_step.trace());
    const std::unique_ptr<Pipeline> pipeline = make(), rests = make();
    ASSERT_TRUE(pipeline && rests);
    const StepCase& step = moving.m_step;
    const MeshId cloth = addCloth(*pipeline, step.m_cloth), obstacle = addObstacle(*pipeline, step.m_obstacle);
    const Pose far = moving.m_start.pose(), near = moving.m_end.pose();
    std::vector<Contact> contacts;
    for (const Pose& pose : {far, near})
    {
        pipeline->placeObstacle(obstacle, pose.data(), pose.data());
        setMotion(*pipeline, cloth, step.m_end, step.m_end);
        pipeline->addPair(cloth, obstacle, step.m_thickness);
        contacts = runStep(*pipeline);
    }
    MovingCase resting = moving;
    resting.m_start = resting.m_end;
    resting.m_step.m_cloth.m_positions = step.m_end;
    const std::vector<Contact> expected = runMoving(*rests, resting);
    EXPECT_GT(expected.size(), 20u);
    EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
}

namespace
{
// Several obstacles beside each other, of which some move, under one cloth each.
struct Scenery
{
    std::vector<MovingCase> m_cases;

    explicit Scenery(std::uint32_t seed)
    {
        const char* const shapes[] = {"torus", "sphere", "bowl", "box"};
        for (std::uint32_t i = 0; i < 4; ++i)
        {
            const double angle = i == 0 ? 0.0 : kAngles[i];
            m_cases.push_back(movingCase(shapes[i], angle, {0.1 * i, -0.3 * i, 0.2}, seed + i));
            if (i == 1) m_cases.back().m_start = m_cases.back().m_end;  // rests
        }
    }
};

// All cloths against all obstacles, a pair left out.
std::vector<Contact> runScenery(Pipeline& pipeline, const Scenery& scenery)
{
    std::vector<MeshId> cloths, obstacles;
    for (const MovingCase& moving : scenery.m_cases)
    {
        cloths.push_back(addCloth(pipeline, moving.m_step.m_cloth));
        obstacles.push_back(addObstacle(pipeline, moving.m_step.m_obstacle));
    }
    for (std::size_t i = 0; i < cloths.size(); ++i)
    {
        const MovingCase& moving = scenery.m_cases[i];
        pipeline.placeObstacle(obstacles[i], moving.m_start.pose().data(), moving.m_end.pose().data());
        setMotion(pipeline, cloths[i], moving.m_step.m_cloth.m_positions, moving.m_step.m_end);
    }
    for (std::size_t i = 0; i < cloths.size(); ++i)
        for (std::size_t k = 0; k < obstacles.size(); ++k)
            if (i != 2 || k != 3) pipeline.addPair(cloths[i], obstacles[k], 0.03f);
    return runStep(pipeline);
}

// The contacts of every pair of triangles, without a broad phase.
std::vector<Contact> contactsOfAllPairs(const Scenery& scenery, float reachScale)
{
    std::vector<TriangleMesh> cloths, obstacles;
    std::vector<float> ends, thickness(16, 0.03f);
    thickness[2 * 4 + 3] = -1.0f;
    for (const MovingCase& moving : scenery.m_cases)
    {
        cloths.push_back(moving.m_step.m_cloth);
        obstacles.push_back(moving.m_step.m_obstacle);
        ends.insert(ends.end(), moving.m_step.m_end.begin(), moving.m_step.m_end.end());
    }
    Side cloth = makeSide(cloths), obstacle = makeSide(obstacles);
    cloth.m_end = ends;
    std::vector<ObstacleMotion> motions;
    for (std::uint32_t i = 0; i < 4; ++i)
    {
        ObstaclePlacing placing;
        placing.m_posed = true;
        placing.m_start = scenery.m_cases[i].m_start.pose();
        placing.m_end = scenery.m_cases[i].m_end.pose();
        if (placing.moves()) motions.push_back(makeMotion(placing, MeshBox{{0, 0, 0}, {0, 0, 0}}, i));
    }
    std::vector<Candidate> pairs = allPairs(cloth, obstacle);
    pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                               [&](Candidate pair)
                               {
                                   const std::uint32_t row = cloth.m_pool.triangles()[pair.m_cloth].m_mesh * 4;
                                   return thickness[row + obstacle.m_pool.triangles()[pair.m_obstacle].m_mesh] < 0.0f;
                               }),
                pairs.end());
    std::vector<Contact> contacts;
    const MotionList list = {motions.data(), std::uint32_t(motions.size())};
    narrowPhaseOnHost(pairs, cloth.cloth(), obstacle.obstacle(), {thickness, 4, reachScale, DRAPE_AUTOMATIC, list},
                      contacts);
    return contacts;
}
}  // namespace

// Every traversal finds what testing every pair of triangles finds, bit for bit: the end poses are the identity, so
// that the obstacles' positions are those given.
TEST_P(MovingObstacleTest, NoPairIsLost)
{
    for (std::uint32_t seed : {930u, 940u, 950u})
    {
        const Scenery scenery(seed);
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::vector<Contact> expected = contactsOfAllPairs(scenery, 1.0f + Settings().m_activation);
        ASSERT_GT(expected.size(), 1000u);
        for (Traversal traversal : {Traversal::Auto, Traversal::Pairs, Traversal::Front, Traversal::Leaves,
                                    Traversal::WideLeaves, Traversal::WideGroups})
        {
            SCOPED_TRACE("traversal " + std::to_string(int(traversal)));
            Settings settings = GetParam().m_settings;
            settings.m_methods.m_traversal = traversal;
            const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
            ASSERT_TRUE(pipeline);
            const std::vector<Contact> contacts = runScenery(*pipeline, scenery);
            EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
        }
    }
}

// Obstacles that are placed anew, one, some or all of them, and change back: the same as a new pipeline, on host and
// device.
TEST_P(MovingObstacleTest, PlacingAnewEqualsRebuild)
{
    Random random(960);
    const Scenery scenery(960);
    const std::unique_ptr<Pipeline> old = make();
    ASSERT_TRUE(old);
    std::vector<MeshId> cloths, obstacles;
    for (const MovingCase& moving : scenery.m_cases)
    {
        cloths.push_back(addCloth(*old, moving.m_step.m_cloth));
        obstacles.push_back(addObstacle(*old, moving.m_step.m_obstacle));
    }
    std::vector<Motion> poses(4, motionOf(0, kNoShift, random));
    for (std::uint32_t step = 0; step < 12; ++step)
    {
        SCOPED_TRACE("seed 960, step " + std::to_string(step));
        Settings host = allBackends()[0].m_settings;
        const std::unique_ptr<Pipeline> fresh = makePipeline(host);
        ASSERT_TRUE(fresh);
        std::vector<Motion> before = poses;
        for (std::size_t i = 0; i < poses.size(); ++i)
            if (step > 0 && (step >> (i % 3)) & 1u)
                poses[i] = motionOf(random.uniform(-0.2f, 0.2f), {random.uniform(-0.1f, 0.1f), 0, 0.05}, random);
        std::vector<MeshId> freshCloths, freshObstacles;
        for (std::size_t i = 0; i < 4; ++i)
        {
            freshCloths.push_back(addCloth(*fresh, scenery.m_cases[i].m_step.m_cloth));
            freshObstacles.push_back(addObstacle(*fresh, scenery.m_cases[i].m_step.m_obstacle));
        }
        for (std::size_t i = 0; i < 4; ++i)
        {
            const StepCase& now = scenery.m_cases[i].m_step;
            if (step > 1 || i < 2)
            {
                old->placeObstacle(obstacles[i], before[i].pose().data(), poses[i].pose().data());
                fresh->placeObstacle(freshObstacles[i], before[i].pose().data(), poses[i].pose().data());
            }
            setMotion(*old, cloths[i], now.m_cloth.m_positions, now.m_end);
            setMotion(*fresh, freshCloths[i], now.m_cloth.m_positions, now.m_end);
            old->addPair(cloths[i], obstacles[i], 0.03f);
            fresh->addPair(freshCloths[i], freshObstacles[i], 0.03f);
        }
        const std::vector<Contact> placed = runStep(*old), rebuilt = runStep(*fresh);
        EXPECT_GT(rebuilt.size(), 200u);
        ASSERT_TRUE(sameBytes(placed, rebuilt)) << difference(placed, rebuilt);
    }
}

// An obstacle at rest costs no launch, with a place or without.
TEST_P(MovingObstacleTest, RestCostsNoLaunch)
{
    Settings settings = GetParam().m_settings;
    settings.m_profileKernels = true;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
    ASSERT_TRUE(pipeline);
    const StepCase step = fallingCase("sphere", 12, 0.03f, 970);
    SCOPED_TRACE(step.trace());
    const MeshId cloth = addCloth(*pipeline, step.m_cloth), obstacle = addObstacle(*pipeline, step.m_obstacle);
    Random random(970);
    const Pose rest = motionOf(0, kNoShift, random).pose(), shifted = motionOf(0, {0, 0.1, 0}, random).pose();
    const auto launches = [&]
    {
        pipeline->takeKernelTimes();
        setMotion(*pipeline, cloth, step.m_cloth.m_positions, step.m_end);
        pipeline->addPair(cloth, obstacle, step.m_thickness);
        EXPECT_FALSE(runStep(*pipeline).empty());
        return pipeline->takeKernelTimes().size();
    };
    launches();  // uploads and packs
    const std::size_t without = launches();
    pipeline->placeObstacle(obstacle, rest.data(), rest.data());
    launches();
    pipeline->placeObstacle(obstacle, rest.data(), rest.data());
    EXPECT_EQ(launches(), without);
    pipeline->placeObstacle(obstacle, rest.data(), shifted.data());
    const std::size_t moving = launches();
    EXPECT_TRUE(moving > without || GetParam().m_device < 0);
}

namespace
{
Motion shiftOf(double x, double y, double z)
{
    Random random(0);
    return motionOf(0, {x, y, z}, random);
}

// A triangle of cloth over the edge of a thin plate that rises by half a metre a step, 45 m up: its last node ends
// level with the plate's upper face to the last bit, 24 mm beside it, where the edge between upper face and side admits
// it.
MovingCase plateCase()
{
    StepCase step = {"plate", 0, {}, makeBox(1.2f, 0.004f, 1.2f), {}, 0.02f};
    translate(step.m_obstacle.m_positions, 0, 1, 0);
    step.m_cloth = looseTriangles({0.622380614f, 46.0153351f, -0.460110068f, 0.563151419f, 46.0354156f, -0.409699768f,
                                   0.623653889f, 46.0150299f, -0.403629512f});
    step.m_end = {0.622198939f,  46.5014725f, -0.460117459f, 0.563080788f, 46.5234604f,
                  -0.409705281f, 0.62371707f, 46.5019989f,   -0.403637558f};
    return {step, shiftOf(0, 45, 0), shiftOf(0, 45.5, 0)};
}

// Every traversal gives on this back end what the host gives.
void expectHostsContacts(const BackendCase& backend, const MovingCase& moving, const std::vector<Contact>& expected)
{
    std::vector<Traversal> traversals = allTraversals();
    traversals.push_back(Traversal::Auto);
    for (const Traversal traversal : traversals)
    {
        SCOPED_TRACE(traversalName(traversal));
        Settings settings = backend.m_settings;
        settings.m_methods.m_traversal = traversal;
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
        ASSERT_TRUE(pipeline);
        const std::vector<Contact> contacts = runMoving(*pipeline, moving);
        EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
    }
}
}  // namespace

TEST_P(MovingObstacleTest, NodeThatEndsLevelWithAPlatesFaceBesideIt)
{
    const MovingCase moving = plateCase();
    const std::unique_ptr<Pipeline> host = makePipeline(allBackends()[0].m_settings);
    ASSERT_TRUE(host);
    const std::vector<Contact> expected = runMoving(*host, moving);
    const auto beside = [](const Contact& contact)
    { return contact.m_kind == DRAPE_NODE_FACE && contact.m_clothFeature == 2 && contact.m_normal[0] > 0.999f; };
    EXPECT_TRUE(std::any_of(expected.begin(), expected.end(), beside));
    expectHostsContacts(GetParam(), moving, expected);
}

// Faces of 3 mm whose corners are rounded to 0.1 mm where they are placed, so that they turn, and their cones do not.
TEST_P(MovingObstacleTest, SmallFacesPlacedFarOut)
{
    for (std::uint32_t seed = 970; seed < 974; ++seed)
    {
        Random random(seed);
        const Motion far = motionOf(0.4, {1200, 900, -1100}, random);
        MovingCase moving = {{"far out", seed, {}, makeTorus(0.05f, 0.02f, 96, 48), {}, 0.02f}, far, far};
        std::vector<float> corners;
        for (int i = 0; i < 1000; ++i)
        {
            const Vec3 middle = {random.uniform(-0.1f, 0.1f), random.uniform(-0.05f, 0.05f),
                                 random.uniform(-0.1f, 0.1f)};
            for (int k = 0; k < 3; ++k)
                for (const float coordinate : {middle.x, middle.y, middle.z})
                    corners.push_back(coordinate + random.uniform(-0.002f, 0.002f));
        }
        moving.m_step.m_cloth = looseTriangles(corners);
        moving.m_step.m_end = moving.m_step.m_cloth.m_positions = mapped(far, corners);
        SCOPED_TRACE(moving.m_step.trace());
        const std::unique_ptr<Pipeline> host = makePipeline(allBackends()[0].m_settings), pipeline = make();
        ASSERT_TRUE(host && pipeline);
        const std::vector<Contact> expected = runMoving(*host, moving), contacts = runMoving(*pipeline, moving);
        EXPECT_GT(expected.size(), 1000u);
        EXPECT_TRUE(sameBytes(contacts, expected)) << difference(contacts, expected);
    }
}

INSTANTIATE_TEST_SUITE_P(Backends, MovingObstacleTest, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
