// Drape's prediction and node trees against Bullet's own, and worlds of many bodies on several threads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_plugin/adapter/motion/node_tree.h"
#include "bullet_plugin/adapter/motion/prediction.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"

namespace drape::test
{
namespace
{
// A cloth without a world, whose nodes have velocities and forces of their own.
struct LooseCloth
{
    explicit LooseCloth(int nodes)
    {
        m_info.m_broadphase = nullptr;
        m_info.m_dispatcher = nullptr;
        m_info.m_gravity = btVector3(0, btScalar(-9.8), 0);
        m_info.m_sparsesdf.Initialize();
        m_body.reset(btSoftBodyHelpers::CreatePatch(m_info, btVector3(-1, 0, -1), btVector3(1, 0, -1),
                                                    btVector3(-1, 0, 1), btVector3(1, 0, 1), nodes, nodes, 1, true));
        m_body->getCollisionShape()->setMargin(kMargin);
        m_body->m_bUpdateRtCst = false;
        for (int i = 0; i < m_body->m_nodes.size(); ++i)
        {
            btSoftBody::Node& node = m_body->m_nodes[i];
            node.m_v = btVector3(std::sin(btScalar(i)), std::cos(btScalar(3 * i)), btScalar(0.1) * btScalar(i % 7));
            // Some forces exceed the bound on a step's change.
            node.m_f = btVector3(btScalar(i % 5), i % 11 == 0 ? btScalar(1e9) : btScalar(-0.5), btScalar(1e-3));
        }
    }

    btSoftBodyWorldInfo m_info;
    std::unique_ptr<btSoftBody> m_body;
};

bool sameBits(const btVector3& a, const btVector3& b)
{
    return std::memcmp(a.m_floats, b.m_floats, 3 * sizeof(btScalar)) == 0;
}

void expectSame(const btSoftBody& is, const btSoftBody& expected)
{
    ASSERT_EQ(is.m_nodes.size(), expected.m_nodes.size());
    for (int i = 0; i < is.m_nodes.size(); ++i)
    {
        const btSoftBody::Node &a = is.m_nodes[i], &b = expected.m_nodes[i];
        ASSERT_TRUE(sameBits(a.m_x, b.m_x) && sameBits(a.m_q, b.m_q) && sameBits(a.m_v, b.m_v)) << "node " << i;
        ASSERT_TRUE(sameBits(a.m_f, b.m_f)) << "node " << i;
        ASSERT_TRUE(sameBits(a.m_leaf->volume.Mins(), b.m_leaf->volume.Mins())) << "node " << i;
        ASSERT_TRUE(sameBits(a.m_leaf->volume.Maxs(), b.m_leaf->volume.Maxs())) << "node " << i;
    }
    for (int side = 0; side < 2; ++side)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_EQ(is.m_bounds[side][axis], expected.m_bounds[side][axis]);
    EXPECT_EQ(is.m_sst.sdt, expected.m_sst.sdt);
    EXPECT_EQ(is.m_sst.isdt, expected.m_sst.isdt);
    EXPECT_EQ(is.m_sst.velmrg, expected.m_sst.velmrg);
    EXPECT_EQ(is.m_sst.radmrg, expected.m_sst.radmrg);
    EXPECT_EQ(is.m_sst.updmrg, expected.m_sst.updmrg);
}

// Returns the number of leaves. Each inner node is around its children, and they name it as their parent.
int checkedLeaves(const btDbvtNode* node)
{
    if (node->isleaf()) return 1;
    int leaves = 0;
    for (int side = 0; side < 2; ++side)
    {
        EXPECT_TRUE(node->volume.Contain(node->childs[side]->volume));
        EXPECT_EQ(node->childs[side]->parent, node);
        leaves += checkedLeaves(node->childs[side]);
    }
    return leaves;
}

class PredictionTest : public testing::TestWithParam<int>
{
};
}  // namespace

TEST_P(PredictionTest, IsBulletsToTheBitOnAnyNumberOfThreads)
{
    for (const unsigned threads : {0u, 2u, 7u})
    {
        SCOPED_TRACE(threads);
        ThreadTeam team(std::max(1u, threads));
        LooseCloth is(GetParam()), expected(GetParam());
        for (int step = 0; step < 4; ++step)
        {
            ASSERT_TRUE(isPlain(*is.m_body, kDt));
            predictPlain(*is.m_body, kDt, threads > 0 ? &team : nullptr);
            updateNodeTree(*is.m_body, threads > 0 ? &team : nullptr);
            expected.m_body->predictMotion(kDt);
            ASSERT_NO_FATAL_FAILURE(expectSame(*is.m_body, *expected.m_body));
            EXPECT_EQ(checkedLeaves(is.m_body->m_ndbvt.m_root), is.m_body->m_nodes.size());
        }
    }
}

TEST_P(PredictionTest, HasBulletsBoundsWhereNodesAreNoNumbers)
{
    ThreadTeam team(2);
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    for (const int broken : {0, GetParam() * GetParam() - 1})
    {
        LooseCloth is(GetParam()), expected(GetParam());
        for (LooseCloth* const cloth : {&is, &expected})
            cloth->m_body->m_nodes[broken].m_x.setX(nan);
        predictPlain(*is.m_body, kDt, &team);
        expected.m_body->predictMotion(kDt);
        for (int axis = 0; axis < 3; ++axis)
        {
            const btScalar low = expected.m_body->m_bounds[0][axis];
            EXPECT_EQ(std::isnan(low), std::isnan(is.m_body->m_bounds[0][axis]));
            if (!std::isnan(low))
            {
                EXPECT_EQ(is.m_body->m_bounds[0][axis], low);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, PredictionTest, testing::Values(2, 17, 97));

TEST(Prediction, LeavesBodiesToBulletThatNeedMore)
{
    LooseCloth cloth(5);
    btSoftBody& body = *cloth.m_body;
    EXPECT_TRUE(isPlain(body, kDt));
    EXPECT_FALSE(isPlain(body, 0));
    const auto expectLeft = [&](auto& member, auto value)
    {
        const auto before = member;
        member = value;
        EXPECT_FALSE(isPlain(body, kDt));
        member = before;
    };
    expectLeft(body.m_cfg.kLF, btScalar(0.1));
    expectLeft(body.m_cfg.kDG, btScalar(0.1));
    expectLeft(body.m_cfg.kPR, btScalar(-1));
    expectLeft(body.m_cfg.kVC, btScalar(1));
    expectLeft(body.m_cfg.timescale, btScalar(0));
    expectLeft(body.m_bUpdateRtCst, true);
    expectLeft(body.m_pose.m_bframe, true);
    expectLeft(body.m_cfg.collisions, body.m_cfg.collisions | btSoftBody::fCollision::VF_SS);
    body.initializeFaceTree();
    EXPECT_FALSE(isPlain(body, kDt));
}

// Rays meet the cloth where it is, before and after Bullet makes its tree of faces for the first of them.
TEST(Prediction, RaysAndNodesOfBulletFindClothAfterEachStep)
{
    Plugin plugin(hostSettings());
    DropWorld world(&plugin);
    MeshShape shape(makeTerrain(3.0f, 0.05f, 16, 3));
    world.addObstacle(shape.shape());
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(0.6), 0);
    btSoftBody& cloth = world.addCloth(spec);
    for (int step = 0; step < 30; ++step)
    {
        world.step();
        // Bullet's rays make the tree of nodes anew together with that of the faces.
        ASSERT_EQ(checkedLeaves(cloth.m_ndbvt.m_root), cloth.m_nodes.size()) << "step " << step;
        const btSoftBody::Face& face = cloth.m_faces[(7 * step) % cloth.m_faces.size()];
        const btVector3 middle = (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3;
        btSoftBody::sRayCast hit;
        ASSERT_TRUE(cloth.rayTest(middle + btVector3(0, 3, 0), middle - btVector3(0, 3, 0), hit)) << "step " << step;
        EXPECT_NEAR(hit.fraction, 0.5, 0.1);
        if (step == 10) cloth.m_fdbvt.clear();
    }
}

// Small cloths, of which some blow in the wind, hang on pins or fall on a box that Bullet handles.
TEST(Prediction, ManyBodiesMoveAlikeOnAnyNumberOfThreads)
{
    const auto run = [](unsigned threads)
    {
        Settings settings = hostSettings();
        settings.m_threads = threads;
        settings.m_staticConvex = ShapeContacts::Bullet;
        Plugin plugin(settings);
        DropWorld world(&plugin);
        MeshShape ground(makeTerrain(6.0f, 0.05f, 48, 3));
        btBoxShape box(btVector3(1, btScalar(0.2), 1));
        world.addObstacle(ground.shape());
        world.addObstacle(box, btTransform(btQuaternion::getIdentity(), btVector3(5, 0, 0)));
        std::vector<btSoftBody*> cloths;
        ClothSpec spec;
        spec.m_size = 0.5f;
        for (int i = 0; i < 30; ++i)
        {
            spec.m_centre = btVector3(btScalar(0.7) * btScalar(i % 6 - 3), btScalar(0.15), btScalar(i / 6) - 2);
            if (i % 10 == 9) spec.m_centre = btVector3(5, btScalar(0.25), btScalar(i / 10 - 1));
            cloths.push_back(&world.addCloth(spec));
            if (i % 5 == 1) cloths.back()->m_cfg.kDG = btScalar(0.2);
            if (i % 5 == 2) cloths.back()->setMass(0, 0);
        }
        spec.m_nodes = 97;
        spec.m_centre = btVector3(0, 2, 0);
        cloths.push_back(&world.addCloth(spec));
        std::uint64_t hash = kHashStart;
        std::size_t stock = 0;
        for (int step = 0; step < 20; ++step)
        {
            world.step();
            for (btSoftBody* const cloth : cloths)
            {
                hash = hashOf(*cloth, hash);
                stock += std::size_t(cloth->m_rcontacts.size());
            }
        }
        EXPECT_GT(stock, 0u);
        EXPECT_GT(plugin.statistics().m_contacts, 0u);
        return hash;
    };
    const std::uint64_t alone = run(1);
    for (const unsigned threads : {2u, 7u})
        EXPECT_EQ(run(threads), alone) << threads << " threads";
}
}  // namespace drape::test
