// Changes of a cloth's faces that no count shows: faces get other nodes in place.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_plugin/adapter/mirrors/mirrors.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
std::unique_ptr<btSoftBody> makePatch(btSoftBodyWorldInfo& info, int nodes)
{
    return std::unique_ptr<btSoftBody>(btSoftBodyHelpers::CreatePatch(
        info, btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 0, 1), btVector3(1, 0, 1), nodes, nodes, 0, true));
}

// Returns the number of steps, after `before` others, until the pipeline has the other nodes of the last face.
int stepsUntilSeen(int nodes, int before)
{
    btSoftBodyWorldInfo info;
    const std::unique_ptr<btSoftBody> body = makePatch(info, nodes);
    const std::unique_ptr<Pipeline> pipeline = makePipeline(hostSettings());
    if (!pipeline) return -1;
    ClothMirror mirror(body.get());
    for (int step = 0; step < before; ++step)
        EXPECT_NE(mirror.refresh(*pipeline), kNoMesh);
    const std::vector<std::int32_t> triangles = mirror.faces().triangles();
    btSoftBody::Face& last = body->m_faces[body->m_faces.size() - 1];
    std::swap(last.m_n[0], last.m_n[1]);
    for (int step = 1; step < 10; ++step)
    {
        EXPECT_NE(mirror.refresh(*pipeline), kNoMesh);
        if (mirror.faces().triangles() == triangles) continue;
        EXPECT_EQ(mirror.faces().triangles()[triangles.size() - 3], triangles[triangles.size() - 2]);
        return step;
    }
    return -1;
}

// Makes two triangles on either side of the tip of a pyramid, which lies under neither.
std::unique_ptr<btSoftBody> twoTriangles(btSoftBodyWorldInfo& info)
{
    const btScalar height = btScalar(0.015);
    const btVector3 places[] = {{-1, height, -1}, {-1, height, 1}, {-2, height, 0},
                                {1, height, -1},  {1, height, 1},  {2, height, 0}};
    const btScalar masses[] = {1, 1, 1, 1, 1, 1};
    std::unique_ptr<btSoftBody> body(new btSoftBody(&info, 6, places, masses));
    body->appendFace(0, 1, 2);
    body->appendFace(3, 4, 5);
    body->getCollisionShape()->setMargin(kMargin);
    return body;
}
}  // namespace

// Mirrors are found by their bodies' addresses. A new body with the same faces may have the address of a deleted one.
// No earlier state that affects a trajectory may remain then.
TEST(ClothMirror, ANewMirrorHasPartsOfTheNodesPositions)
{
    btSoftBodyWorldInfo info;
    const std::unique_ptr<btSoftBody> body = makePatch(info, 80);
    const std::unique_ptr<Pipeline> pipeline = makePipeline(hostSettings());
    ASSERT_TRUE(pipeline);
    ClothMirror reused(body.get());
    reused.refresh(*pipeline);
    for (int i = 0; i < body->m_nodes.size(); ++i)
        body->m_nodes[i].m_x = btVector3(body->m_nodes[i].m_x.z() * 3, 0, body->m_nodes[i].m_x.x());
    ClothMirror fresh(body.get());
    fresh.refresh(*pipeline);
    reused.refresh(*pipeline);
    EXPECT_NE(reused.parts().order(), fresh.parts().order()) << "the cut stays while it is in use";
    reused.takeUp();
    reused.refresh(*pipeline);
    EXPECT_EQ(reused.parts().order(), fresh.parts().order());
}

TEST(ClothMirror, NoticesOtherNodesOfAFaceWithinOneRound)
{
    EXPECT_EQ(stepsUntilSeen(5, 3), 1);
    EXPECT_EQ(stepsUntilSeen(129, 3), 1);  // 32,768 faces
    EXPECT_EQ(stepsUntilSeen(130, 2), 1);  // 33,282: the last of them are next
    EXPECT_EQ(stepsUntilSeen(130, 1), 2);
}

// Two cloths are joined by a face that has two nodes of one and one of the other.
TEST(ClothMirror, LeavesOutAFaceWithAnotherBodysNodeAndReportsIt)
{
    for (const bool foreign : {false, true})
    {
        SCOPED_TRACE(foreign);
        Plugin plugin(hostSettings());
        const TriangleMesh box = makeBox(3.0f, 0.4f, 3.0f);
        MeshShape shape(box);
        DropWorld world(&plugin);
        world.addObstacle(shape.shape());
        ClothSpec spec;
        spec.m_nodes = 9;
        spec.m_size = 0.5f;
        spec.m_centre = btVector3(btScalar(-0.4), btScalar(0.25), 0);
        btSoftBody& cloth = world.addCloth(spec);
        spec.m_centre = btVector3(btScalar(0.4), btScalar(0.25), 0);
        btSoftBody& other = world.addCloth(spec);
        const int own = cloth.m_faces.size();
        cloth.appendFace(0, 1, 9);
        world.step();  // Bullet itself counts the faces of a new body's nodes by their places in its array
        if (foreign) cloth.m_faces[own].m_n[2] = &other.m_nodes[0];
        for (int step = 0; step < 60; ++step)
        {
            world.step();
            ASSERT_EQ(plugin.statistics().m_status, foreign ? std::uint32_t(kStepFacesLeftOut) : kStepGood)
                << "step " << step;
        }
        for (btSoftBody* body : {&cloth, &other})
            EXPECT_NEAR(static_cast<double>(lowestOf(*body)) - 0.2, kThickness, 0.1 * kThickness);
    }
}

class FacesInPlace : public BackendTest
{
};

// No count shows that the second face spans over the pyramid from now on.
TEST_P(FacesInPlace, ChangesCountInTheSameStep)
{
    Plugin plugin(GetParam().m_settings);
    DropWorld world(&plugin);
    TriangleMesh pyramid;
    pyramid.m_positions = {-0.3f, 0, -0.3f, -0.5f, -1, -0.5f, -0.1f, -1, -0.5f, -0.3f, -1, -0.1f};
    pyramid.m_triangles = {0, 1, 2, 0, 2, 3, 0, 3, 1};
    MeshShape shape(pyramid);
    world.addObstacle(shape.shape());
    const std::unique_ptr<btSoftBody> body = twoTriangles(world.world().getWorldInfo());
    world.world().addSoftBody(body.get());
    world.step();
    EXPECT_EQ(plugin.statistics().m_contacts, 0u);
    btSoftBody::Face& second = body->m_faces[1];
    for (const int k : {0, 1})
        second.m_n[k] = &body->m_nodes[k];
    second.m_n[2] = &body->m_nodes[3];
    world.step();
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
    world.world().removeSoftBody(body.get());
}

// Nodes without faces hang on a cloth or remain after faces were cut away.
TEST_P(FacesInPlace, NodesWithoutFacesCollideToo)
{
    Plugin plugin(GetParam().m_settings);
    MeshShape slab(makeBox(4.0f, 0.4f, 4.0f));
    DropWorld world(&plugin);
    const btCollisionObject& ground = world.addObstacle(slab.shape());
    ClothSpec spec;
    spec.m_nodes = 9;
    spec.m_centre = btVector3(0, btScalar(0.6), 0);
    btSoftBody& tassel = world.addCloth(spec);
    for (int i = 0; i < 6; ++i)
    {
        tassel.appendNode(btVector3(btScalar(0.56) + btScalar(0.06) * btScalar(i), btScalar(0.6), btScalar(0.5)),
                          btScalar(0.01));
        const int last = tassel.m_nodes.size() - 1;
        tassel.appendLink(i == 0 ? 80 : last - 1, last);
    }
    spec.m_centre = btVector3(0, btScalar(1.2), 0);
    btSoftBody& torn = world.addCloth(spec);
    torn.m_faces.resize(torn.m_faces.size() / 2);
    torn.appendFace(80, 80, 79);  // no face
    for (int step = 0; step < 120; ++step)
    {
        world.step();
        for (const btSoftBody* cloth : {&tassel, &torn})
        {
            ASSERT_EQ(plugin.whyStock(cloth, &ground), "");
            ASSERT_GT(lowestOf(*cloth), btScalar(0.2) + btScalar(0.9 * kThickness)) << "step " << step;
        }
    }
    std::size_t alone = 0;
    for (const ContactInfo& contact : plugin.contacts())
        alone += contact.m_cloth == &tassel && contact.m_nodes[0] > 80;
    EXPECT_GT(alone, 5u);
}

INSTANTIATE_TEST_SUITE_P(Backend, FacesInPlace, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
