// Thousands of steps of a world in which everything changes: bodies are added, removed, teleported, put to sleep and
// woken, and a kinematic board moves among them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/backends.h"
#include "tests/support/cases.h"
#include "tests/support/memory.h"

namespace drape::test
{
namespace
{
constexpr std::uint32_t kSeed = 1300;
constexpr std::size_t kMostBodies = 5;    // bodies of each type
constexpr std::uint32_t kStepsApart = 8;  // steps between two changes, on average

// A world and what lives in it, driven by one row of random numbers.
class Zoo
{
public:
    explicit Zoo(const Settings& settings)
        : m_plugin(settings),
          m_floor(makeBox(8.0f, 0.4f, 8.0f)),
          m_boardShape(makeBox(1.2f, 0.04f, 0.8f)),
          m_random(kSeed),
          m_world(&m_plugin),
          m_board(&m_world.addKinematic(m_boardShape.shape(), boardPose()))
    {
        for (const TriangleMesh& mesh : {makeSphere(0.2f, 1), makeBox(0.4f, 0.3f, 0.2f), makeTorus(0.2f, 0.06f, 8, 6)})
            m_shapes.push_back(std::make_unique<MeshShape>(mesh));
        m_world.addObstacle(m_floor.shape());
    }

    Plugin& plugin() { return m_plugin; }
    DropWorld& world() { return m_world; }
    const std::vector<btSoftBody*>& cloths() const { return m_cloths; }

    void step()
    {
        if (m_random.below(kStepsApart) == 0) change();
        if (m_boardMoves)
        {
            ++m_boardSteps;
            m_board->setWorldTransform(boardPose());
        }
        m_world.step();
    }

    void clear()
    {
        while (!m_cloths.empty())
            removeCloth(0);
        while (!m_obstacles.empty())
            removeObstacle(0);
        m_boardMoves = false;
        m_world.remove(*m_board);
    }

    std::size_t changes(int kind) const { return m_changes[kind]; }
    static constexpr int kKinds = 10;

private:
    btVector3 place(float low, float high)
    {
        const float x = m_random.uniform(-1.5f, 1.5f), y = m_random.uniform(low, high),
                    z = m_random.uniform(-1.5f, 1.5f);
        return btVector3(btScalar(x), btScalar(y), btScalar(z));
    }

    // The board rises, sinks and turns in place.
    btTransform boardPose() const
    {
        const btScalar height = btScalar(0.25) * std::sin(btScalar(0.05) * btScalar(m_boardSteps));
        return btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(0.02) * btScalar(m_boardSteps)),
                           m_boardPlace + btVector3(0, height, 0));
    }
    void teleportBoard()
    {
        m_boardPlace = place(0.4f, 0.8f);
        m_board->setWorldTransform(boardPose());
        m_board->setInterpolationWorldTransform(boardPose());
    }

    void addCloth()
    {
        ClothSpec spec;
        spec.m_nodes = 4 + int(m_random.below(4));
        spec.m_size = m_random.uniform(0.3f, 0.7f);
        spec.m_centre = place(0.5f, 1.0f);
        m_cloths.push_back(&m_world.addCloth(spec));
    }
    void addObstacle()
    {
        const float angle = m_random.uniform(0, 6);
        const btTransform pose(btQuaternion(btVector3(1, 1, 0).normalized(), btScalar(angle)), place(0.3f, 0.6f));
        m_obstacles.push_back(&m_world.addObstacle(m_shapes[m_random.below(3)]->shape(), pose));
    }
    void removeCloth(std::size_t i)
    {
        m_world.remove(*m_cloths[i]);
        m_cloths.erase(m_cloths.begin() + std::ptrdiff_t(i));
    }
    void removeObstacle(std::size_t i)
    {
        m_world.remove(*m_obstacles[i]);
        m_obstacles.erase(m_obstacles.begin() + std::ptrdiff_t(i));
    }

    void changeBoard(int kind)
    {
        ++m_changes[kind];
        if (kind == 8) return teleportBoard();
        m_boardMoves = !m_boardMoves;
    }

    void change()
    {
        const int kind = int(m_random.below(kKinds));
        if (kind >= 8) return changeBoard(kind);
        if (kind == 0 ? m_cloths.size() == kMostBodies : kind == 1 && m_obstacles.size() == kMostBodies) return;
        if (kind >= 2 && (kind % 2 ? m_obstacles.empty() : m_cloths.empty())) return;
        const std::uint32_t at =
            kind < 2 ? 0 : m_random.below(std::uint32_t(kind % 2 ? m_obstacles.size() : m_cloths.size()));
        ++m_changes[kind];
        switch (kind)
        {
            case 0:
                return addCloth();
            case 1:
                return addObstacle();
            case 2:
                return removeCloth(at);
            case 3:
                return removeObstacle(at);
            case 4:
                return m_cloths[at]->translate(place(0.0f, 0.5f) * btScalar(0.3));
            case 5:
                return m_obstacles[at]->setWorldTransform(btTransform(btQuaternion::getIdentity(), place(0.3f, 0.6f)));
            case 6:
                return m_cloths[at]->forceActivationState(ISLAND_SLEEPING);
            default:
                for (btSoftBody* cloth : m_cloths)
                    cloth->forceActivationState(ACTIVE_TAG);
        }
    }

    Plugin m_plugin;
    MeshShape m_floor, m_boardShape;
    std::vector<std::unique_ptr<MeshShape>> m_shapes;
    Random m_random;
    btVector3 m_boardPlace{0, btScalar(0.6), 0};
    int m_boardSteps = 0;
    bool m_boardMoves = true;
    DropWorld m_world;
    btRigidBody* m_board;
    std::vector<btSoftBody*> m_cloths;
    std::vector<btCollisionObject*> m_obstacles;
    std::size_t m_changes[kKinds] = {};
};

// Drops a cloth on a sphere, as in a world of its own.
std::uint64_t fallOnSphere(DropWorld& world, MeshShape& sphere)
{
    btCollisionObject& ball =
        world.addObstacle(sphere.shape(), btTransform(btQuaternion::getIdentity(), btVector3(0, 9, 0)));
    ClothSpec spec;
    spec.m_nodes = 9;
    spec.m_size = 0.5f;
    spec.m_centre = btVector3(0, btScalar(9.35), 0);
    btSoftBody& cloth = world.addCloth(spec);
    world.step(60);
    const std::uint64_t hash = hashOf(cloth);
    world.remove(cloth);
    world.remove(ball);
    return hash;
}
}  // namespace

class Soak : public BackendTest
{
protected:
    // Runs steps that change something; `each` is the least number of changes of each kind.
    void live(Zoo& zoo, int steps, std::size_t each)
    {
        std::size_t inContact = 0;
        for (int step = 0; step < steps; ++step)
        {
            zoo.step();
            const StepStatistics& statistics = zoo.plugin().statistics();
            // Obstacles are put where cloth is, and pulled through it; both are said.
            ASSERT_EQ(statistics.m_status & ~std::uint32_t(kStepStartsIntersecting | kStepSurfacePassed),
                      std::uint32_t(kStepGood))
                << "step " << step << ": " << zoo.plugin().error();
            ASSERT_LT(statistics.m_contacts, 20000u) << "step " << step;
            inContact += statistics.m_contacts > 0;
            for (const btSoftBody* cloth : zoo.cloths())
                ASSERT_LT(rmsSpeed(*cloth), 50.0) << "step " << step;  // a NaN fails too
        }
        EXPECT_GT(inContact, std::size_t(steps) / 2);
        for (int kind = 0; kind < Zoo::kKinds; ++kind)
            EXPECT_GE(zoo.changes(kind), each) << "kind " << kind;
    }

    // Expects no remains: a new cloth falls as in a new world.
    void expectEmptied(Zoo& zoo)
    {
        zoo.clear();
        zoo.world().step(2);
        EXPECT_EQ(zoo.plugin().statistics().m_contacts, 0u);
        MeshShape sphere(makeSphere(0.3f, 2));
        Plugin fresh(GetParam().m_settings);
        DropWorld freshWorld(&fresh);
        EXPECT_EQ(fallOnSphere(zoo.world(), sphere), fallOnSphere(freshWorld, sphere));
    }
};

TEST_P(Soak, TenThousandStepsOfChangeKeepClothOutside)
{
    constexpr int kSteps = 10000, kWarmUp = 1000;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    Zoo zoo(GetParam().m_settings);
    ASSERT_NO_FATAL_FAILURE(live(zoo, kWarmUp, 0));
    const std::size_t memory = residentBytes();
    ASSERT_NO_FATAL_FAILURE(live(zoo, kSteps - kWarmUp, 50));
    EXPECT_LT(residentBytes(), memory + kGrowthBytes);
    expectEmptied(zoo);
}

// The sanitizers run this test.
TEST_P(Soak, AThousandStepsOfChangeKeepClothOutside)
{
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    Zoo zoo(GetParam().m_settings);
    ASSERT_NO_FATAL_FAILURE(live(zoo, 1000, 5));
    expectEmptied(zoo);
}

INSTANTIATE_TEST_SUITE_P(Backend, Soak, testing::ValuesIn(allBackends()), backendName);
}  // namespace drape::test
