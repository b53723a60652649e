// What is noticed of a cloth whose faces get other nodes where they stand, which no count tells.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_plugin/adapter/mirrors.h"
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

// How many steps pass, after `before` others, until other nodes for the last face are in the pipeline.
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

// Two triangles on either side of the tip of a pyramid, which lies under neither.
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

TEST(ClothMirror, seesOtherNodesOfAFaceWithinItsStretchesOfFaces)
{
    EXPECT_EQ(stepsUntilSeen(5, 3), 1);
    EXPECT_EQ(stepsUntilSeen(129, 3), 1);  // 32,768 faces
    EXPECT_EQ(stepsUntilSeen(130, 2), 1);  // 33,282: the last of them are next
    EXPECT_EQ(stepsUntilSeen(130, 1), 2);
}

class FacesInPlace : public BackendTest
{
};

// No count tells that the second face spans over the pyramid from now on.
TEST_P(FacesInPlace, countInTheSameStep)
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

INSTANTIATE_TEST_SUITE_P(Backend, FacesInPlace, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
