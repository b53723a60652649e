// Cloth that is guarded beside filters, limits, other cloth far away, Bullet's solver and rigid bodies.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "oracle/exact_predicates.h"
#include "scenes/shapes.h"
#include "tests/bullet/layers.h"

namespace drape::test
{
namespace
{
// Two sheets; the upper one is tilted through the pinned lower one.
struct Crossing : Layers
{
    Crossing() : Layers(hostSettings(), 2, 0.0f)
    {
        pin(*m_cloths[0]);
        turnGravityOff();
        for (int i = 0; i < m_cloths[1]->m_nodes.size(); ++i)
        {
            btSoftBody::Node& node = m_cloths[1]->m_nodes[i];
            node.m_x.setY(node.m_x.y() + btScalar(0.4) * node.m_x.x());
            node.m_q = node.m_x;
        }
    }
};

using Filter = std::function<void(btSoftBody&, btSoftBody&, bool)>;  // lets two bodies meet, or not

struct NamedFilter
{
    const char* m_name;
    Filter m_set;
};

void setResponse(btSoftBody& body, bool responds)
{
    const int flags = body.getCollisionFlags() & ~int(btCollisionObject::CF_NO_CONTACT_RESPONSE);
    body.setCollisionFlags(responds ? flags : flags | int(btCollisionObject::CF_NO_CONTACT_RESPONSE));
}

void setDisabled(btSoftBody& body, btSoftBody& other, bool meets)
{
    if (meets)
        body.m_collisionDisabledObjects.remove(&other);
    else
        body.m_collisionDisabledObjects.push_back(&other);
}

std::vector<NamedFilter> filters()
{
    return {
        {"mask of the first", [](btSoftBody& a, btSoftBody&, bool meets)
         { a.getBroadphaseHandle()->m_collisionFilterMask = meets ? -1 : 2; }},
        {"response of the first", [](btSoftBody& a, btSoftBody&, bool meets) { setResponse(a, meets); }},
        {"response of the second", [](btSoftBody&, btSoftBody& b, bool meets) { setResponse(b, meets); }},
        {"list of the first", [](btSoftBody& a, btSoftBody& b, bool meets) { setDisabled(a, b, meets); }},
        {"list of the second", [](btSoftBody& a, btSoftBody& b, bool meets) { setDisabled(b, a, meets); }},
        {"the first ignores", [](btSoftBody& a, btSoftBody& b, bool meets) { a.setIgnoreCollisionCheck(&b, !meets); }},
        {"the second ignores",
         [](btSoftBody& a, btSoftBody& b, bool meets) { b.setIgnoreCollisionCheck(&a, !meets); }}};
}

// Lets no pair of the same group meet.
struct GroupFilter : btOverlapFilterCallback
{
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override
    {
        return a->m_collisionFilterGroup != b->m_collisionFilterGroup;
    }
};

// Counts the pairs of triangles of a cloth and a box that intersect.
std::size_t meetingBox(const btSoftBody& cloth, const btTransform& pose, const btVector3& half)
{
    const TriangleMesh box = placed(makeBox(2, 2, 2), pose, half);
    std::size_t count = 0;
    for (int f = 0; f < cloth.m_faces.size(); ++f)
    {
        Vector3 own[3];
        for (int k = 0; k < 3; ++k)
        {
            const btVector3& x = cloth.m_faces[f].m_n[k]->m_x;
            own[k] = {float(x.x()), float(x.y()), float(x.z())};
        }
        for (std::size_t t = 0; t < box.triangleCount(); ++t)
        {
            Vector3 other[3];
            for (std::size_t k = 0; k < 3; ++k)
            {
                const float* const x = box.m_positions.data() + 3 * box.m_triangles[3 * t + k];
                other[k] = {x[0], x[1], x[2]};
            }
            count += trianglesIntersect(own, other);
        }
    }
    return count;
}

// Returns the kinetic and height energy of sheets and a body, J.
btScalar energyOf(const Layers& layers, const btRigidBody& body)
{
    const btVector3& spin = body.getAngularVelocity();
    const btVector3 turning = body.getInvInertiaTensorWorld().inverse() * spin;
    const btScalar height = body.getWorldTransform().getOrigin().y();
    btScalar energy = (body.getLinearVelocity().length2() / 2 + 9.81f * height) / body.getInvMass();
    energy += spin.dot(turning) / 2;
    for (const btSoftBody* cloth : layers.m_cloths)
        for (int i = 0; i < cloth->m_nodes.size(); ++i)
        {
            const btSoftBody::Node& node = cloth->m_nodes[i];
            energy += (node.m_v.length2() / 2 + 9.81f * node.m_x.y()) / node.m_im;
        }
    return energy;
}

struct PlateAndBox
{
    const btVector3 kPlate{2, 0.1f, 2}, kBox{0.1f, 0.1f, 0.1f};
    btBoxShape m_plate{kPlate}, m_boxShape{kBox};
};

// A heavy box falls on light sheets that lie on a plate.
struct LoadedLayers : PlateAndBox, Layers
{
    LoadedLayers(int count, btScalar mass) : Layers(hostSettings(), count, 1.1f * kThickness)
    {
        for (btSoftBody* cloth : m_cloths)
            cloth->setTotalMass(0.05f);
        m_plate.setMargin(kMargin);
        m_boxShape.setMargin(kMargin);
        btTransform pose = btTransform::getIdentity();
        pose.setOrigin(btVector3(0, 0.6f - kPlate.y() - 1.1f * kThickness, 0));
        m_floor = &m_world.addKinematic(m_plate, pose);
        pose.setOrigin(btVector3(0, 0.6f + kBox.y() + 1.1f * kThickness * btScalar(count) + 0.05f, 0));
        m_box = &m_world.addDynamic(m_boxShape, mass, pose);
        m_box->setActivationState(DISABLE_DEACTIVATION);
    }
    btScalar gap() const
    {
        const btScalar plate = m_floor->getWorldTransform().getOrigin().y() + kPlate.y();
        return m_box->getWorldTransform().getOrigin().y() - kBox.y() - plate;
    }

    btRigidBody *m_floor = nullptr, *m_box = nullptr;
};

// Free sheets without gravity, made one by one.
struct FreeSheets : Layers
{
    explicit FreeSheets(const Settings& settings = hostSettings()) : Layers(settings, 0, 0) { turnGravityOff(); }
    ~FreeSheets()
    {
        for (const std::unique_ptr<btSoftBody>& body : m_bodies)
            m_world.world().removeSoftBody(body.get());
    }
    // Adds a sheet of n x n nodes from centre - u - v to centre + u + v, that margins of 5 mm keep apart.
    btSoftBody& add(const btVector3& centre, const btVector3& u, const btVector3& v, int n, btScalar mass)
    {
        m_bodies.emplace_back(btSoftBodyHelpers::CreatePatch(m_world.world().getWorldInfo(), centre - u - v,
                                                             centre + u - v, centre - u + v, centre + u + v, n, n, 0,
                                                             true));
        btSoftBody& cloth = *m_bodies.back();
        cloth.getCollisionShape()->setMargin(0.005f);
        cloth.setTotalMass(mass);
        cloth.m_cfg.piterations = 5;
        m_world.world().addSoftBody(&cloth);
        m_plugin.setSelfCollision(cloth, true);
        m_cloths.push_back(&cloth);
        return cloth;
    }

    std::vector<std::unique_ptr<btSoftBody>> m_bodies;
};

// Returns the length of the body's longest link, in multiples of that at rest.
btScalar longestOf(const btSoftBody& cloth)
{
    btScalar most = 0;
    for (int i = 0; i < cloth.m_links.size(); ++i)
    {
        const btSoftBody::Link& link = cloth.m_links[i];
        most = std::max(most, (link.m_n[0]->m_x - link.m_n[1]->m_x).length() / link.m_rl);
    }
    return most;
}
}  // namespace

TEST(ClothMeetings, FiltersWorkFromBothSides)
{
    for (const NamedFilter& filter : filters())
    {
        Layers layers(hostSettings(), 2, 0.03f);
        pin(*layers.m_cloths[0]);
        filter.m_set(*layers.m_cloths[0], *layers.m_cloths[1], false);
        layers.run(40);
        EXPECT_LT(lowestOf(*layers.m_cloths[1]), 0.5f) << filter.m_name;
        EXPECT_EQ(layers.m_status, std::uint32_t(kStepGood)) << filter.m_name;
    }
}

TEST(ClothMeetings, TheWorldsOwnFilterIsAsked)
{
    Layers layers(hostSettings(), 2, 0.03f);
    GroupFilter filter;
    layers.m_world.world().getPairCache()->setOverlapFilterCallback(&filter);
    pin(*layers.m_cloths[0]);
    layers.run(40);
    EXPECT_LT(lowestOf(*layers.m_cloths[1]), 0.5f);
    layers.m_world.world().getPairCache()->setOverlapFilterCallback(nullptr);
}

TEST(ClothMeetings, ClothsThatMayMeetFromNowOnAreChecked)
{
    for (const NamedFilter& filter : filters())
    {
        Crossing cloths;
        filter.m_set(*cloths.m_cloths[0], *cloths.m_cloths[1], false);
        cloths.run(3);
        const std::size_t crossing = cloths.meeting();
        EXPECT_GT(crossing, 0u);
        EXPECT_EQ(cloths.m_plugin.statistics().m_clothPairsMeeting, 0u) << filter.m_name;
        filter.m_set(*cloths.m_cloths[0], *cloths.m_cloths[1], true);
        cloths.m_world.step();
        EXPECT_EQ(cloths.m_plugin.clothPairs().size(), crossing) << filter.m_name;
        EXPECT_NE(cloths.m_plugin.statistics().m_status & kStepClothsMeet, 0u) << filter.m_name;
    }
}

TEST(ClothMeetings, WhyStockKnowsSelfCollisionAndFilters)
{
    Layers layers(hostSettings(), 2, 0.03f, false);
    btSoftBody &a = *layers.m_cloths[0], &b = *layers.m_cloths[1];
    EXPECT_NE(layers.m_plugin.whyStock(&a, &b).find("setSelfCollision"), std::string::npos);
    EXPECT_NE(layers.m_plugin.whyStock(&a, &a).find("setSelfCollision"), std::string::npos);
    layers.m_plugin.setSelfCollision(a, true);
    layers.m_plugin.setSelfCollision(b, true);
    EXPECT_EQ(layers.m_plugin.whyStock(&a, &b), "");
    EXPECT_EQ(layers.m_plugin.whyStock(&a, &a), "");
    a.setIgnoreCollisionCheck(&b, true);
    EXPECT_NE(layers.m_plugin.whyStock(&a, &b).find("filters"), std::string::npos);
}

// Bullet's passes against drift put the nodes' ends where their starts were.
TEST(ClothMeetings, BodiesThatDriftAreKeptApart)
{
    Layers layers(hostSettings(), 2, 0.3f);
    pin(*layers.m_cloths[0]);
    layers.m_cloths[1]->m_cfg.diterations = 1;
    layers.m_cloths[1]->setVelocity(btVector3(0, -5, 0));
    ASSERT_FALSE(layers.m_plugin.whyBulletSolves(*layers.m_cloths[1]).empty());
    EXPECT_EQ(layers.run(40), 0u);
    EXPECT_GT(lowestOf(*layers.m_cloths[1]), 0.5f);
}

TEST(ClothMeetings, ThickClothFarAwayKeepsNobodyInTheAir)
{
    Layers layers(hostSettings(), 2, 0.1f);
    pin(*layers.m_cloths[0]);
    ClothSpec spec;
    spec.m_nodes = 4;
    spec.m_centre = btVector3(20, 0, 0);
    btSoftBody& thick = layers.m_world.addCloth(spec);
    thick.getCollisionShape()->setMargin(0.25f);  // Bullet's default
    layers.m_plugin.setSelfCollision(thick, true);
    EXPECT_EQ(layers.run(30), 0u);
    EXPECT_NEAR(lowestOf(*layers.m_cloths[1]), lowestOf(*layers.m_cloths[0]) + kThickness, 0.1f * kThickness);
}

TEST(ClothMeetings, MarginsOfNothingKeepClothsApart)
{
    Layers layers(hostSettings(), 2, 0.1f);
    pin(*layers.m_cloths[0]);
    layers.m_cloths[0]->getCollisionShape()->setMargin(0);
    layers.m_cloths[1]->getCollisionShape()->setMargin(-1);
    EXPECT_EQ(layers.run(60), 0u);
    EXPECT_GT(lowestOf(*layers.m_cloths[1]), lowestOf(*layers.m_cloths[0]));
}

// A pinned sheet goes through a free one in one step, while something changes that has to do with neither.
TEST(ClothMeetings, HeldNodesCarryClothWhateverElseChanges)
{
    const std::vector<std::pair<const char*, std::function<void(Layers&, btSoftBody&)>>> changes = {
        {"nothing", [](Layers&, btSoftBody&) {}},
        {"cloth is added",
         [](Layers& layers, btSoftBody&)
         {
             ClothSpec spec;
             spec.m_centre = btVector3(30, 0, 0);
             layers.m_plugin.setSelfCollision(layers.m_world.addCloth(spec), true);
         }},
        {"cloth is removed", [](Layers& layers, btSoftBody& other) { layers.m_world.remove(other); }},
        {"another thickness",
         [](Layers& layers, btSoftBody& other) { layers.m_plugin.setSelfCollision(other, true, 0.03); }},
        {"a node that is moved", [](Layers&, btSoftBody& other) { other.m_nodes[0].m_x += btVector3(0, 0.001f, 0); }},
        {"an invalid node",
         [](Layers&, btSoftBody& other) { other.m_nodes[0].m_x.setX(std::numeric_limits<btScalar>::quiet_NaN()); }}};
    for (const auto& change : changes)
    {
        Layers layers(hostSettings(), 2, 0.03f);
        layers.turnGravityOff();
        ClothSpec spec;
        spec.m_centre = btVector3(20, 0, 0);
        btSoftBody& other = layers.m_world.addCloth(spec);
        layers.m_plugin.setSelfCollision(other, true);
        pin(*layers.m_cloths[0]);
        layers.m_world.step(2);
        move(*layers.m_cloths[0], btVector3(0, 0.2f, 0));
        change.second(layers, other);
        layers.m_world.step();
        EXPECT_EQ(layers.meeting(), 0u) << change.first;
        EXPECT_GT(lowestOf(*layers.m_cloths[1]), layers.m_cloths[0]->m_nodes[0].m_x.y()) << change.first;
        EXPECT_EQ(layers.m_plugin.statistics().m_clothPairsMeeting, 0u) << change.first;
    }
}

// Each of two pairs of sheets starts tangled. The upper pair flies into the lower one.
TEST(ClothMeetings, TanglesAreKeptFromEachOther)
{
    const btVector3 sheets[4][3] = {{{0, 0, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}},
                                    {{0.03f, -0.3f, 0.01f}, {0.2f, 0.02f, 0}, {0, 0.35f, 0.03f}},
                                    {{0.01f, 0.5f, 0.02f}, {0.1f, 0.03f, 0}, {0, 0.02f, 0.1f}},
                                    {{0.02f, 0.52f, 0.03f}, {0.05f, 0, 0.01f}, {0, 0.05f, 0}}};
    FreeSheets layers;
    for (int k = 0; k < 4; ++k)
    {
        btSoftBody& cloth = layers.add(sheets[k][0], sheets[k][1], sheets[k][2], 2, 0.05f);
        if (k < 2)
            pin(cloth);
        else
            cloth.setVelocity(btVector3(0, -10, 0));
    }
    SelfIntersections check(layers.joined());
    EXPECT_GE(layers.meeting(), 2u);
    for (int step = 0; step < 20; ++step)
    {
        layers.m_world.step();
        for (const auto& pair : check.find(layers.positions()))
            EXPECT_EQ(pair.first < 4, pair.second < 4) << step;
    }
}

// A fast sheet knocks on another one, below which a box is out of reach of where that would have gone by itself.
TEST(ClothMeetings, ClothThatIsKnockedOnPassesNoBox)
{
    for (const Solver solver : {Solver::Auto, Solver::Bullet})
    {
        const btVector3 half(0.05f, 0.01f, 0.05f);
        btBoxShape shape(half);
        shape.setMargin(0.005f);
        Settings settings = hostSettings();
        settings.m_solver = solver;
        FreeSheets sheets(settings);
        btSoftBody& lower = sheets.add({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 3, 0.05f);
        btSoftBody& upper = sheets.add({0, 0.05f, 0}, {0.2f, 0, 0}, {0, 0, 0.2f}, 5, 1);
        lower.m_cfg.kDP = upper.m_cfg.kDP = 0;
        btTransform pose = btTransform::getIdentity();
        pose.setOrigin(btVector3(0.3f, -0.35f, 0.05f));
        sheets.m_world.addObstacle(shape, pose);
        sheets.m_world.step();
        upper.setVelocity(btVector3(0, -30, 0));
        EXPECT_EQ(sheets.run(1), 0u);
        EXPECT_EQ(meetingBox(lower, pose, half), 0u);
        for (int i = 0; i < lower.m_nodes.size(); ++i)
            EXPECT_GT(lower.m_nodes[i].m_x.y(), pose.getOrigin().y()) << i;
        EXPECT_NE(sheets.m_status & kStepMotionHeldBack, 0u);
    }
}

TEST(ClothMeetings, FastClothWakesClothBeforeItHitsIt)
{
    FreeSheets sheets;
    btSoftBody& asleep = sheets.add({0, 0, 0}, {0.3f, 0, 0}, {0, 0, 0.3f}, 7, 0.1f);
    btSoftBody& fast = sheets.add({0.02f, 0.3f, 0.01f}, {0.2f, 0.02f, 0}, {0, 0.01f, 0.2f}, 5, 0.1f);
    sheets.m_world.step(2);
    asleep.forceActivationState(ISLAND_SLEEPING);
    fast.setVelocity(btVector3(0, -20, 0));
    const btVector3 before = sheets.momentum();
    EXPECT_EQ(sheets.run(10), 0u);
    EXPECT_TRUE(asleep.isActive());
    EXPECT_LT((sheets.momentum() - before).length(), 1e-4f * before.length());
}

// Anchors to a body that does not yield hold cloth as pins do.
TEST(ClothMeetings, AnchoredClothIsStretchedNoMoreThanPinnedCloth)
{
    btScalar longest[2] = {0, 0};
    for (const bool anchored : {false, true})
    {
        btBoxShape shape(btVector3(0.01f, 0.01f, 0.01f));
        FreeSheets sheets;
        btSoftBody& hung = sheets.add({0, 0, 0}, {0.3f, 0, 0}, {0, 0, 0.3f}, 7, 0.1f);
        btSoftBody& fast = sheets.add({0.02f, 0.1f, 0.01f}, {0.2f, 0.02f, 0}, {0, 0.01f, 0.2f}, 5, 0.3f);
        for (const int corner : {0, 6, 42, 48})
        {
            btTransform pose = btTransform::getIdentity();
            pose.setOrigin(hung.m_nodes[corner].m_x + btVector3(0, 1, 0));
            if (anchored)
                hung.appendAnchor(corner, btRigidBody::upcast(&sheets.m_world.addKinematic(shape, pose)), true);
            else
                hung.setMass(corner, 0);
        }
        fast.setVelocity(btVector3(0, -20, 0));
        for (int step = 0; step < 30; ++step)
        {
            EXPECT_EQ(sheets.run(1), 0u);
            longest[anchored] = std::max(longest[anchored], longestOf(hung));
        }
    }
    EXPECT_LT(longest[1], 1.5f * longest[0]);
}

TEST(ClothMeetings, ShortStepsDoNotThrowTanglesApart)
{
    FreeSheets sheets;
    sheets.add({0, 0, 0}, {0.3f, 0, 0}, {0, 0, 0.3f}, 7, 0.1f);
    btSoftBody& crossing = sheets.add({0.25f, 0, 0.01f}, {0.1f, 0.05f, 0}, {0, 0, 0.2f}, 5, 0.1f);
    EXPECT_GT(sheets.meeting(), 0u);
    btScalar fastest = 0;
    for (int step = 0; step < 10; ++step)
    {
        sheets.m_world.world().stepSimulation(1e-3f, 0);
        for (int i = 0; i < crossing.m_nodes.size(); ++i)
            fastest = std::max(fastest, crossing.m_nodes[i].m_v.length());
    }
    EXPECT_GT(fastest, 0);
    EXPECT_LE(fastest, 0.5f);  // m/s; the push alone gives 0.12
}

TEST(ClothMeetings, WhatGoesBeyondTheLimitsIsReported)
{
    for (const bool contacts : {false, true})
    {
        Settings settings = hostSettings();
        (contacts ? settings.m_contactLimit : settings.m_candidateLimit) = 50;
        Layers layers(settings, 2, 0.03f);
        layers.turnGravityOff();
        pin(*layers.m_cloths[1]);
        bool leftOut = false;
        for (int step = 0; step < 30; ++step)
        {
            if (step >= 10) move(*layers.m_cloths[1], btVector3(0, -0.01f, 0));
            layers.m_world.step();
            const StepStatistics& statistics = layers.m_plugin.statistics();
            leftOut = leftOut || (statistics.m_status & kStepClothsLeftOut) != 0;
            EXPECT_TRUE(statistics.m_selfContacts == 0 || statistics.m_selfContacts <= 50u);
            EXPECT_EQ(layers.meeting() > 0, statistics.m_clothPairsMeeting > 0) << contacts << " " << step;
        }
        EXPECT_TRUE(leftOut);
    }
}

// The guard stops the upper sheet, and the box has to stop with it.
TEST(ClothMeetings, ABodyOnTwoSheetsPassesNeither)
{
    for (const btScalar mass : {btScalar(0.5), btScalar(20)})
    {
        btBoxShape shape(btVector3(0.12f, 0.08f, 0.1f));
        Layers layers(hostSettings(), 2, 0.03f);
        for (const int corner : {0, 12, 156, 168})
            layers.m_cloths[0]->setMass(corner, 0);
        btTransform pose = btTransform::getIdentity();
        pose.setOrigin(btVector3(0, 0.75f, 0));
        btRigidBody& box = layers.m_world.addDynamic(shape, mass, pose);
        for (int step = 0; step < 60; ++step)
        {
            EXPECT_EQ(layers.run(1), 0u) << step;
            for (const btSoftBody* cloth : layers.m_cloths)
                ASSERT_EQ(meetingBox(*cloth, box.getWorldTransform(), btVector3(0.12f, 0.08f, 0.1f)), 0u) << step;
        }
        EXPECT_GT(box.getWorldTransform().getOrigin().y(), 0.1f) << mass;
    }
}

TEST(ClothMeetings, AHeavyBodyOnLayersGainsNoEnergy)
{
    for (const int count : {2, 4})
        for (const btScalar mass : {btScalar(1), btScalar(10), btScalar(100)})
        {
            LoadedLayers layers(count, mass);
            const btScalar start = energyOf(layers, *layers.m_box);
            for (int step = 0; step < 90; ++step)
            {
                EXPECT_EQ(layers.run(1), 0u);
                ASSERT_LT(energyOf(layers, *layers.m_box), 1.001f * start) << count << " " << mass << " " << step;
            }
            // The margins of plate and box are inside them.
            EXPECT_NEAR(layers.gap(), kThickness * btScalar(count), 0.02f * kThickness) << count << " " << mass;
            EXPECT_LT(layers.m_box->getLinearVelocity().length(), 0.01f);
        }
}

TEST(ClothMeetings, LayersCarryABodyUpWithThePlateBelow)
{
    LoadedLayers layers(2, 10);
    layers.m_world.step(60);
    const btScalar speed = 0.3f, gap = layers.gap();
    for (int step = 0; step < 60; ++step)
    {
        btTransform pose = layers.m_floor->getWorldTransform();
        pose.getOrigin().setY(pose.getOrigin().y() + speed / 60);
        layers.m_floor->setWorldTransform(pose);
        EXPECT_EQ(layers.run(1), 0u);
        EXPECT_NEAR(layers.gap(), gap, 0.1f * kThickness) << step;
    }
    EXPECT_NEAR(layers.m_box->getLinearVelocity().y(), speed, 0.05f * speed);
}

TEST(ClothMeetings, ImpactsKeepTheMomentum)
{
    for (const btScalar speed : {btScalar(2), btScalar(10)})
    {
        Layers sheets(hostSettings(), 2, 0.1f);
        sheets.turnGravityOff();
        sheets.m_cloths[1]->setVelocity(btVector3(0, -speed, 0));
        const btVector3 before = sheets.momentum();
        EXPECT_EQ(sheets.run(60), 0u);
        EXPECT_LT((sheets.momentum() - before).length(), 1e-5f * before.length()) << speed;

        btBoxShape shape(btVector3(0.1f, 0.1f, 0.1f));
        Layers layers(hostSettings(), 2, 0.03f);
        layers.turnGravityOff();
        btTransform pose(btQuaternion(btVector3(1, 0.5f, 0.2f).normalized(), 0.3f), btVector3(0.03f, 0.9f, 0.02f));
        btRigidBody& box = layers.m_world.addDynamic(shape, 0.5f, pose);
        box.setDamping(0, 0);
        box.setLinearVelocity(btVector3(0, -speed, 0));
        const btVector3 whole = box.getLinearVelocity() / box.getInvMass();
        EXPECT_EQ(layers.run(60), 0u);
        const btVector3 after = layers.momentum() + box.getLinearVelocity() / box.getInvMass();
        EXPECT_LT((after - whole).length(), 1e-5f * whole.length()) << speed;
        EXPECT_LT(box.getLinearVelocity().length(), 0.9f * speed);
    }
}

// Returns the kinetic energy, J.
btScalar motionOf(const Layers& layers)
{
    btScalar energy = 0;
    for (const btSoftBody* cloth : layers.m_cloths)
        for (int i = 0; i < cloth->m_nodes.size(); ++i)
            energy += cloth->m_nodes[i].m_v.length2() / (2 * cloth->m_nodes[i].m_im);
    return energy;
}

// Two sheets fly towards each other, without gravity.
struct MeetingSheets : Layers
{
    MeetingSheets(int lower, int upper) : Layers(hostSettings(), 2, 0.1f)
    {
        turnGravityOff();
        m_cloths[0]->m_cfg.piterations = lower;
        m_cloths[1]->m_cfg.piterations = upper;
        m_cloths[0]->setVelocity(btVector3(0.2f, 1, 0));
        m_cloths[1]->setVelocity(btVector3(0, -2, 0.1f));
    }

    // Runs a step, and expects that no momentum or energy comes.
    void keepSteps(int steps, btScalar dt = kDt)
    {
        for (int i = 0; i < steps; ++i)
        {
            m_world.world().stepSimulation(dt, 0);
            ASSERT_LT((momentum() - m_momentum).length(), 1e-5f * m_momentum.length()) << i;
            ASSERT_LT(motionOf(*this), 1.001f * m_energy) << i;
        }
    }
    void start()
    {
        m_momentum = momentum();
        m_energy = motionOf(*this);
    }

    btVector3 m_momentum;
    btScalar m_energy = 0;
};

TEST(ClothMeetings, ClothsOfDifferentSubstepsKeepTheirMomentum)
{
    for (const auto& counts : {std::pair<int, int>(1, 8), {8, 1}, {5, 3}})
    {
        MeetingSheets sheets(counts.first, counts.second);
        sheets.start();
        sheets.keepSteps(60);
        EXPECT_LT(sheets.m_cloths[0]->m_nodes[84].m_v.y(), 0.5f) << counts.first << " " << counts.second;
    }
}

TEST(ClothMeetings, ClothsThatCorrectAtDifferentRatesKeepTheirMomentum)
{
    MeetingSheets changing(2, 8), slow(5, 5), fast(5, 5);
    changing.m_cloths[0]->m_cfg.viterations = 1;
    changing.m_world.step(1);
    EXPECT_FALSE(changing.m_plugin.whyBulletSolves(*changing.m_cloths[0]).empty());
    changing.m_cloths[0]->m_cfg.viterations = 0;
    changing.start();
    changing.keepSteps(10);
    changing.keepSteps(40, kDt / 4);
    slow.m_cloths[0]->m_cfg.timescale = 0.5f;
    fast.m_cloths[1]->m_cfg.timescale = 0.3f;
    for (MeetingSheets* sheets : {&slow, &fast})
    {
        sheets->start();
        sheets->keepSteps(60);
    }
}

TEST(ClothMeetings, SheetsOfDifferentSubstepsFallTogether)
{
    Layers layers(hostSettings(), 2, 0.02f);
    layers.m_cloths[0]->m_cfg.piterations = 10;
    layers.m_cloths[1]->m_cfg.piterations = 4;
    EXPECT_EQ(layers.run(60), 0u);
    for (const btSoftBody* cloth : layers.m_cloths)
        for (const int node : {0, 84, 168})
            EXPECT_NEAR(cloth->m_nodes[node].m_v.y(), -9.81f, 0.02f) << node;
}

// Cloth that sleeps or stands still takes no part in the choice of the substeps.
TEST(ClothMeetings, ClothThatDoesNotMoveSharesNoSubsteps)
{
    std::vector<std::vector<float>> ends;
    for (int way = 0; way < 4; ++way)
    {
        Layers layers(hostSettings(), 2, -3.0f);  // the other falls far below
        btSoftBody &moving = *layers.m_cloths[0], &other = *layers.m_cloths[1];
        moving.setMass(0, 0);
        moving.m_cfg.piterations = 3;
        other.m_cfg.piterations = way == 0 ? 3 : 12;
        if (way == 1) other.setActivationState(ISLAND_SLEEPING);
        if (way == 2) other.m_cfg.timescale = 0;
        layers.m_world.step(20);
        ends.push_back(positionsOf(moving));
    }
    EXPECT_EQ(ends[0], ends[1]);
    EXPECT_EQ(ends[0], ends[2]);
    EXPECT_NE(ends[0], ends[3]);
}

// Adds two or three free sheets of a few nodes that fly into each other and turn. The caller owns them.
void throwSheets(Layers& layers, unsigned seed)
{
    std::mt19937 generator(seed);
    const auto random = [&](btScalar low, btScalar high)
    { return low + (high - low) * btScalar(generator() % 1000) / 1000; };
    const auto randomVector = [&](btScalar most)
    {
        const btScalar x = random(-most, most), y = random(-most, most), z = random(-most, most);
        return btVector3(x, y, z);
    };
    layers.turnGravityOff();
    const int count = 2 + int(generator() % 2);
    for (int k = 0; k < count; ++k)
    {
        const int nodes = 3 + int(generator() % 3);
        const btVector3 centre = randomVector(0.15f) * btVector3(1, 0.1f, 1) + btVector3(0, 0.1f * btScalar(k), 0);
        const btVector3 u = randomVector(0.03f) + btVector3(0.3f, 0, 0),
                        v = randomVector(0.03f) + btVector3(0, 0, 0.3f);
        btSoftBody* const cloth =
            btSoftBodyHelpers::CreatePatch(layers.m_world.world().getWorldInfo(), centre - u - v, centre + u - v,
                                           centre - u + v, centre + u + v, nodes, nodes, 0, true);
        cloth->getCollisionShape()->setMargin(0.004f);
        cloth->m_cfg.piterations = 5;
        cloth->setTotalMass(random(0.1f, 1));
        const btVector3 velocity = randomVector(1) + btVector3(0, k == 0 ? 1 : -1, 0), spin = randomVector(5);
        for (int i = 0; i < cloth->m_nodes.size(); ++i)
            cloth->m_nodes[i].m_v = velocity + spin.cross(cloth->m_nodes[i].m_x - centre);
        layers.m_plugin.setSelfCollision(*cloth, true);
        layers.m_world.world().addSoftBody(cloth);
        layers.m_cloths.push_back(cloth);
    }
}

TEST(ClothMeetings, FreeSheetsThatHookIntoEachOtherGainLittleEnergy)
{
    for (unsigned seed = 0; seed < 20; ++seed)
    {
        Layers layers(hostSettings(), 0, 0);
        throwSheets(layers, seed);
        const btScalar start = motionOf(layers);
        btScalar most = start;
        for (int step = 0; step < 60; ++step)
        {
            layers.m_world.step();
            most = std::max(most, motionOf(layers));
        }
        EXPECT_LT(most, 1.5f * start) << seed;
        for (btSoftBody* cloth : layers.m_cloths)
        {
            layers.m_world.world().removeSoftBody(cloth);
            layers.m_plugin.setSelfCollision(*cloth, false);
            delete cloth;
        }
    }
}
}  // namespace drape::test
