// A recorder keeps what a world of Bullet's alone does: nodes, poses, contacts, gaps and stretch.
#include <gtest/gtest.h>

#include <cmath>

#include <btBulletDynamicsCommon.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include "drape/recorder.h"
#include "scenes/shapes.h"

namespace drape::test
{
namespace
{
constexpr float kClothMargin = 0.02f, kMeshMargin = 0.01f;  // m

class RecorderTest : public testing::Test
{
protected:
    RecorderTest() : m_dispatcher(&m_configuration), m_world(&m_dispatcher, &m_broadphase, &m_solver, &m_configuration)
    {
        m_world.getWorldInfo().m_gravity = m_world.getGravity();
    }
    ~RecorderTest() override
    {
        for (const auto& body : m_bodies)
            m_world.removeCollisionObject(body.get());
        for (const auto& cloth : m_cloths)
            m_world.removeSoftBody(cloth.get());
    }

    // Adds a square of 5 × 5 nodes, 0.4 m wide, flat at the given height.
    btSoftBody& addCloth(btScalar height)
    {
        const btScalar half = btScalar(0.2);
        m_cloths.emplace_back(btSoftBodyHelpers::CreatePatch(
            m_world.getWorldInfo(), btVector3(-half, height, -half), btVector3(half, height, -half),
            btVector3(-half, height, half), btVector3(half, height, half), 5, 5, 0, true));
        m_cloths.back()->getCollisionShape()->setMargin(btScalar(kClothMargin));
        m_world.addSoftBody(m_cloths.back().get());
        return *m_cloths.back();
    }

    btRigidBody& addBody(btCollisionShape* shape, btScalar mass, const btVector3& place)
    {
        m_bodies.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape, btVector3(1, 1, 1)));
        m_bodies.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
        m_world.addRigidBody(m_bodies.back().get());
        return *m_bodies.back();
    }

    // Makes a shape of the mesh; the test owns it.
    btBvhTriangleMeshShape* meshShape(const TriangleMesh& mesh)
    {
        m_triangles = std::make_unique<btTriangleMesh>();
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        {
            btVector3 corners[3];
            for (std::size_t i = 0; i < 3; ++i)
            {
                const float* p = &mesh.m_positions[3 * static_cast<std::size_t>(mesh.m_triangles[3 * t + i])];
                corners[i].setValue(p[0], p[1], p[2]);
            }
            m_triangles->addTriangle(corners[0], corners[1], corners[2]);
        }
        m_mesh = std::make_unique<btBvhTriangleMeshShape>(m_triangles.get(), true);
        m_mesh->setMargin(btScalar(kMeshMargin));
        return m_mesh.get();
    }

    void step() { m_world.stepSimulation(btScalar(1) / 60, 1, btScalar(1) / 60); }

    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher;
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_solver;
    btSoftRigidDynamicsWorld m_world;
    std::unique_ptr<btTriangleMesh> m_triangles;
    std::unique_ptr<btBvhTriangleMeshShape> m_mesh;
    std::vector<std::unique_ptr<btSoftBody>> m_cloths;
    std::vector<std::unique_ptr<btRigidBody>> m_bodies;
};

const RecordedChannel& channelOf(const RecordedBody& body, const std::string& name)
{
    for (const RecordedChannel& channel : body.m_channels)
        if (channel.m_name == name) return channel;
    throw std::out_of_range(name);
}

const RecordedBody& softOf(const Recording& recording)
{
    for (const RecordedBody& body : recording.m_bodies)
        if (!body.m_rigid) return body;
    throw std::out_of_range("no soft body");
}
}  // namespace

TEST_F(RecorderTest, KeepsNodesAndPosesOfEveryStep)
{
    btBoxShape box(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1)));
    btSoftBody& cloth = addCloth(1);
    btRigidBody& falling = addBody(&box, 1, btVector3(3, 1, 0));
    Recorder recorder(m_world);
    std::vector<float> heights, nodes;
    for (int i = 0; i < 5; ++i)
    {
        step();
        recorder.record();
        heights.push_back(float(falling.getWorldTransform().getOrigin().y()));
        nodes.push_back(float(cloth.m_nodes[7].m_x.y()));
    }
    const Recording& recording = recorder.recording();
    ASSERT_EQ(recording.m_frameCount, 5u);
    ASSERT_EQ(recording.m_bodies.size(), 2u);
    const RecordedBody &rigid = recording.m_bodies[0], &soft = recording.m_bodies[1];
    ASSERT_TRUE(rigid.m_rigid && !soft.m_rigid);
    EXPECT_EQ(rigid.m_triangles.size(), 3u * 12);
    EXPECT_EQ(rigid.vertexCount(), 8u);
    EXPECT_EQ(soft.m_triangles.size(), 3u * 32);
    ASSERT_EQ(soft.frameCount(), 5u);
    for (std::size_t i = 0; i < 5; ++i)
    {
        EXPECT_EQ(rigid.m_frames[7 * i + 1], heights[i]);
        EXPECT_EQ(soft.m_frames[soft.frameSize() * i + 3 * 7 + 1], nodes[i]);
    }
    EXPECT_EQ(recording.m_up[1], 1);
}

TEST_F(RecorderTest, GapsAreDistancesBeyondBothMargins)
{
    TriangleMesh sphere;
    ASSERT_TRUE(makeShape("sphere", sphere));
    placeOnFloor(sphere, 2);
    const float top = boundsOf(sphere).m_high[1];
    addBody(meshShape(sphere), 0, btVector3(0, -btScalar(top), 0));
    btSoftBody& cloth = addCloth(1);
    const auto height = [&](int node, float y) { cloth.m_nodes[node].m_x.setValue(0, btScalar(y), 0); };
    height(0, 0.05f);   // above: 20 mm beyond the margins
    height(1, -0.01f);  // inside
    height(2, 0.03f);   // at rest
    height(3, 0.5f);    // out of reach
    Recorder recorder(m_world);
    recorder.record();
    const RecordedChannel& gap = channelOf(softOf(recorder.recording()), "gap");
    EXPECT_NEAR(gap.m_values[0], 20, 0.1);
    EXPECT_NEAR(gap.m_values[1], -40, 0.1);
    EXPECT_NEAR(gap.m_values[2], 0, 0.1);
    EXPECT_TRUE(std::isnan(gap.m_values[3]));
    EXPECT_FLOAT_EQ(gap.m_high, 80);
    EXPECT_FLOAT_EQ(gap.m_low, -80);
}

TEST_F(RecorderTest, GapsBelowAnOpenMeshArePositiveDistances)
{
    TriangleMesh sheet;
    sheet.m_positions = {-1, 0, -1, 1, 0, -1, -1, 0, 1, 1, 0, 1};
    sheet.m_triangles = {0, 2, 1, 1, 2, 3};
    addBody(meshShape(sheet), 0, btVector3(0, 0, 0));
    btSoftBody& cloth = addCloth(1);
    cloth.m_nodes[0].m_x.setValue(0, btScalar(-0.05), btScalar(0.3));
    Recorder recorder(m_world);
    recorder.record();
    EXPECT_NEAR(channelOf(softOf(recorder.recording()), "gap").m_values[0], 20, 0.01);
}

TEST_F(RecorderTest, StretchIsTheLongestLinkAgainstItsRest)
{
    btSoftBody& cloth = addCloth(1);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        cloth.m_nodes[i].m_x.setX(cloth.m_nodes[i].m_x.x() * btScalar(1.05));
    Recorder recorder(m_world);
    recorder.record();
    const RecordedChannel& stretch = channelOf(softOf(recorder.recording()), "stretch");
    for (const float value : stretch.m_values)
        EXPECT_NEAR(value, 5, 0.01);
}

TEST_F(RecorderTest, BulletsOwnContactsAndMarkedOnesCount)
{
    btBoxShape floor(btVector3(2, 1, 2));
    addBody(&floor, 0, btVector3(0, -1, 0));
    btSoftBody& cloth = addCloth(btScalar(0.05));
    Recorder recorder(m_world);
    recorder.record();
    for (int i = 0; i < 60; ++i)
    {
        step();
        recorder.record();
    }
    recorder.markContact(cloth, 24);
    recorder.markContact(cloth, 25);  // no such node
    const RecordedBody& body = softOf(recorder.recording());
    const std::vector<float>& values = channelOf(body, "contact").m_values;
    const std::size_t count = body.vertexCount();
    ASSERT_EQ(values.size(), count * 61);
    EXPECT_EQ(std::count(values.begin(), values.begin() + std::ptrdiff_t(count), 1.0f), 0);
    EXPECT_GT(std::count(values.end() - std::ptrdiff_t(count), values.end(), 1.0f), 5);
    EXPECT_EQ(values.back(), 1);
}

TEST_F(RecorderTest, BodiesComeAndGoAndChange)
{
    btSoftBody& first = addCloth(1);
    Recorder recorder(m_world);
    recorder.record();
    addCloth(2);
    recorder.record();
    first.appendNode(btVector3(0, 3, 0), 1);
    recorder.record();
    m_world.removeSoftBody(&first);
    recorder.record();
    m_world.addSoftBody(&first);
    recorder.record();
    const std::vector<RecordedBody>& bodies = recorder.recording().m_bodies;
    ASSERT_EQ(bodies.size(), 4u);
    const std::size_t firsts[] = {0, 1, 2, 4}, counts[] = {2, 4, 1, 1};
    for (std::size_t i = 0; i < 4; ++i)
    {
        EXPECT_EQ(bodies[i].m_first, firsts[i]);
        EXPECT_EQ(bodies[i].frameCount(), counts[i]);
    }
    std::string error;
    EXPECT_TRUE(writePointCaches(testing::TempDir() + "drape_bodies", recorder.recording(), error)) << error;
}

TEST_F(RecorderTest, ShapesOfManyKindsHaveTriangles)
{
    btSphereShape ball(btScalar(0.5));
    btCapsuleShape capsule(btScalar(0.2), btScalar(0.5));
    btStaticPlaneShape plane(btVector3(0, 1, 0), 0);
    btCompoundShape pair;
    pair.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(-1, 0, 0)), &ball);
    pair.addChildShape(btTransform(btQuaternion::getIdentity(), btVector3(1, 0, 0)), &capsule);
    for (btCollisionShape* shape : {static_cast<btCollisionShape*>(&ball), static_cast<btCollisionShape*>(&capsule),
                                    static_cast<btCollisionShape*>(&plane), static_cast<btCollisionShape*>(&pair)})
        addBody(shape, 0, btVector3(0, 0, 0));
    Recorder recorder(m_world);
    recorder.record();
    const std::vector<RecordedBody>& bodies = recorder.recording().m_bodies;
    ASSERT_EQ(bodies.size(), 4u);
    for (const RecordedBody& body : bodies)
        EXPECT_FALSE(body.m_triangles.empty()) << body.m_name;
    EXPECT_EQ(bodies[3].m_triangles.size(), bodies[0].m_triangles.size() + bodies[1].m_triangles.size());
}

TEST_F(RecorderTest, RopesAreLines)
{
    m_cloths.emplace_back(
        btSoftBodyHelpers::CreateRope(m_world.getWorldInfo(), btVector3(0, 1, 0), btVector3(1, 1, 0), 8, 1));
    m_world.addSoftBody(m_cloths.back().get());
    Recorder recorder(m_world);
    recorder.record();
    EXPECT_EQ(recorder.recording().m_bodies[0].m_lines.size(), 2u * 9);
}

TEST_F(RecorderTest, BendingLinksOfRopesAreNoLines)
{
    m_cloths.emplace_back(
        btSoftBodyHelpers::CreateRope(m_world.getWorldInfo(), btVector3(0, 1, 0), btVector3(1, 1, 0), 8, 1));
    m_cloths.back()->generateBendingConstraints(2);
    m_world.addSoftBody(m_cloths.back().get());
    Recorder recorder(m_world);
    recorder.record();
    EXPECT_EQ(recorder.recording().m_bodies[0].m_lines.size(), 2u * 9);
}

TEST_F(RecorderTest, FringesOfAClothAreLines)
{
    btSoftBody& cloth = addCloth(1);
    cloth.appendNode(btVector3(1, 1, 0), 1);
    cloth.appendLink(24, 25);
    Recorder recorder(m_world);
    recorder.record();
    EXPECT_EQ(softOf(recorder.recording()).m_lines, (std::vector<std::int32_t>{24, 25}));
    EXPECT_EQ(softOf(recorder.recording()).m_triangles.size(), 3u * 32);
}
}  // namespace drape::test
