// An app that has set another floating-point environment: traps, subnormal numbers flushed to zero, other rounding.
#include <gtest/gtest.h>

#include <cfenv>
#include <cstring>
#include <functional>
#include <vector>

#include <drape/queries.h>

#include "scenes/describe_mesh.h"
#include "scenes/shapes.h"
#include "tests/bullet/drop_world.h"
#include "tests/support/environment.h"
#include "tests/support/own_process.h"

#ifdef __x86_64__
#include <immintrin.h>

namespace drape::test
{
namespace
{
constexpr int kTraps = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
constexpr unsigned kFlush = 0x8040;  // flush results and operands

// Sets the environment of this thread until it ends.
class AppFloats
{
public:
    explicit AppFloats(const std::function<void()>& set)
    {
        std::fegetenv(&m_before);
        set();
    }
    ~AppFloats() { std::fesetenv(&m_before); }

private:
    std::fenv_t m_before;
};

void trap()
{
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(kTraps);
}
void flush()
{
    _mm_setcsr(_mm_getcsr() | kFlush);
}
void roundUp()
{
    std::fesetround(FE_UPWARD);
}

// The part of the environment that a program can query.
struct Seen
{
    unsigned m_csr = _mm_getcsr();
    int m_rounding = std::fegetround(), m_raised = std::fetestexcept(FE_ALL_EXCEPT), m_traps = fegetexcept();

    bool operator==(const Seen& other) const
    {
        return m_csr == other.m_csr && m_rounding == other.m_rounding && m_raised == other.m_raised &&
               m_traps == other.m_traps;
    }
};

struct Scene
{
    explicit Scene(Plugin& plugin) : m_ball(makeSphere(0.5f, 2)), m_world(&plugin)
    {
        m_obstacle = &m_world.addObstacle(m_ball.shape());
        ClothSpec spec;
        spec.m_centre = btVector3(0, btScalar(0.55), 0);
        m_cloth = &m_world.addCloth(spec);
    }

    MeshShape m_ball;
    DropWorld m_world;
    btCollisionObject* m_obstacle;
    btSoftBody* m_cloth;
};

// Returns the contacts of cloth and obstacle that do not move, so that Bullet computes nothing before Drape does. All
// coordinates have bits to round.
std::vector<ContactInfo> contactsAtRest(const Settings& settings, const std::function<void()>& set)
{
    Plugin plugin(settings);
    Scene scene(plugin);
    scene.m_world.world().setGravity(btVector3(0, 0, 0));
    scene.m_world.world().getWorldInfo().m_gravity = btVector3(0, 0, 0);
    scene.m_cloth->translate(btVector3(btScalar(0.0123), btScalar(-0.035), btScalar(0.0077)));
    const AppFloats floats(set);
    scene.m_world.step();
    std::vector<ContactInfo> contacts = plugin.contacts();
    for (ContactInfo& contact : contacts)
    {
        contact.m_cloth = nullptr;  // another one in each scene
        contact.m_obstacle = nullptr;
    }
    return contacts;
}

std::vector<Settings> bothBackends()
{
    std::vector<Settings> settings(isDeviceExpected() ? 2 : 1, hostSettings());
    if (settings.size() > 1) settings[1].m_backend = Backend::OpenCl;
    return settings;
}

bool sameBits(const CcdResult& a, const CcdResult& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}
}  // namespace

TEST(FloatEnvironment, TrapsDoNotStopAWorld)
{
    for (const Settings& settings : bothBackends())
    {
        inOwnProcess(
            [&]
            {
                constexpr int kSteps = 60;
                std::uint64_t hashes[2];
                for (const bool traps : {false, true})
                {
                    const AppFloats floats(traps ? trap : [] {});
                    Plugin plugin(settings);
                    Scene scene(plugin);
                    const Seen before;
                    scene.m_world.step(kSteps);
                    EXPECT_EQ(fegetexcept(), before.m_traps);
                    EXPECT_FALSE(plugin.contacts().empty());
                    EXPECT_EQ(plugin.statistics().m_status, kStepGood) << plugin.report();
                    hashes[traps] = hashOf(*scene.m_cloth);
                }
                EXPECT_EQ(hashes[0], hashes[1]);
            });
    }
}

TEST(FloatEnvironment, OtherEnvironmentsChangeNoContact)
{
    for (const Settings& settings : bothBackends())
    {
        const std::vector<ContactInfo> expected = contactsAtRest(settings, [] {});
        EXPECT_GT(expected.size(), 20u);
        for (void (*set)() : {trap, flush, roundUp})
            EXPECT_TRUE(sameContacts(contactsAtRest(settings, set), expected));
    }
}

TEST(FloatEnvironment, OtherEnvironmentsChangeNoAnswer)
{
    // Distances of subnormal size, and times that are rounded.
    TriangleMesh tiny = makeSphere(1.0f, 1);
    for (float& coordinate : tiny.m_positions)
        coordinate *= 1e-39f;
    const MeshDescription mesh = describeMesh(tiny);
    CcdQuery query = {};
    const float start[4][3] = {{0.1f, 1, 0.1f}, {-1, 0, -1}, {1, 0.1f, -1}, {0, 0.2f, 1}};
    for (int p = 0; p < 4; ++p)
        for (int axis = 0; axis < 3; ++axis)
        {
            query.m_start[3 * p + axis] = start[p][axis];
            query.m_end[3 * p + axis] = start[p][axis] - (p == 0 && axis == 1 ? 1.7f : 0.013f);
        }
    Error error;
    const auto queries = Queries::create(hostSettings(), error);
    ASSERT_TRUE(queries) << error.text();
    MeshPairs expected;
    CcdResult expectedTime;
    ASSERT_TRUE(queries->meshPairs(mesh, nullptr, 1e-39f, expected));
    ASSERT_TRUE(queries->motions(&query, 1, defaultCcdSettings(), &expectedTime));
    EXPECT_GT(expected.m_withinCount, 0u);
    for (void (*set)() : {trap, flush, roundUp})
    {
        const AppFloats floats(set);
        const Seen before;
        MeshPairs pairs;
        CcdResult time;
        ASSERT_TRUE(queries->meshPairs(mesh, nullptr, 1e-39f, pairs));
        ASSERT_TRUE(queries->motions(&query, 1, defaultCcdSettings(), &time));
        EXPECT_TRUE(before == Seen());
        EXPECT_EQ(pairs.m_candidates, expected.m_candidates);
        EXPECT_EQ(pairs.m_withinCount, expected.m_withinCount);
        EXPECT_EQ(pairs.m_intersectingCount, expected.m_intersectingCount);
        EXPECT_TRUE(sameBits(time, expectedTime));
    }
}

TEST(FloatEnvironment, TheAppsEnvironmentReturnsAfterEachCall)
{
    Settings settings = hostSettings();
    int roundingInLog = -1;
    settings.m_log = [&](const char*) { roundingInLog = std::fegetround(); };
    const AppFloats floats(
        []
        {
            roundUp();
            flush();
            std::feclearexcept(FE_ALL_EXCEPT);
            feraiseexcept(FE_INEXACT);
        });
    Plugin plugin(settings);
    Scene scene(plugin);
    scene.m_cloth->translate(btVector3(0, btScalar(-0.3), 0));  // into the ball: there is something to log
    std::feclearexcept(FE_ALL_EXCEPT);
    const Seen before;
    const auto expectSame = [&](const char* call, const std::function<void()>& function)
    {
        function();
        EXPECT_TRUE(before == Seen()) << call;
    };
    expectSame("Plugin", [&] { Plugin other(settings); });
    expectSame("prepare", [&] { plugin.prepare(scene.m_world.world()); });
    expectSame("diagnose", [&] { EXPECT_FALSE(plugin.diagnose(scene.m_world.world()).empty()); });
    expectSame("listDevices", [&] { listDevices(); });
    scene.m_world.step();
    EXPECT_EQ(std::fegetround(), FE_UPWARD);
    EXPECT_EQ(_mm_getcsr() & kFlush, kFlush);
    EXPECT_EQ(roundingInLog, FE_UPWARD);
    std::feclearexcept(FE_ALL_EXCEPT);
    expectSame("contacts", [&] { plugin.contacts(); });
    expectSame("report", [&] { plugin.report(); });
    expectSame("whyStock", [&] { EXPECT_EQ(plugin.whyStock(scene.m_cloth, scene.m_obstacle), ""); });
    expectSame("release", [&] { plugin.release(scene.m_world.world()); });
}
}  // namespace drape::test
#endif
