// Node trees of soft bodies that Drape predicts: whatever of Bullet's reads one finds what it finds among all nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <vector>

#include "BulletSoftBody/btSoftBodyInternals.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
using Node = btSoftBody::Node;

// Returns the nodes that Bullet's algorithm must find beside the object, sorted.
std::vector<const Node*> nodesBeside(const btSoftBody& body, const btCollisionObjectWrapper& obstacle)
{
    std::vector<const Node*> nodes;
    btSoftBody::sCti contact;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.checkContact(&obstacle, body.m_nodes[i].m_x, body.getCollisionShape()->getMargin(), contact))
            nodes.push_back(&body.m_nodes[i]);
    return nodes;
}

std::vector<const Node*> contactNodes(const btSoftBody& body, int first)
{
    std::vector<const Node*> nodes;
    for (int i = first; i < body.m_rcontacts.size(); ++i)
        nodes.push_back(body.m_rcontacts[i].m_node);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

// Returns how many nodes lie beside faces of the other body without a contact that says so.
int missedBeside(const btSoftBody& body, const btSoftBody& other)
{
    const btScalar reach = body.getCollisionShape()->getMargin() + other.getCollisionShape()->getMargin();
    std::set<const Node*> found;
    for (int i = 0; i < body.m_scontacts.size(); ++i)
        found.insert(body.m_scontacts[i].m_node);
    int missed = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const Node& node = body.m_nodes[i];
        btScalar nearest = SIMD_INFINITY;
        for (int j = 0; j < other.m_faces.size(); ++j)
        {
            const btSoftBody::Face& face = other.m_faces[j];
            btVector3 point;
            ProjectOrigin(face.m_n[0]->m_x - node.m_x, face.m_n[1]->m_x - node.m_x, face.m_n[2]->m_x - node.m_x, point,
                          nearest);
        }
        missed += nearest < reach * reach && found.count(&node) == 0;
    }
    return missed;
}

// A solver that compares the contacts that Bullet finds in a body's tree with those of all nodes.
template <class Solver>
class Checked : public Solver
{
public:
    using Solver::Solver;

    void processCollision(btSoftBody* body, const btCollisionObjectWrapper* obstacle) override
    {
        const int before = body->m_rcontacts.size();
        Solver::processCollision(body, obstacle);
        const std::vector<const Node*> found = contactNodes(*body, before);
        EXPECT_EQ(found, nodesBeside(*body, *obstacle));
        m_contacts += found.size();
    }

    void processCollision(btSoftBody* body, btSoftBody* other) override
    {
        Solver::processCollision(body, other);
        m_softContacts += checked(*body, *other) + checked(*other, *body);
    }

    std::size_t m_contacts = 0;
    int m_softContacts = 0;

private:
    // Returns how many contacts the body's nodes have.
    static int checked(const btSoftBody& body, const btSoftBody& other)
    {
        if (other.m_fdbvt.empty()) return 0;
        EXPECT_EQ(missedBeside(body, other), 0);
        return body.m_scontacts.size();
    }
};

// A world with a solver of the test's. Cloth falls on a mesh, which Drape handles, and on a box, which Bullet does.
template <class Solver>
struct CheckedWorld
{
    explicit CheckedWorld(Plugin& plugin)
        : m_configuration(plugin),
          m_dispatcher(&m_configuration),
          m_solver(plugin),
          m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_configuration, &m_solver),
          m_ground(makeTerrain(6.0f, 0.05f, 48, 3)),
          m_boxShape(btVector3(btScalar(0.3), btScalar(0.3), btScalar(0.3)))
    {
        m_world.getWorldInfo().m_gravity = m_world.getGravity();
        const btTransform onGround(btQuaternion(btVector3(0, 1, 0), btScalar(0.4)), btVector3(0, btScalar(-0.1), 0));
        m_objects[0].setCollisionShape(&m_ground.shape());
        m_objects[1].setCollisionShape(&m_boxShape);
        m_objects[1].setWorldTransform(onGround);
        for (btCollisionObject& object : m_objects)
            m_world.addCollisionObject(&object);
    }
    ~CheckedWorld()
    {
        for (const auto& cloth : m_cloths)
            m_world.removeSoftBody(cloth.get());
        for (btCollisionObject& object : m_objects)
            m_world.removeCollisionObject(&object);
    }

    btSoftBody& addCloth(int nodes, btScalar height)
    {
        ClothSpec spec;
        spec.m_nodes = nodes;
        spec.m_centre = btVector3(0, height, 0);
        m_cloths.push_back(makeCloth(m_world.getWorldInfo(), spec));
        m_world.addSoftBody(m_cloths.back().get());
        return *m_cloths.back();
    }
    void step() { m_world.stepSimulation(kDt, 0); }

    CollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    Checked<Solver> m_solver;
    btSoftRigidDynamicsWorld m_world;
    MeshShape m_ground;
    btBoxShape m_boxShape;
    btCollisionObject m_objects[2];
    std::vector<std::unique_ptr<btSoftBody>> m_cloths;
};

// Returns how many leaves do not contain their node with its margin.
int leavesBehind(const btSoftBody& body)
{
    int behind = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const Node& node = body.m_nodes[i];
        const btDbvtVolume box = btDbvtVolume::FromCR(node.m_x, body.getCollisionShape()->getMargin());
        behind += !node.m_leaf->volume.Contain(box);
    }
    return behind;
}

struct CountLeaves : btDbvt::ICollide
{
    void Process(const btDbvtNode*) override { ++m_count; }
    int m_count = 0;
};

// Returns how many nodes a query for everything near the body's nodes meets.
int nodesMet(const btSoftBody& body)
{
    CountLeaves count;
    btDbvtVolume all = btDbvtVolume::FromCR(body.m_nodes[0].m_x, 0);
    for (int i = 1; i < body.m_nodes.size(); ++i)
        Merge(all, btDbvtVolume::FromCR(body.m_nodes[i].m_x, 0), all);
    body.m_ndbvt.collideTV(body.m_ndbvt.m_root, all, count);
    return count.m_count;
}

struct IgnoreResults : btCollisionWorld::ContactResultCallback
{
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override
    {
        return 0;
    }
};
}  // namespace

// Wind hands the body over to Bullet's prediction and back. A contact test reads the tree between steps.
TEST(NodeTree, ContactsWithABoxAreThoseOfAllNodes)
{
    for (const Solver solver : {Solver::Auto, Solver::Bullet})
    {
        Settings settings = hostSettings();
        settings.m_solver = solver;
        settings.m_staticConvex = ShapeContacts::Bullet;
        Plugin plugin(settings);
        CheckedWorld<SoftBodySolver> world(plugin);
        btSoftBody& cloth = world.addCloth(33, btScalar(0.8));
        IgnoreResults ignore;
        for (int step = 0; step < 90; ++step)
        {
            cloth.m_cfg.kDG = step >= 30 && step < 45 ? btScalar(0.2) : btScalar(0);
            world.step();
            if (step % 8 == 7) world.m_world.contactTest(&world.m_objects[1], ignore);
            if (step % 8 != 3 || cloth.m_cfg.kDG > 0) continue;
            plugin.updateNodeTree(cloth);
            EXPECT_EQ(leavesBehind(cloth), 0) << step;
        }
        EXPECT_GT(world.m_solver.m_contacts, 1000u);
        EXPECT_GT(plugin.statistics().m_contacts, 0u);
    }
}

// A cloth that fell asleep with its tree behind, and is to collide with another one only now.
TEST(NodeTree, ContactsWithAnotherClothAreThoseOfAllNodes)
{
    Settings settings = hostSettings();
    settings.m_solver = Solver::Bullet;  // leaves the pair to Bullet
    Plugin plugin(settings);
    CheckedWorld<SoftBodySolver> world(plugin);
    btSoftBody &sleeper = world.addCloth(17, 5), &other = world.addCloth(33, 10);
    other.m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    for (int step = 0; step < 30; ++step)
        world.step();
    EXPECT_EQ(leavesBehind(sleeper), sleeper.m_nodes.size());
    sleeper.forceActivationState(ISLAND_SLEEPING);
    sleeper.m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    other.translate(sleeper.m_nodes[0].m_x - other.m_nodes[0].m_x + btVector3(0, btScalar(0.04), 0));
    for (int step = 0; step < 3; ++step)
        world.step();
    EXPECT_GT(world.m_solver.m_softContacts, 100);
}

// Drape does not see what another solver reads, not even of a body that sleeps.
TEST(NodeTree, IsKeptInEveryStepForASolverOfTheApps)
{
    Settings settings = hostSettings();
    settings.m_staticConvex = ShapeContacts::Bullet;
    Plugin plugin(settings);
    CheckedWorld<SoftBodySolver> world(plugin);
    btSoftBody &cloth = world.addCloth(33, btScalar(0.8)), &sleeper = world.addCloth(17, 20);
    for (int step = 0; step < 30; ++step)
        world.step();
    sleeper.forceActivationState(ISLAND_SLEEPING);
    EXPECT_GT(leavesBehind(sleeper), 0);
    const std::size_t before = world.m_solver.m_contacts;
    Checked<btDefaultSoftBodySolver> other;
    cloth.setSoftBodySolver(&other);
    for (int step = 0; step < 60; ++step)
        world.step();
    EXPECT_GT(other.m_contacts, 1000u);
    EXPECT_EQ(world.m_solver.m_contacts, before);
    EXPECT_EQ(leavesBehind(sleeper), 0);
}

TEST(NodeTree, IsLeftBehindUntilTheAppAsksForIt)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(ClothSpec());
    const int nodes = cloth.m_nodes.size();
    for (int round = 0; round < 3; ++round)
    {
        world.step(30);  // Bullet's first leaves have a margin of 0.25 m
        EXPECT_EQ(leavesBehind(cloth), nodes);
        if (round % 2)
            plugin.updateNodeTree(cloth);
        else
            plugin.updateNodeTrees(world.world());
        EXPECT_EQ(leavesBehind(cloth), 0);
        EXPECT_EQ(nodesMet(cloth), nodes);
    }
}

// Bullet's functions that change the tree find it whole.
TEST(NodeTree, IsWholeForBulletsOwnChanges)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    btSoftBody& cloth = world.addCloth(ClothSpec());
    world.step(30);
    ASSERT_GT(leavesBehind(cloth), 0);
    cloth.translate(btVector3(0, 3, 0));
    EXPECT_EQ(leavesBehind(cloth), 0);
    EXPECT_EQ(nodesMet(cloth), cloth.m_nodes.size());
    world.step(30);
    cloth.m_cfg.kDG = btScalar(0.1);  // from here on Bullet predicts
    world.step();
    EXPECT_EQ(nodesMet(cloth), cloth.m_nodes.size());
    const btDbvtVolume wholeBox = cloth.m_ndbvt.m_root->volume;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        EXPECT_TRUE(wholeBox.Contain(cloth.m_nodes[i].m_leaf->volume));
}

// Reading a tree, however often, changes no trajectory.
TEST(NodeTree, UpdatesChangeNoResults)
{
    const auto run = [](bool reads)
    {
        Plugin plugin(hostSettings());
        CheckedWorld<SoftBodySolver> world(plugin);
        btSoftBody& cloth = world.addCloth(33, btScalar(0.8));
        btBoxShape shape(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)));
        btVector3 inertia;
        shape.calculateLocalInertia(btScalar(0.2), inertia);
        btRigidBody box(btRigidBody::btRigidBodyConstructionInfo(btScalar(0.2), nullptr, &shape, inertia));
        box.setWorldTransform(btTransform(btQuaternion(btVector3(1, 0, 0), 1), btVector3(0, btScalar(0.4), 0)));
        world.m_world.addRigidBody(&box);
        std::uint64_t hash = kHashStart;
        for (int step = 0; step < 60; ++step)
        {
            world.step();
            hash = hashOf(cloth, hash);
            if (reads && step % 3 == 0) plugin.updateNodeTrees(world.m_world);
        }
        world.m_world.removeRigidBody(&box);
        return hash;
    };
    EXPECT_EQ(run(true), run(false));
}
}  // namespace drape::test
