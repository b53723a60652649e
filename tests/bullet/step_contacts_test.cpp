// Contacts with impulses (Plugin::stepContacts(), setContactListener()) and pairs that a step could not keep apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
btTransform at(btScalar x, btScalar y, btScalar z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(x, y, z));
}

btVector3 vectorOf(const float v[3])
{
    return btVector3(v[0], v[1], v[2]);
}

// Returns the impulses that a body got in the step, N s.
btVector3 impulseOn(const btSoftBody& body, const Plugin& plugin)
{
    btVector3 sum(0, 0, 0);
    for (const StepContact& contact : plugin.stepContacts())
    {
        if (contact.m_cloth.m_body == &body) sum += vectorOf(contact.m_impulse);
        if (contact.m_other.m_body == &body) sum -= vectorOf(contact.m_impulse);
    }
    return sum;
}

btScalar massOf(const btSoftBody& body)
{
    btScalar mass = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        mass += 1 / body.m_nodes[i].m_im;
    return mass;
}

// Returns where a point of a soft body is now, m.
btVector3 placeOf(const ClothPoint& point)
{
    btVector3 place(0, 0, 0);
    for (int k = 0; k < 3 && point.m_nodes[k] >= 0; ++k)
        place += point.m_body->m_nodes[point.m_nodes[k]].m_x * point.m_weights[k];
    return place;
}

ClothSpec undamped(btScalar height, int nodes = 17)
{
    ClothSpec spec;
    spec.m_nodes = nodes;
    spec.m_centre = btVector3(0, height, 0);
    spec.m_damping = 0;
    return spec;
}

Settings with(Settings settings, Solver solver)
{
    settings.m_solver = solver;
    return settings;
}

void stopGravity(DropWorld& world)
{
    world.world().setGravity(btVector3(0, 0, 0));
    world.world().getWorldInfo().m_gravity.setZero();
}
}  // namespace

// The solver of the cloth, and the place where it would run without records.
struct SolvingCase
{
    const char* m_name;
    Solver m_solver;
    SolverPlace m_place;
};

class ContactImpulses : public testing::TestWithParam<SolvingCase>
{
protected:
    Settings settings() const { return with(settingsFor(GetParam().m_place), GetParam().m_solver); }
};

TEST_P(ContactImpulses, OfAClothAtRestHoldItsWeight)
{
    Plugin plugin(settings());
    plugin.recordContacts(true);
    MeshShape ball(makeSphere(0.4f, 3));
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(undamped(btScalar(0.5), 11));
    cloth.m_cfg.kDF = btScalar(0.5);
    world.addObstacle(ball.shape()).setFriction(btScalar(0.5));
    world.step(180);
    const btVector3 weight = massOf(cloth) * world.world().getGravity() * kDt;
    for (int i = 0; i < 5; ++i)
    {
        const btVector3 before = linearMomentumOf(cloth);
        world.step();
        const btVector3 gained = linearMomentumOf(cloth) - before, held = impulseOn(cloth, plugin);
        EXPECT_LT((held + weight).length(), btScalar(0.02) * weight.length());
        EXPECT_LT((gained - held - weight).length(), btScalar(0.001) * weight.length());
    }
}

TEST_P(ContactImpulses, OfAFallAreItsChangeOfMomentum)
{
    Plugin plugin(settings());
    plugin.recordContacts(true);
    MeshShape ground(makeBox(4, 0.5f, 4));
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(undamped(btScalar(1.25)));
    world.addObstacle(ground.shape());
    const btVector3 weight = massOf(cloth) * world.world().getGravity() * kDt;
    btScalar most = 0;
    for (int i = 0; i < 40; ++i)
    {
        const btVector3 before = linearMomentumOf(cloth);
        world.step();
        const btVector3 held = impulseOn(cloth, plugin);
        const btVector3 missing = linearMomentumOf(cloth) - before - held - weight;
        ASSERT_LT(missing.length(), btScalar(0.001) * weight.length()) << "step " << i;
        most = std::max(most, held.length());
    }
    EXPECT_GT(most, 10 * weight.length()) << "it has not met the ground";
}

TEST_P(ContactImpulses, ChangeNoResult)
{
    std::uint64_t hashes[3];
    std::size_t heard = 0;
    for (int way = 0; way < 3; ++way)
    {
        Plugin plugin(settings());
        MeshShape ball(makeSphere(0.4f, 3));
        DropWorld world(&plugin);
        btSoftBody& cloth = world.addCloth(undamped(btScalar(0.6), 11));
        btSoftBody& second = world.addCloth(undamped(btScalar(0.7), 11));
        world.addObstacle(ball.shape());
        if (GetParam().m_solver != Solver::Bullet && GetParam().m_place == SolverPlace::Host)
            for (const btSoftBody* body : {&cloth, &second})
                plugin.setSelfCollision(*body, true);
        plugin.recordContacts(way == 1);
        if (way == 2) plugin.setContactListener([&](const StepContacts& step) { heard += step.m_contacts.size(); });
        hashes[way] = kHashStart;
        for (int i = 0; i < 60; ++i)
        {
            world.step();
            hashes[way] = hashOf(second, hashOf(cloth, hashes[way]));
        }
        EXPECT_EQ(plugin.stepContacts().empty(), way == 0);
    }
    EXPECT_EQ(hashes[1], hashes[0]);
    EXPECT_EQ(hashes[2], hashes[0]);
    EXPECT_GT(heard, 0u);
}

INSTANTIATE_TEST_SUITE_P(Solvers, ContactImpulses,
                         testing::Values(SolvingCase{"drape", Solver::Drape, SolverPlace::Host},
                                         SolvingCase{"device", Solver::Drape, SolverPlace::Device},
                                         SolvingCase{"bullet", Solver::Bullet, SolverPlace::Host}),
                         [](const auto& named) { return named.param.m_name; });

// A ball and a cloth in free space: all that the ball loses, the contacts have.
class ContactImpulsesOfABody : public testing::TestWithParam<ShapeContacts>
{
};

TEST_P(ContactImpulsesOfABody, AreItsChangeOfMomentum)
{
    Settings settings = hostSettings();
    settings.m_dynamicConvex = GetParam();
    Plugin plugin(settings);
    plugin.recordContacts(true);
    DropWorld world(&plugin);
    stopGravity(world);
    btSphereShape ball(btScalar(0.2));
    btRigidBody& body = world.addDynamic(ball, btScalar(0.5), at(btScalar(0.1), btScalar(-0.4), 0));
    body.setLinearVelocity(btVector3(0, btScalar(1.5), 0));
    btSoftBody& cloth = world.addCloth(undamped(0));
    cloth.m_cfg.kDF = btScalar(0.5);
    bool met = false;
    for (int i = 0; i < 60; ++i)
    {
        const btVector3 before = body.getLinearVelocity() / body.getInvMass(), cloths = linearMomentumOf(cloth);
        world.step();
        const btVector3 lost = before - body.getLinearVelocity() / body.getInvMass();
        const btVector3 given = impulseOn(cloth, plugin);
        ASSERT_LT((lost - given).length(), 1e-5) << "step " << i;
        ASSERT_LT((linearMomentumOf(cloth) - cloths - given).length(), 1e-5) << "step " << i;
        met = met || given.length() > btScalar(0.01);
        for (const StepContact& contact : plugin.stepContacts())
        {
            EXPECT_EQ(contact.m_object, &body);
            EXPECT_EQ(contact.m_isBullets, GetParam() == ShapeContacts::Bullet);
            EXPECT_EQ(contact.m_shape, contact.m_isBullets ? nullptr : &ball);
            EXPECT_EQ(contact.m_triangle, -1);
        }
    }
    EXPECT_TRUE(met);
}

INSTANTIATE_TEST_SUITE_P(Finders, ContactImpulsesOfABody, testing::Values(ShapeContacts::Drape, ShapeContacts::Bullet),
                         [](const auto& named) { return named.param == ShapeContacts::Drape ? "drape" : "bullet"; });

TEST(StepContacts, OfTwoClothsGiveEachWhatTheOtherLoses)
{
    Plugin plugin(hostSettings());
    plugin.recordContacts(true);
    DropWorld world(&plugin);
    stopGravity(world);
    ClothSpec turned = undamped(btScalar(0.1));
    turned.m_nodes = 11;
    turned.m_centre += btVector3(btScalar(0.21), 0, btScalar(0.13));
    btSoftBody* const cloths[2] = {&world.addCloth(undamped(0)), &world.addCloth(turned)};
    for (const btSoftBody* cloth : cloths)
        plugin.setSelfCollision(*cloth, true);
    cloths[1]->addVelocity(btVector3(0, -1, 0));
    btScalar most = 0;
    bool hasEdges = false;
    for (int i = 0; i < 30; ++i)
    {
        const btVector3 before[2] = {linearMomentumOf(*cloths[0]), linearMomentumOf(*cloths[1])};
        world.step();
        for (int k = 0; k < 2; ++k)
        {
            const btVector3 given = impulseOn(*cloths[k], plugin);
            // The guard shortens paths where contacts do not suffice.
            const btScalar share = plugin.statistics().m_nodesShortened > 0 ? btScalar(0.2) : btScalar(0.001);
            EXPECT_LT((linearMomentumOf(*cloths[k]) - before[k] - given).length(), share * given.length() + 1e-5)
                << "step " << i;
            most = std::max(most, given.length());
        }
        for (const StepContact& contact : plugin.stepContacts())
        {
            ASSERT_EQ(contact.m_object, contact.m_other.m_body);
            ASSERT_NE(contact.m_other.m_body, nullptr);
            hasEdges = hasEdges || contact.m_objectFeature == ContactFeature::AtEdge;
            const btVector3 apart = placeOf(contact.m_cloth) - placeOf(contact.m_other);
            EXPECT_NEAR(apart.dot(vectorOf(contact.m_normal)) - contact.m_thickness, contact.m_gap, 1e-6);
        }
    }
    EXPECT_GT(most, btScalar(0.01));
    EXPECT_TRUE(hasEdges);
}

// A mesh of two parts, of which a filter leaves out some triangles.
TEST(StepContacts, NameTheTriangleAsBulletDoes)
{
    TriangleMesh ground = makeTerrain(4, 0.1f, 12, 3);
    const int triangles = int(ground.m_triangles.size() / 3), first = triangles / 3;
    btTriangleIndexVertexArray arrays;
    for (const int from : {0, first})
    {
        btIndexedMesh part;
        part.m_numTriangles = from == 0 ? first : triangles - first;
        part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(&ground.m_triangles[3 * std::size_t(from)]);
        part.m_triangleIndexStride = 3 * sizeof(int);
        part.m_numVertices = int(ground.m_positions.size() / 3);
        part.m_vertexBase = reinterpret_cast<const unsigned char*>(ground.m_positions.data());
        part.m_vertexStride = 3 * sizeof(float);
        part.m_vertexType = PHY_FLOAT;
        arrays.addIndexedMesh(part);
    }
    btBvhTriangleMeshShape shape(&arrays, true);
    shape.setMargin(kMargin);
    Plugin plugin(hostSettings());
    plugin.setTriangleFilter(&shape, [](int part, int triangle) { return part == 0 || triangle % 7 != 2; });
    plugin.recordContacts(true);
    DropWorld world(&plugin);
    const btTransform pose(btQuaternion(btVector3(0, 1, 0), btScalar(0.7)), btVector3(btScalar(0.3), 0, 0));
    world.addObstacle(shape, pose);
    ClothSpec spec = undamped(btScalar(0.3));
    spec.m_size = 2;
    world.addCloth(spec);
    world.step(30);
    int parts[2] = {0, 0};
    for (const StepContact& contact : plugin.stepContacts())
    {
        ASSERT_GE(contact.m_triangle, 0);
        EXPECT_EQ(contact.m_shape, &shape);
        ++parts[contact.m_part];
        EXPECT_TRUE(contact.m_part == 0 || contact.m_triangle % 7 != 2);
        const std::size_t source = std::size_t(contact.m_triangle + (contact.m_part == 0 ? 0 : first));
        btVector3 corners[3];
        for (std::size_t k = 0; k < 3; ++k)
        {
            const std::size_t vertex = std::size_t(ground.m_triangles[3 * source + k]);
            corners[k] = pose * vectorOf(&ground.m_positions[3 * vertex]);
        }
        const btVector3 point = vectorOf(contact.m_point),
                        across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        btScalar areas = 0;
        for (int k = 0; k < 3; ++k)
            areas += (corners[k] - point).cross(corners[(k + 1) % 3] - point).length();
        EXPECT_NEAR(areas, across.length(), 1e-5) << "the point is not in the triangle";
    }
    EXPECT_GT(parts[0], 10);
    EXPECT_GT(parts[1], 10);
}

TEST(StepContacts, NameTheCellOfAHeightField)
{
    constexpr int kSide = 21;
    std::vector<float> heights(kSide * kSide, 0.0f);
    btHeightfieldTerrainShape field(kSide, kSide, heights.data(), 1, -1, 1, 1, PHY_FLOAT, false);
    field.setLocalScaling(btVector3(btScalar(0.2), 1, btScalar(0.2)));
    field.setMargin(kMargin);
    Plugin plugin(hostSettings());
    plugin.recordContacts(true);
    DropWorld world(&plugin);
    world.addObstacle(field);
    world.addCloth(undamped(btScalar(0.04)));
    world.step(10);
    ASSERT_FALSE(plugin.stepContacts().empty());
    for (const StepContact& contact : plugin.stepContacts())
    {
        const float x = contact.m_point[0] / 0.2f + 10, z = contact.m_point[2] / 0.2f + 10;
        EXPECT_NEAR(x, float(contact.m_part / 2) + 0.5f, 0.5001f);
        EXPECT_NEAR(z, float(contact.m_triangle) + 0.5f, 0.5001f);
    }
}

TEST(StepContacts, HaveTheGapAtTheStepsEnd)
{
    Plugin plugin(hostSettings());
    plugin.recordContacts(true);
    MeshShape ground(makeBox(4, 0.5f, 4));
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(undamped(btScalar(0.3)));
    world.addObstacle(ground.shape());
    world.step(60);
    std::set<int> nodes;
    for (const StepContact& contact : plugin.stepContacts())
    {
        EXPECT_EQ(contact.m_cloth.m_body, &cloth);
        EXPECT_NEAR(contact.m_gap, 0, 0.01 * kThickness);
        EXPECT_NEAR(contact.m_thickness, kThickness, 1e-6);
        EXPECT_NEAR(contact.m_normal[1], 1, 1e-5);
        EXPECT_NEAR(contact.m_normalImpulse, contact.m_impulse[1], 1e-6);
        if (contact.m_cloth.m_feature == ContactFeature::AtNode) nodes.insert(contact.m_cloth.m_nodes[0]);
    }
    EXPECT_EQ(nodes.size(), std::size_t(cloth.m_nodes.size()));
}

TEST(ContactListeners, AreCalledOnceInEachInternalStep)
{
    Plugin plugin(hostSettings());
    MeshShape ground(makeBox(4, 0.5f, 4));
    DropWorld world(&plugin), other(&plugin);
    world.addCloth(undamped(btScalar(0.3)));
    world.addObstacle(ground.shape());
    int calls = 0, ofOther = 0;
    std::size_t most = 0;
    plugin.setContactListener(
        [&](const StepContacts& step)
        {
            ++calls;
            ofOther += step.m_solver == other.solver();
            most = std::max(most, step.m_contacts.size());
            EXPECT_EQ(&step.m_contacts, &plugin.stepContacts());
            EXPECT_NEAR(step.m_timeStep, kDt, 1e-7);
            throw std::runtime_error("an app's mistake");
        });
    world.step(10);
    EXPECT_EQ(calls, 10);
    other.step(3);
    EXPECT_EQ(ofOther, 3);
    world.world().stepSimulation(2 * kDt, 5, kDt);
    EXPECT_EQ(calls, 15);
    EXPECT_GT(most, 0u);
    plugin.setContactListener(nullptr);
    world.step(2);
    EXPECT_EQ(calls, 15);
    EXPECT_TRUE(plugin.stepContacts().empty());
}

TEST(ContactListeners, MayRemoveThemselves)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    int calls = 0;
    plugin.setContactListener(
        [&](const StepContacts&)
        {
            ++calls;
            plugin.setContactListener(nullptr);
        });
    world.step(3);
    EXPECT_EQ(calls, 1);
}

TEST(FlaggedPairs, NameTrianglesThatStartIntersecting)
{
    Plugin plugin(hostSettings());
    MeshShape ground(makeTerrain(4, 0.0f, 8, 1));
    DropWorld world(&plugin);
    btCollisionObject& obstacle = world.addObstacle(ground.shape(), at(0, btScalar(0.1), 0));
    btSoftBody& cloth = world.addCloth(undamped(0));
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        cloth.m_nodes[i].m_x.setY(btScalar(0.1) + (cloth.m_nodes[i].m_x.x() > 0 ? btScalar(0.05) : btScalar(-0.05)));
    world.step();
    EXPECT_EQ(plugin.flaggedPairs().size(), plugin.statistics().m_startIntersections);
    ASSERT_FALSE(plugin.flaggedPairs().empty());
    for (const FlaggedPair& pair : plugin.flaggedPairs())
    {
        EXPECT_EQ(pair.m_flag, PairFlag::StartsIntersecting);
        EXPECT_EQ(pair.m_body, &cloth);
        EXPECT_EQ(pair.m_object, &obstacle);
        EXPECT_EQ(pair.m_otherBody, nullptr);
        EXPECT_GE(pair.m_nodes[2], 0);
        EXPECT_GE(pair.m_triangle, 0);
        for (const auto& corner : pair.m_corners)
            EXPECT_NEAR(corner[1], 0.1f, 1e-6f);
    }
}

TEST(FlaggedPairs, NameClothThatPinnedNodesForce)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    stopGravity(world);
    ClothSpec shifted = undamped(btScalar(0.1));
    shifted.m_centre += btVector3(btScalar(0.03), 0, btScalar(0.02));
    btSoftBody* const cloths[2] = {&world.addCloth(undamped(0)), &world.addCloth(shifted)};
    for (btSoftBody* cloth : cloths)
    {
        for (int i = 0; i < cloth->m_nodes.size(); ++i)
            cloth->setMass(i, 0);
        plugin.setSelfCollision(*cloth, true);
    }
    world.step();
    EXPECT_TRUE(plugin.flaggedPairs().empty());
    for (int i = 0; i < cloths[1]->m_nodes.size(); ++i)
        cloths[1]->m_nodes[i].m_x.setY(btScalar(-0.1));
    world.step();
    ASSERT_FALSE(plugin.flaggedPairs().empty());
    for (const FlaggedPair& pair : plugin.flaggedPairs())
    {
        EXPECT_EQ(pair.m_flag, PairFlag::Forced);
        EXPECT_NE(pair.m_body, pair.m_otherBody);
        EXPECT_EQ(pair.m_object, pair.m_otherBody);
    }
    EXPECT_EQ(plugin.flaggedPairs().size(), plugin.statistics().m_clothPairsMeeting);
}
}  // namespace drape::test
