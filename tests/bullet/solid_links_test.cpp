// Finds the links of a soft body that collide, and notices changes in place.
#include "bullet_plugin/adapter/mirrors/solid_links.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "scenes/shapes.h"
#include "tests/bullet/rope_scene.h"

namespace drape::test
{
namespace
{
using Nodes = std::vector<std::int32_t>;

Nodes solidOf(const btSoftBody& body)
{
    SolidLinks links;
    links.read(body, meshOf(body).m_triangles);
    return links.nodes();
}

std::unique_ptr<btSoftBody> makePatch(btSoftBodyWorldInfo& info)
{
    return std::unique_ptr<btSoftBody>(btSoftBodyHelpers::CreatePatch(
        info, btVector3(0, 0, 0), btVector3(1, 0, 0), btVector3(0, 0, 1), btVector3(1, 0, 1), 4, 4, 0, true));
}
}  // namespace

TEST(SolidLinks, AllLinksOfARopeButBendingLinksCount)
{
    btSoftBodyWorldInfo info;
    const std::unique_ptr<btSoftBody> rope = makeRope(info, btVector3(0, 0, 0), btVector3(1, 0, 0), 3);
    rope->generateBendingConstraints(2);
    EXPECT_GT(rope->m_links.size(), 3);
    EXPECT_EQ(solidOf(*rope), (Nodes{0, 1, 1, 2, 2, 3}));
    EXPECT_TRUE(hasSolidLink(*rope));
    for (int i = 0; i < rope->m_links.size(); ++i)
        rope->m_links[i].m_bbending = -1;
    EXPECT_FALSE(hasSolidLink(*rope));
    EXPECT_TRUE(solidOf(*rope).empty());
}

TEST(SolidLinks, LinksWithinASurfaceDoNotCount)
{
    btSoftBodyWorldInfo info;
    const std::unique_ptr<btSoftBody> patch = makePatch(info);
    patch->appendLink(0, 15);
    EXPECT_TRUE(solidOf(*patch).empty());
}

TEST(SolidLinks, LinksThatHangFromASurfaceOrJoinTwoCount)
{
    btSoftBodyWorldInfo info;
    const std::unique_ptr<btSoftBody> body = makePatch(info);
    for (int i = 0; i < 5; ++i)
        body->appendNode(btVector3(2, 0, btScalar(i)), 1);
    body->appendFace(16, 17, 18);
    body->appendLink(15, 16);  // a link between two surfaces
    body->appendLink(3, 19);   // hangs
    body->appendLink(19, 20);
    body->appendLink(16, 18);
    EXPECT_EQ(solidOf(*body), (Nodes{15, 16, 3, 19, 19, 20}));
}

// A tetrahedron and its inside count as a surface, too.
TEST(SolidLinks, LinksWithinTetrahedraDoNotCount)
{
    btSoftBodyWorldInfo info;
    const btVector3 places[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {2, 2, 2}};
    const btScalar masses[] = {1, 1, 1, 1, 1, 1};
    btSoftBody body(&info, 6, places, masses);
    body.appendTetra(0, 1, 2, 3);
    body.appendTetra(1, 2, 3, 4);
    body.appendLink(0, 4);
    body.appendLink(4, 5);
    EXPECT_EQ(solidOf(body), (Nodes{4, 5}));
}

TEST(SolidLinks, LinksWithAnotherBodysNodeAreLeftOutAndReported)
{
    btSoftBodyWorldInfo info;
    const std::unique_ptr<btSoftBody> rope = makeRope(info, btVector3(0, 0, 0), btVector3(1, 0, 0), 3);
    const std::unique_ptr<btSoftBody> other = makePatch(info);
    rope->m_links[1].m_n[1] = &other->m_nodes[2];
    SolidLinks links;
    links.read(*rope, {});
    EXPECT_EQ(links.nodes(), (Nodes{0, 1, 2, 3}));
    EXPECT_TRUE(links.hasForeign());
}

TEST(SolidLinks, ChangeWithANodeOfALinkButNotWithTheirOrder)
{
    btSoftBodyWorldInfo info;
    for (const int count : {10, 5000})
    {
        const std::unique_ptr<btSoftBody> rope = makeRope(info, btVector3(0, 0, 0), btVector3(1, 0, 0), count);
        const int looks = 2 * (count / 1024 + 1);
        SolidLinks links;
        links.read(*rope, {});
        const auto changesWithin = [&](int most)
        {
            for (int look = 0; look < most; ++look)
                if (links.changed(*rope, false)) return true;
            return false;
        };
        EXPECT_FALSE(changesWithin(3 * looks));
        std::swap(rope->m_links[1], rope->m_links[7]);
        EXPECT_FALSE(changesWithin(3 * looks));
        EXPECT_FALSE(links.changed(*rope, true));
        rope->m_links[7].m_n[1] = &rope->m_nodes[count];
        EXPECT_TRUE(changesWithin(looks));
        links.read(*rope, {});
        EXPECT_FALSE(links.changed(*rope, true));
        rope->appendLink(0, 3);
        EXPECT_TRUE(links.changed(*rope, false)) << "at once";
    }
}

// Removed and added links count in the same step.
TEST(SolidLinks, ChangesCountInTheSameStep)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    MeshShape box(makeBox(1.0f, 1.0f, 1.0f));
    const btCollisionObject& object = world.addObstacle(box.shape());
    // The ends are beside the box, so that only a link between them comes near it.
    const btVector3 places[] = {{btScalar(-0.7), btScalar(0.51), 0}, {btScalar(0.7), btScalar(0.51), 0}, {2, 2, 0}};
    const btScalar masses[] = {1, 1, 1};
    btSoftBody body(&world.world().getWorldInfo(), 3, places, masses);
    body.getCollisionShape()->setMargin(kMargin);
    body.appendLink(1, 2);
    world.world().addSoftBody(&body);
    world.step();
    EXPECT_EQ(plugin.whyStock(&body, &object), "");
    EXPECT_EQ(plugin.statistics().m_contacts, 0u);
    body.appendLink(0, 1);
    world.step();
    EXPECT_GT(plugin.statistics().m_contacts, 0u);
    EXPECT_EQ(plugin.statistics().m_clothTriangles, 0u) << "links are no triangles";
    body.m_links.resize(1);
    world.step();
    EXPECT_EQ(plugin.statistics().m_contacts, 0u);
    world.world().removeSoftBody(&body);
}

TEST(SolidLinks, DrapeTakesABodyWithoutFacesForItsLinks)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    MeshShape box(makeBox(1.0f, 1.0f, 1.0f));
    const btCollisionObject& object = world.addObstacle(box.shape());
    const std::unique_ptr<btSoftBody> rope =
        makeRope(world.world().getWorldInfo(), btVector3(0, 2, 0), btVector3(1, 2, 0), 2);
    world.world().addSoftBody(rope.get());
    EXPECT_EQ(plugin.whyStock(rope.get(), &object), "");
    rope->appendTetra(0, 1, 2, 0);
    EXPECT_NE(plugin.whyStock(rope.get(), &object).find("tetrahedra"), std::string::npos);
    rope->m_tetras.clear();
    rope->m_links.clear();
    EXPECT_NE(plugin.whyStock(rope.get(), &object).find("neither faces nor links"), std::string::npos);
    world.world().removeSoftBody(rope.get());
}
}  // namespace drape::test
