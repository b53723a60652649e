// Each allocation in turn fails, in each of the public functions. No exception leaves a function, its result follows
// its comment, and the world continues.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include <drape/queries.h>

#include "bullet_plugin/core/public_call.h"
#include "scenes/describe_mesh.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/process/failing_allocations.h"
#include "tests/support/environment.h"
#include "tests/support/own_process.h"

namespace drape::test
{
namespace
{
using Which = FailingAllocations::Which;

constexpr int kFailingSteps = 4, kStepsAfter = 8;
constexpr long kMostAllocations = 100000;

// Cloth lies on a floor and on a rotating box.
struct Scene
{
    explicit Scene(Backend backend = Backend::Host, Solver solver = Solver::Auto)
        : m_plugin(settingsOf(backend, solver)),
          m_floor(makeBox(4, 0.2f, 4)),
          m_box(makeBox(0.3f, 0.3f, 0.3f)),
          m_world(&m_plugin)
    {
        m_floorObject = &m_world.addObstacle(m_floor.shape());
        m_boxBody = &m_world.addKinematic(m_box.shape(), poseAt(0));
        ClothSpec spec;
        spec.m_nodes = 12;
        spec.m_centre = btVector3(0, btScalar(0.45), 0);
        m_cloth = &m_world.addCloth(spec);
    }

    void step(int count = 1)
    {
        for (int i = 0; i < count; ++i)
        {
            m_boxBody->setWorldTransform(poseAt(++m_steps));
            m_world.step();
        }
    }

    // Expects the state after a step without failure.
    void expectGood()
    {
        EXPECT_TRUE(m_plugin.ready()) << m_plugin.error();
        EXPECT_EQ(m_plugin.statistics().m_status, kStepGood) << m_plugin.report();
        EXPECT_FALSE(m_plugin.contacts().empty());
        EXPECT_EQ(m_plugin.whyStock(m_cloth, m_floorObject), "");
        EXPECT_GT(lowestOf(*m_cloth), 0.1f);  // the floor's top
    }

    static Settings settingsOf(Backend backend, Solver solver = Solver::Auto)
    {
        Settings settings;
        settings.m_backend = backend;
        settings.m_solver = solver;
        settings.m_threads = 2;
        return settings;
    }
    static btTransform poseAt(int step)
    {
        return btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(0.01) * btScalar(step)),
                           btVector3(0, btScalar(0.25), 0));
    }

    Plugin m_plugin;
    MeshShape m_floor, m_box;
    DropWorld m_world;
    btCollisionObject* m_floorObject;
    btRigidBody* m_boxBody;
    btSoftBody* m_cloth;
    int m_steps = 0;
};

// Calls scenario(number) for each allocation until it returns false, which means that there were not so many.
void forEachAllocation(long every, const std::function<bool(long)>& scenario)
{
    long number = 0;
    while (number < kMostAllocations && scenario(number))
    {
        if (testing::Test::HasFailure())
        {
            ADD_FAILURE() << "at allocation " << number;
            return;
        }
        number += every;
    }
    EXPECT_GE(number, every);
    EXPECT_LT(number, kMostAllocations);
}

// Runs the call with the allocation failing. Returns whether there were so many.
template <class Call>
bool withFailing(long number, Which which, const Call& call)
{
    const FailingAllocations failing(number, which);
    try
    {
        call();
    }
    catch (...)
    {
        ADD_FAILURE() << "an exception came out";
    }
    return FailingAllocations::hasFailed();
}

// Lets an allocation fail in a world after this many steps.
void expectStepsGoOn(int stepsBefore, Which which, long every, Backend backend = Backend::Host,
                     Solver solver = Solver::Auto)
{
    long told = 0;
    forEachAllocation(every,
                      [&](long number)
                      {
                          Scene scene(backend, solver);
                          scene.step(stepsBefore);
                          std::uint32_t status = 0;
                          const bool failed = withFailing(number, which,
                                                          [&]
                                                          {
                                                              for (int i = 0; i < kFailingSteps; ++i)
                                                              {
                                                                  scene.step();
                                                                  status |= scene.m_plugin.statistics().m_status;
                                                              }
                                                          });
                          EXPECT_EQ(status & ~std::uint32_t(kStepOutOfMemory), kStepGood);
                          told += (status & kStepOutOfMemory) != 0;
                          scene.step(kStepsAfter);
                          scene.expectGood();
                          return failed;
                      });
    EXPECT_GT(told, 0);
}
}  // namespace

TEST(OutOfMemory, FirstStepsGoOn)
{
    inOwnProcess([] { expectStepsGoOn(0, Which::One, 1); });
}

TEST(OutOfMemory, FirstStepsWithSubstepsGoOn)
{
    inOwnProcess([] { expectStepsGoOn(0, Which::One, 1, Backend::Host, Solver::Drape); });
}

TEST(OutOfMemory, StepsInContactGoOn)
{
    inOwnProcess([] { expectStepsGoOn(12, Which::One, 1); });
}

TEST(OutOfMemory, StepsGoOnAfterMemoryIsShortForLong)
{
    inOwnProcess([] { expectStepsGoOn(0, Which::AllFromThere, 7); });
    inOwnProcess([] { expectStepsGoOn(12, Which::AllFromThere, 7); });
}

TEST(OutOfMemory, StepsOnADeviceGoOn)
{
    if (!isDeviceExpected()) GTEST_SKIP();
    inOwnProcess([] { expectStepsGoOn(12, Which::One, 29, Backend::OpenCl); });
}

TEST(OutOfMemory, ClothStandsStillInAStepWithout)
{
    inOwnProcess(
        []
        {
            Scene scene;
            scene.step(12);
            const std::vector<float> before = positionsOf(*scene.m_cloth);
            withFailing(0, Which::AllFromThere, [&] { scene.step(2); });
            EXPECT_EQ(scene.m_plugin.statistics().m_status, kStepOutOfMemory);
            EXPECT_EQ(positionsOf(*scene.m_cloth), before);
            EXPECT_TRUE(scene.m_plugin.contacts().empty());
            scene.step();
            EXPECT_NE(positionsOf(*scene.m_cloth), before);
            scene.expectGood();
        });
}

TEST(OutOfMemory, PrepareLeavesAPluginThatWorks)
{
    inOwnProcess(
        []
        {
            forEachAllocation(1,
                              [](long number)
                              {
                                  Scene scene;
                                  scene.step(3);
                                  const bool failed =
                                      withFailing(number, Which::One,
                                                  [&]
                                                  {
                                                      scene.m_plugin.prepare(scene.m_world.world());
                                                      scene.m_plugin.release(scene.m_world.world());
                                                      scene.m_plugin.setOneSided(&scene.m_floor.shape(), true);
                                                  });
                                  scene.step(kStepsAfter);
                                  scene.expectGood();
                                  return failed;
                              });
        });
}

TEST(OutOfMemory, AnswersSaySo)
{
    inOwnProcess(
        []
        {
            Scene scene;
            scene.step(12);
            Plugin& plugin = scene.m_plugin;
            const std::size_t contacts = plugin.contacts().size();
            const std::string report = plugin.report();
            forEachAllocation(1,
                              [&](long number)
                              {
                                  return withFailing(number, Which::One,
                                                     [&]
                                                     {
                                                         const std::size_t found = plugin.contacts().size();
                                                         EXPECT_TRUE(found == contacts || found == 0) << found;
                                                         const std::string text = plugin.report();
                                                         EXPECT_TRUE(text == report || text == "out of memory") << text;
                                                         const std::string why =
                                                             plugin.whyStock(scene.m_cloth, scene.m_floorObject);
                                                         EXPECT_TRUE(why.empty() || why == "out of memory") << why;
                                                         const std::string status = statusText(kStepInvalidNodes);
                                                         EXPECT_FALSE(status.empty());
                                                         plugin.error();
                                                         plugin.diagnose(scene.m_world.world());
                                                         plugin.obstacleChanged(&scene.m_floor.shape());
                                                     });
                              });
            scene.step(2);
            scene.expectGood();
        });
}

TEST(OutOfMemory, AnErrorWithoutRoomForItsTextSaysSo)
{
    inOwnProcess(
        []
        {
            const char* const call = "the name of a function that is too long for a string without allocation";
            for (const char* const reason : {"short", call})
            {
                Error error;
                EXPECT_TRUE(withFailing(0, Which::AllFromThere,
                                        [&] {
                                            setError(error, call, CaughtException{false, reason});
                                        }));
                EXPECT_EQ(error.text(), "out of memory");
            }
        });
}

TEST(OutOfMemory, InstallSaysSo)
{
    inOwnProcess(
        []
        {
            forEachAllocation(1,
                              [](long number)
                              {
                                  Plugin plugin(Scene::settingsOf(Backend::Host));
                                  DropWorld world(&plugin, Wiring::SolverOnly);
                                  bool installed = false;
                                  const bool failed =
                                      withFailing(number, Which::One,
                                                  [&]
                                                  {
                                                      installed = install(plugin, world.dispatcher(), world.world());
                                                      uninstall(plugin, world.dispatcher(), world.world());
                                                  });
                                  EXPECT_TRUE(installed || failed);
                                  EXPECT_TRUE(install(plugin, world.dispatcher(), world.world()));
                                  return failed || number == 0;
                              });
        });
}

TEST(OutOfMemory, APluginIsMadeOrSaysWhyNot)
{
    inOwnProcess(
        []
        {
            for (const Which which : {Which::One, Which::AllFromThere})
                forEachAllocation(1,
                                  [which](long number)
                                  {
                                      return withFailing(number, which,
                                                         []
                                                         {
                                                             Plugin plugin(Scene::settingsOf(Backend::Host));
                                                             EXPECT_TRUE(plugin.ready() || !plugin.error().empty());
                                                             EXPECT_FALSE(plugin.report().empty());
                                                             EXPECT_FALSE(plugin.device().m_device.m_name.empty());
                                                         });
                                  });
        });
}

TEST(OutOfMemory, AWorldMadeThenIsBulletsOwn)
{
    inOwnProcess(
        []
        {
            forEachAllocation(1,
                              [](long number)
                              {
                                  std::unique_ptr<Plugin> plugin;
                                  std::unique_ptr<SoftBodySolver> solver;
                                  const Settings settings = Scene::settingsOf(Backend::Host);
                                  const bool failed =
                                      withFailing(number + 1, Which::One,
                                                  [&]
                                                  {
                                                      plugin.reset(new (std::nothrow) Plugin(settings));
                                                      if (plugin)
                                                          solver.reset(new (std::nothrow) SoftBodySolver(*plugin));
                                                  });
                                  if (!plugin || !solver) return failed;
                                  DropWorld world(plugin.get());
                                  world.addCloth(ClothSpec());
                                  world.step(2);
                                  return failed;
                              });
        });
}

TEST(OutOfMemory, QueriesFailAndSaySo)
{
    inOwnProcess(
        []
        {
            const TriangleMesh sphere = makeSphere(1, 0);
            const MeshDescription mesh = describeMesh(sphere);
            std::vector<float> end = sphere.m_positions;
            for (float& coordinate : end)
                coordinate *= 0.9f;
            const Settings settings = Scene::settingsOf(Backend::Host);
            forEachAllocation(1,
                              [&](long number)
                              {
                                  return withFailing(
                                      number, Which::One,
                                      [&]
                                      {
                                          Error error;
                                          const std::unique_ptr<Queries> queries = Queries::create(settings, error);
                                          EXPECT_EQ(queries == nullptr, error.failed());
                                          if (!queries) return;
                                          MeshPairs pairs;
                                          MeshMotion motion;
                                          const bool paired = queries->meshPairs(mesh, nullptr, 0.1f, pairs);
                                          const bool moved =
                                              queries->meshMotion(mesh, end.data(), defaultCcdSettings(), motion);
                                          EXPECT_TRUE(paired || (queries->error().failed() && !pairs.m_candidates));
                                          EXPECT_TRUE(moved || (queries->error().failed() && !motion.m_trianglePairs));
                                          // The allocation that fails has failed.
                                          if (!paired || !moved)
                                          {
                                              EXPECT_TRUE(queries->meshPairs(mesh, nullptr, 0.1f, pairs));
                                          }
                                      });
                              });
        });
}
}  // namespace drape::test
