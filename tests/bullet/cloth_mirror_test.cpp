// What is noticed of a cloth whose faces get other nodes where they stand, which no count tells.
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_plugin/adapter/mirrors.h"
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

// How many steps pass until the last face's new nodes are in the pipeline.
int stepsUntilSeen(int nodes)
{
    btSoftBodyWorldInfo info;
    const std::unique_ptr<btSoftBody> body = makePatch(info, nodes);
    Settings settings;
    settings.m_backend = Backend::Host;
    const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
    if (!pipeline) return -1;
    ClothMirror mirror(body.get());
    for (int step = 0; step < 3; ++step)
    {
        EXPECT_NE(mirror.refresh(*pipeline), kNoMesh);
        mirror.checkSomeFaces();
    }
    const MeshId before = mirror.refresh(*pipeline);
    const std::vector<std::int32_t> triangles = mirror.faces().triangles();
    btSoftBody::Face& last = body->m_faces[body->m_faces.size() - 1];
    std::swap(last.m_n[0], last.m_n[1]);
    for (int step = 1; step < 10; ++step)
    {
        mirror.checkSomeFaces();
        const MeshId now = mirror.refresh(*pipeline);
        EXPECT_NE(now, kNoMesh);
        EXPECT_EQ(now == before, mirror.faces().triangles() == triangles);
        if (now == before) continue;
        EXPECT_EQ(mirror.faces().triangles()[triangles.size() - 3], triangles[triangles.size() - 2]);
        return step;
    }
    return -1;
}
}  // namespace

TEST(ClothMirror, seesOtherNodesOfAFaceWithinItsStretchesOfFaces)
{
    EXPECT_EQ(stepsUntilSeen(5), 1);
    EXPECT_EQ(stepsUntilSeen(129), 1);  // 32,768 faces
    const int large = stepsUntilSeen(130);
    EXPECT_GE(large, 1);
    EXPECT_LE(large, 2);
}
}  // namespace drape::test
