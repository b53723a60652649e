// Planes and height fields: cloth stays on its side, wherever it is, and only what is near it is read.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h"
#include "BulletCollision/CollisionShapes/btStaticPlaneShape.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"
#include "tests/support/memory.h"

namespace drape::test
{
namespace
{
ClothSpec clothAt(const btVector3& centre)
{
    ClothSpec spec;
    spec.m_centre = centre;
    return spec;
}

// Returns the least distance of a node from the plane, m; negative behind it.
btScalar leastGap(const btSoftBody& cloth, const btVector3& normal, btScalar distance)
{
    btScalar least = SIMD_INFINITY;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        least = std::min(least, normal.dot(cloth.m_nodes[i].m_x) - distance);
    return least;
}

void throwCloth(btSoftBody& cloth, const btVector3& velocity)
{
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        cloth.m_nodes[i].m_v = velocity;
}

using HeightAt = std::function<double(double x, double z)>;

// A level height field of cells x cells, with its middle at the origin. Heights up to 2 m.
class Field
{
public:
    Field(int cells, float cell, const HeightAt& heightAt) : m_points(cells + 1), m_cell(cell)
    {
        m_heights.resize(std::size_t(m_points) * std::size_t(m_points));
        set(heightAt);
        m_shape = std::make_unique<btHeightfieldTerrainShape>(m_points, m_points, m_heights.data(), btScalar(-2),
                                                              btScalar(2), 1, false);
        m_shape->setLocalScaling(btVector3(btScalar(cell), 1, btScalar(cell)));
        m_shape->setMargin(kMargin);
    }
    void set(const HeightAt& heightAt)
    {
        for (int j = 0; j < m_points; ++j)
            for (int i = 0; i < m_points; ++i)
                m_heights[std::size_t(j * m_points + i)] = float(heightAt(placeOf(i), placeOf(j)));
    }
    // Returns the shape's triangles, in its order.
    TriangleMesh mesh() const
    {
        TriangleMesh mesh;
        for (int j = 0; j < m_points; ++j)
        {
            for (int i = 0; i < m_points; ++i)
            {
                btVector3 vertex;
                m_shape->getVertex(i, j, vertex);
                mesh.m_positions.insert(mesh.m_positions.end(),
                                        {float(vertex.x()), float(vertex.y()), float(vertex.z())});
            }
        }
        const auto at = [&](int i, int j) { return j * m_points + i; };
        for (int j = 0; j + 1 < m_points; ++j)
            for (int i = 0; i + 1 < m_points; ++i)
                mesh.m_triangles.insert(mesh.m_triangles.end(), {at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j),
                                                                 at(i, j + 1), at(i + 1, j + 1)});
        return mesh;
    }
    btHeightfieldTerrainShape& shape() { return *m_shape; }

private:
    double placeOf(int i) const { return (double(i) - double(m_points - 1) / 2) * double(m_cell); }

    const int m_points;
    const float m_cell;
    std::vector<float> m_heights;
    std::unique_ptr<btHeightfieldTerrainShape> m_shape;
};

double hills(double x, double z)
{
    return 0.2 * std::sin(3 * x) * std::cos(2 * z);
}

class Surfaces : public BackendTest
{
};
}  // namespace

TEST_P(Surfaces, MoveClothWithTheSameBits)
{
    const auto hashOfRun = [](const Settings& settings)
    {
        Plugin plugin(settings);
        DropWorld world(&plugin);
        btStaticPlaneShape plane(btVector3(btScalar(0.3), 1, btScalar(0.1)), btScalar(-0.2));
        plane.setMargin(kMargin);
        Field field(64, 0.1f, hills);
        world.addObstacle(plane);
        world.addObstacle(field.shape());
        btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(0.4), 0)));
        btSoftBody& other = world.addCloth(clothAt(btVector3(btScalar(-1.5), btScalar(0.7), 0)));
        EXPECT_EQ(plugin.whyStock(&cloth, &world.addObstacle(plane)), "");
        world.step(90);
        EXPECT_GT(plugin.statistics().m_contacts, 100u);
        EXPECT_EQ(plugin.statistics().m_status, kStepGood);
        return hashOf(other, hashOf(cloth));
    };
    EXPECT_EQ(hashOfRun(GetParam().m_settings), hashOfRun(hostSettings()));
}

INSTANTIATE_TEST_SUITE_P(Backends, Surfaces, testing::ValuesIn(allBackends()), backendName);

TEST(Planes, HoldClothThatFallsAndThatIsThrown)
{
    for (const btScalar speed : {btScalar(0), btScalar(5), btScalar(300)})
    {
        SCOPED_TRACE(speed);
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        const btVector3 normal = btVector3(1, 4, 2).normalized();
        btStaticPlaneShape plane(normal, btScalar(0.5));
        plane.setMargin(kMargin);
        world.addObstacle(plane);
        btSoftBody& cloth = world.addCloth(clothAt(btVector3(2, btScalar(1.2), -1)));
        cloth.m_cfg.kDF = 1;
        throwCloth(cloth, normal * -speed);
        for (int i = 0; i < 240; ++i)
        {
            world.step();
            ASSERT_GT(leastGap(cloth, normal, btScalar(0.5)), btScalar(0.8) * kThickness) << "step " << i;
        }
        EXPECT_LT(leastGap(cloth, normal, btScalar(0.5)), btScalar(1.2) * kThickness);
        EXPECT_LT(rmsSpeed(cloth), 0.005);
        EXPECT_EQ(plugin.statistics().m_status, kStepGood);
    }
}

// The plane is read anew as the cloth leaves what was read.
TEST(Planes, FollowClothThatSlidesFarAway)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    const btVector3 normal = btVector3(btScalar(0.5), 1, 0).normalized();
    btStaticPlaneShape plane(normal, 0);
    plane.setMargin(kMargin);
    world.addObstacle(plane).setFriction(0);
    btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(0.35), 0)));
    cloth.m_cfg.kDP = 0;
    for (int i = 0; i < 300; ++i)
    {
        world.step();
        ASSERT_GT(leastGap(cloth, normal, 0), btScalar(0.8) * kThickness) << "step " << i;
        ASSERT_EQ(plugin.statistics().m_obstacleTriangles, 1u);
    }
    // Free sliding goes g sin a cos a t² / 2 = 49 m along x.
    EXPECT_GT(cloth.m_nodes[0].m_x.x(), 40);
}

TEST(Planes, HoldClothsThatLieFarFromEachOther)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btStaticPlaneShape plane(btVector3(0, 1, 0), btScalar(0.1));
    plane.setMargin(kMargin);
    world.addObstacle(plane);
    btSoftBody* cloths[] = {&world.addCloth(clothAt(btVector3(-300, btScalar(0.2), 0))),
                            &world.addCloth(clothAt(btVector3(300, btScalar(0.3), 100)))};
    world.step(120);
    for (const btSoftBody* cloth : cloths)
    {
        EXPECT_NEAR(leastGap(*cloth, btVector3(0, 1, 0), btScalar(0.1)), kThickness, 0.1f * kThickness);
        EXPECT_LT(rmsSpeed(*cloth), 0.001);
    }
}

// Bullet makes a pair of a plane and every cloth.
TEST(Planes, CostNothingFarBelowTheCloth)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    world.addObstacle(plane);
    world.addCloth(clothAt(btVector3(0, 5, 0)));
    world.step(20);
    EXPECT_TRUE(plugin.statistics().m_skipped);
}

// Bullet's own plane is a thin plate, too: cloth that starts below it is not inside of anything.
TEST(Planes, HoldClothOnEitherSide)
{
    Plugin plugin(hostSettings());
    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    plane.setMargin(kMargin);
    for (const bool oneSided : {false, true})
    {
        DropWorld world(&plugin);
        world.world().getWorldInfo().m_gravity = -world.world().getGravity();
        plugin.setOneSided(&plane, oneSided);
        world.addObstacle(plane);
        btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(-0.1), 0)));
        world.step(60);
        EXPECT_EQ(cloth.m_nodes[0].m_x.y() < 0, !oneSided);
        EXPECT_EQ(plugin.statistics().m_status, kStepGood);
    }
}

TEST(Planes, PushClothWhenTheirBodyMoves)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    plane.setMargin(kMargin);
    btRigidBody& body = world.addKinematic(plane);
    btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(0.05), 0)));
    btScalar height = 0;
    for (int i = 0; i < 120; ++i)
    {
        if (i >= 30) height += btScalar(0.1);  // 6 m/s
        body.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, height, 0)));
        world.step();
        ASSERT_GT(lowestOf(cloth), height) << "step " << i;
    }
    EXPECT_EQ(plugin.statistics().m_status, kStepGood);
}

// The part near the cloth gives the contacts of the whole mesh, bit for bit.
TEST(HeightFields, HoldClothAsTheSameMeshDoes)
{
    Field field(80, 0.1f, hills);
    MeshShape mesh(field.mesh());
    btCollisionShape* const shapes[] = {&field.shape(), &mesh.shape()};
    std::uint64_t hashes[2];
    for (int i = 0; i < 2; ++i)
    {
        Plugin plugin(hostSettings());
        DropWorld world(&plugin);
        world.addObstacle(*shapes[i], btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(0.4)), btVector3(1, 0, 2)));
        btSoftBody& cloth = world.addCloth(clothAt(btVector3(1, btScalar(0.4), 2)));
        hashes[i] = kHashStart;
        for (int step = 0; step < 120; ++step)
        {
            world.step();
            hashes[i] = hashOf(cloth, hashes[i]);
        }
        EXPECT_GT(plugin.statistics().m_contacts, 100u);
        EXPECT_LT(plugin.statistics().m_obstacleTriangles, i == 0 ? 3000u : 12801u);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(HeightFields, HoldClothThatCrossesThem)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    Field field(400, 0.1f, [](double x, double z) { return 0.1 * std::sin(2 * x) * std::cos(3 * z) - 0.1 * x; });
    world.addObstacle(field.shape()).setFriction(0);
    btSoftBody& cloth = world.addCloth(clothAt(btVector3(-12, btScalar(1.5), 0)));
    cloth.m_cfg.kDP = 0;
    throwCloth(cloth, btVector3(4, 0, 0));
    PenetrationMeter meter(field.mesh(), meshOf(cloth));
    for (int i = 0; i < 160; ++i)
    {
        world.step();
        if (i % 16 == 0)
        {
            ASSERT_EQ(meter.measure(positionsOf(cloth).data()).m_intersectingPairs, 0u) << "step " << i;
        }
        ASSERT_LT(plugin.statistics().m_obstacleTriangles, 6000u);
        ASSERT_EQ(plugin.statistics().m_status, kStepGood);
    }
    EXPECT_GT(cloth.m_nodes[0].m_x.x(), -8);
}

TEST(HeightFields, OfAnySizeCostWhatIsNearTheCloth)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    Field field(4096, 0.1f, hills);
    world.addObstacle(field.shape());
    const std::size_t before = residentBytes();
    btSoftBody* cloths[] = {&world.addCloth(clothAt(btVector3(-200, btScalar(0.4), 200))),
                            &world.addCloth(clothAt(btVector3(200, btScalar(0.4), -200)))};
    plugin.prepare(world.world());
    world.step(60);
    EXPECT_LT(residentBytes() - before, kGrowthBytes);
    EXPECT_LT(plugin.statistics().m_obstacleTriangles, 4000u);
    EXPECT_GT(plugin.statistics().m_contacts, 100u);
    for (const btSoftBody* cloth : cloths)
        EXPECT_GT(lowestOf(*cloth), btScalar(-0.2));
}

TEST(HeightFields, MoveClothWithTheirHeights)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    Field field(40, 0.1f, [](double, double) { return 0; });
    world.addObstacle(field.shape());
    btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(0.05), 0)));
    for (int i = 0; i < 120; ++i)
    {
        const double time = i / 60.0;
        const auto wave = [&](double x, double) { return 0.15 * std::min(1.0, time) * std::sin(5 * x + 8 * time); };
        field.set(wave);
        plugin.obstacleChanged(&field.shape());
        world.step();
        PenetrationMeter meter(field.mesh(), meshOf(cloth));
        ASSERT_EQ(meter.measure(positionsOf(cloth).data()).m_intersectingPairs, 0u) << "step " << i;
        ASSERT_EQ(plugin.statistics().m_status, kStepGood) << "step " << i;
    }
    EXPECT_GT(lowestOf(cloth), btScalar(-0.2));
}

TEST(HeightFields, HaveHolesWhereAFilterLeavesTrianglesOut)
{
    Plugin plugin(hostSettings());
    Field field(40, 0.1f, [](double, double) { return 0; });
    for (const bool hasHole : {false, true})
    {
        DropWorld world(&plugin);
        world.addObstacle(field.shape());
        btSoftBody& cloth = world.addCloth(clothAt(btVector3(0, btScalar(0.1), 0)));
        if (hasHole)
            plugin.setTriangleFilter(&field.shape(), [](int part, int j)
                                     { return std::max(std::abs(part / 2 - 20), std::abs(j - 20)) > 9; });
        world.step(60);
        EXPECT_EQ(lowestOf(cloth) < btScalar(-0.2), hasHole);
        plugin.setTriangleFilter(&field.shape(), nullptr);
    }
}

// Cloth that has burst would need the whole field. It still collides with the ball, and the line is not repeated.
TEST(HeightFields, LeaveOutClothThatCoversTooManyCells)
{
    Settings settings = hostSettings();
    std::vector<std::string> lines;
    settings.m_log = [&](const char* line) { lines.push_back(line); };
    Plugin plugin(settings);
    DropWorld world(&plugin);
    Field field(2048, 0.1f, hills);
    world.addObstacle(field.shape());
    MeshShape ball(makeSphere(20, 3));
    world.addObstacle(ball.shape());
    ClothSpec spec = clothAt(btVector3(0, btScalar(0.5), 0));
    spec.m_size = 180;
    world.addCloth(spec);
    world.step(10);
    EXPECT_TRUE(plugin.statistics().m_status & kStepClothsLeftOut);
    const auto isOfField = [](const std::string& line) { return line.find("height field") != std::string::npos; };
    EXPECT_EQ(std::count_if(lines.begin(), lines.end(), isOfField), 1) << testing::PrintToString(lines);
}
}  // namespace drape::test
