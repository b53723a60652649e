// Changes that an app makes between Bullet's dispatch and the solve, in actions and in the tick's callback.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"

namespace drape::test
{
namespace
{
class Between : public BackendTest
{
protected:
    void SetUp() override
    {
        BackendTest::SetUp();
        if (HasFatalFailure() || IsSkipped()) return;
        m_plugin = std::make_unique<Plugin>(GetParam().m_settings);
        m_world = std::make_unique<DropWorld>(m_plugin.get());
        m_world->world().setInternalTickCallback(tick, this);
    }
    btSoftBody& cloth(double height)
    {
        ClothSpec spec;
        spec.m_centre = btVector3(0, btScalar(height), 0);
        return m_world->addCloth(spec);
    }
    // Runs a step with the job between dispatch and solve.
    void stepWith(const std::function<void()>& job)
    {
        m_job = job;
        m_world->step();
        m_job = nullptr;
    }

    std::unique_ptr<Plugin> m_plugin;
    std::unique_ptr<DropWorld> m_world;

private:
    static void tick(btDynamicsWorld* world, btScalar)
    {
        const Between& self = *static_cast<Between*>(world->getWorldUserInfo());
        if (self.m_job) self.m_job();
    }

    std::function<void()> m_job;
};
}  // namespace

TEST_P(Between, AnotherShapeInPlaceOfTheOneThatWasNoted)
{
    const TriangleMesh box = makeBox(2.0f, 0.4f, 2.0f);
    std::unique_ptr<MeshShape> old(new MeshShape(box)), other(new MeshShape(box));
    btCollisionObject& ground = m_world->addObstacle(old->shape());
    btSoftBody& body = cloth(0.23);
    m_world->step(30);
    ASSERT_GT(m_plugin->statistics().m_contacts, 0u);
    stepWith(
        [&]
        {
            ground.setCollisionShape(&other->shape());
            old.reset();
        });
    EXPECT_EQ(m_plugin->statistics().m_contacts, 0u);
    m_world->step(60);
    EXPECT_NEAR(static_cast<double>(lowestOf(body)) - 0.2, kThickness, 0.1 * kThickness);
}

TEST_P(Between, AChildThatIsTakenOutOfItsCompound)
{
    const TriangleMesh box = makeBox(2.0f, 0.4f, 2.0f);
    const btTransform left(btQuaternion::getIdentity(), btVector3(btScalar(-0.9), 0, 0));
    const btTransform right(btQuaternion::getIdentity(), btVector3(btScalar(0.9), 0, 0));
    std::unique_ptr<MeshShape> gone(new MeshShape(box));
    MeshShape stays(box);
    btCompoundShape nested, compound;
    nested.addChildShape(left, &gone->shape());
    nested.addChildShape(right, &stays.shape());
    compound.addChildShape(btTransform::getIdentity(), &nested);
    m_world->addObstacle(compound);
    btSoftBody& body = cloth(0.23);
    m_world->step(30);
    const std::size_t before = m_plugin->statistics().m_contacts;
    stepWith(
        [&]
        {
            nested.removeChildShape(&gone->shape());
            gone.reset();
        });
    EXPECT_GT(m_plugin->statistics().m_contacts, 0u);
    EXPECT_LT(m_plugin->statistics().m_contacts, before);
    m_world->step(30);
    EXPECT_LT(lowestOf(body), btScalar(0.2));  // hangs over the edge of what stays
}

TEST_P(Between, ClothPutToSleepIsSolvedToTheEndOfItsStep)
{
    MeshShape shape(makeBox(2.0f, 0.4f, 2.0f));
    m_world->addObstacle(shape.shape());
    btSoftBody& body = cloth(0.5);
    DropWorld undisturbed(m_plugin.get());
    undisturbed.addObstacle(shape.shape());
    ClothSpec spec;
    spec.m_centre = btVector3(0, btScalar(0.5), 0);
    btSoftBody& twin = undisturbed.addCloth(spec);
    for (int step = 0; step < 60; ++step)
    {
        body.forceActivationState(ACTIVE_TAG);
        stepWith([&] { body.forceActivationState(ISLAND_SLEEPING); });
        undisturbed.step();
        ASSERT_EQ(hashOf(body), hashOf(twin)) << "step " << step;
    }
    EXPECT_NEAR(static_cast<double>(lowestOf(body)) - 0.2, kThickness, 0.1 * kThickness);
}

TEST_P(Between, ClothWokenWaitsForTheNextStep)
{
    const TriangleMesh box = makeBox(2.0f, 0.4f, 2.0f);
    MeshShape shape(box);
    m_world->addObstacle(shape.shape());
    btSoftBody& body = cloth(0.23);
    m_world->step(30);
    body.forceActivationState(ISLAND_SLEEPING);
    m_world->step(3);
    body.m_nodes[0].m_x += btVector3(0, btScalar(0.1), 0);  // for links to pull back, were they solved
    body.m_nodes[0].m_q = body.m_nodes[0].m_x;
    const std::uint64_t asleep = hashOf(body);
    stepWith([&] { body.forceActivationState(ACTIVE_TAG); });
    EXPECT_EQ(hashOf(body), asleep);
    EXPECT_EQ(m_plugin->statistics().m_clothsSkipped, 1u);
    const Course course = runMeasured(*m_world, body, box, 60);
    expectClean(course);
    EXPECT_GT(m_plugin->statistics().m_contacts, 0u);
}

INSTANTIATE_TEST_SUITE_P(Backend, Between, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
