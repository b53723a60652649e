// Cloths whose contacts several threads hold, Drape's or the app's: the same courses, to the bit, as with the caller's
// thread alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include <LinearMath/btThreads.h>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/job_pool.h"

namespace drape::test
{
namespace
{
constexpr int kSteps = 18;
// Rounds over at least this many contacts are shared by threads: 512 blocks of four.
constexpr std::size_t kShared = 2048;

struct Courses
{
    std::vector<std::uint64_t> m_hashes;  // by cloth
    std::size_t m_contactsMax = 0;
};

// Two large cloths and six small ones fall on bumps, which rest, or rise and turn.
Courses run(unsigned threads, bool moves, const ParallelFor& parallelFor = nullptr)
{
    Settings settings = hostSettings();
    settings.m_threads = threads;
    settings.m_parallelFor = parallelFor;
    Plugin plugin(settings);
    DropWorld world(&plugin);
    MeshShape shape(makeTerrain(3.0f, 0.05f, 96, 3));
    btRigidBody* ground = moves ? &world.addKinematic(shape.shape()) : nullptr;
    if (!moves) world.addObstacle(shape.shape());
    std::vector<btSoftBody*> cloths;
    ClothSpec spec;
    spec.m_nodes = 65;  // together more than are gathered and limited by one thread
    spec.m_size = 1.2f;
    for (const btScalar z : {btScalar(-0.65), btScalar(0.65)})
    {
        spec.m_centre = btVector3(btScalar(-0.6), btScalar(0.12), z);
        cloths.push_back(&world.addCloth(spec));
    }
    spec.m_nodes = 13;
    spec.m_size = 0.3f;
    for (int i = 0; i < 6; ++i)
    {
        spec.m_centre = btVector3(btScalar(0.3 + 0.4 * (i % 3)), btScalar(0.12), btScalar(-0.6 + 0.4 * (i / 3)));
        cloths.push_back(&world.addCloth(spec));
    }
    for (std::size_t i = 0; i < cloths.size(); ++i)
        cloths[i]->m_cfg.piterations = 1 + static_cast<int>(i + 2) % 4;
    Courses courses;
    courses.m_hashes.assign(cloths.size(), kHashStart);
    for (int step = 0; step < kSteps; ++step)
    {
        const btScalar share = btScalar(step) / kSteps;
        if (ground)
            ground->setWorldTransform(btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(0.3) * share),
                                                  btVector3(0, btScalar(0.2) * share, 0)));
        world.step();
        for (std::size_t i = 0; i < cloths.size(); ++i)
            courses.m_hashes[i] = hashOf(*cloths[i], courses.m_hashes[i]);
        courses.m_contactsMax = std::max(courses.m_contactsMax, plugin.statistics().m_contacts);
    }
    return courses;
}

// Returns the run on the caller's thread, which is made once.
const Courses& runAlone(bool moves)
{
    static const Courses runs[2] = {run(1, false), run(1, true)};
    return runs[moves];
}

class PoolScheduler : public btITaskScheduler
{
public:
    explicit PoolScheduler(JobPool& pool) : btITaskScheduler("pool"), m_pool(pool) {}
    int getMaxNumThreads() const override { return 3; }
    int getNumThreads() const override { return 3; }
    void setNumThreads(int) override {}
    void parallelFor(int begin, int end, int, const btIParallelForBody& body) override
    {
        m_pool.parallelFor(std::size_t(end - begin),
                           [&](std::size_t i) { body.forLoop(begin + int(i), begin + int(i) + 1); });
    }
    btScalar parallelSum(int begin, int end, int, const btIParallelSumBody& body) override
    {
        return body.sumLoop(begin, end);
    }

private:
    JobPool& m_pool;
};

ParallelFor parallelForOf(btITaskScheduler& scheduler)
{
    struct Body : btIParallelForBody
    {
        explicit Body(const std::function<void(std::size_t)>& job) : m_job(job) {}
        void forLoop(int begin, int end) const override
        {
            for (int i = begin; i < end; ++i)
                m_job(std::size_t(i));
        }
        const std::function<void(std::size_t)>& m_job;
    };
    return [&scheduler](std::size_t count, const std::function<void(std::size_t)>& job)
    { scheduler.parallelFor(0, int(count), 1, Body(job)); };
}

class ThreadsTest : public testing::TestWithParam<bool>
{
};
}  // namespace

TEST_P(ThreadsTest, AnyNumberOfThreadsGivesTheSameTrajectory)
{
    const Courses& alone = runAlone(GetParam());
    ASSERT_GT(alone.m_contactsMax, kShared);
    for (const unsigned threads : {2u, 7u})
    {
        const Courses shared = run(threads, GetParam());
        EXPECT_EQ(shared.m_hashes, alone.m_hashes) << threads << " threads";
        EXPECT_EQ(shared.m_contactsMax, alone.m_contactsMax);
    }
}

TEST_P(ThreadsTest, TheAppsJobSystemGivesTheSameTrajectory)
{
    JobPool pool(2);
    EXPECT_EQ(run(3, GetParam(), pool.function()).m_hashes, runAlone(GetParam()).m_hashes);
    EXPECT_GT(pool.calls(), std::size_t(kSteps));
}

// Bullet's interface of task schedulers over a pool, as an app may have; Debian's Bullet has none of its own.
TEST(TaskSchedulers, OfBulletGiveTheSameTrajectory)
{
    JobPool pool(3);
    PoolScheduler scheduler(pool);
    EXPECT_EQ(run(3, false, parallelForOf(scheduler)).m_hashes, runAlone(false).m_hashes);
    EXPECT_GT(pool.calls(), std::size_t(kSteps));
    EXPECT_EQ(run(3, false, parallelForOf(*btGetSequentialTaskScheduler())).m_hashes, runAlone(false).m_hashes);
}

INSTANTIATE_TEST_SUITE_P(Obstacle, ThreadsTest, testing::Bool(),
                         [](const auto& moves) { return moves.param ? "moves" : "rests"; });
}  // namespace drape::test
