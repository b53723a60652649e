// The C interface: its records match those of C++, its functions refuse null, and a C program gets right results.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "bullet_plugin/adapter/c_api/c_records.h"
#include <drape/cloth_world.h>
#include <drape/queries.h>

#include "scenes/shapes.h"
#include "tests/cloth_world/flat_program.h"

namespace drape::test
{
TEST(CApi, ACProgramGetsRightResults)
{
    const char* const problem = runFlatProgram();
    EXPECT_EQ(problem, nullptr) << problem << "\n" << drapeErrorText();
}

TEST(CApi, DefaultsAreThoseOfSettings)
{
    const Settings settings;
    DrapeSettings flat = {};
    drapeDefaultSettings(&flat);
    EXPECT_EQ(flat.m_backend, DRAPE_BACKEND_AUTO);
    EXPECT_EQ(flat.m_crossover, settings.m_crossover);
    EXPECT_EQ(flat.m_activation, settings.m_activation);
    EXPECT_EQ(flat.m_mode, DRAPE_MODE_AUTOMATIC);
    EXPECT_EQ(flat.m_candidateLimit, settings.m_candidateLimit);
    EXPECT_EQ(flat.m_contactLimit, settings.m_contactLimit);
    EXPECT_STREQ(flat.m_device, "");
    EXPECT_EQ(flat.m_log, drapeLogToStandardError);
}

// Each field of C gets a value of its own and arrives in C++.
TEST(CApi, SettingsArriveInCpp)
{
    DrapeSettings flat = {};
    drapeDefaultSettings(&flat);
    flat.m_backend = DRAPE_BACKEND_HOST;
    flat.m_device = "some device";
    flat.m_crossover = 7;
    flat.m_activation = 0.25f;
    flat.m_mode = DRAPE_MODE_CONTINUOUS;
    flat.m_solver = DRAPE_SOLVER_BULLET;
    flat.m_solverPlace = DRAPE_SOLVER_PLACE_DEVICE;
    flat.m_dynamicConvex = DRAPE_SHAPE_CONTACTS_BULLET;
    flat.m_staticConvex = DRAPE_SHAPE_CONTACTS_BULLET;
    flat.m_surfaces = DRAPE_SHAPE_CONTACTS_BULLET;
    flat.m_clothSleeps = 1;
    flat.m_threads = 3;
    flat.m_candidateLimit = 11;
    flat.m_contactLimit = 13;
    flat.m_profileKernels = 1;
    flat.m_cacheFolder = nullptr;
    std::string line;
    flat.m_log = [](const char* text, void* user) { *static_cast<std::string*>(user) = text; };
    flat.m_logUser = &line;
    const Settings settings = settingsOf(&flat);
    EXPECT_EQ(settings.m_backend, Backend::Host);
    EXPECT_EQ(settings.m_device, "some device");
    EXPECT_EQ(settings.m_crossover, 7);
    EXPECT_EQ(settings.m_activation, 0.25f);
    EXPECT_EQ(settings.m_mode, ContactMode::Continuous);
    EXPECT_EQ(settings.m_solver, Solver::Bullet);
    EXPECT_EQ(settings.m_solverPlace, SolverPlace::Device);
    EXPECT_EQ(settings.m_dynamicConvex, ShapeContacts::Bullet);
    EXPECT_EQ(settings.m_staticConvex, ShapeContacts::Bullet);
    EXPECT_EQ(settings.m_surfaces, ShapeContacts::Bullet);
    EXPECT_TRUE(settings.m_clothSleeps);
    EXPECT_EQ(settings.m_threads, 3u);
    EXPECT_EQ(settings.m_candidateLimit, 11u);
    EXPECT_EQ(settings.m_contactLimit, 13u);
    EXPECT_TRUE(settings.m_profileKernels);
    EXPECT_EQ(settings.m_cacheFolder, "");
    settings.m_log("a line");
    EXPECT_EQ(line, "a line");
    flat.m_log = nullptr;
    EXPECT_FALSE(settingsOf(&flat).m_log);
}

// The app's function gets its user pointer, and each index reaches the job.
TEST(CApi, AJobSystemRunsEachJob)
{
    DrapeSettings flat = {};
    drapeDefaultSettings(&flat);
    EXPECT_FALSE(settingsOf(&flat).m_parallelFor);
    std::size_t jobs = 0;
    flat.m_parallelFor = [](size_t count, DrapeJob job, void* context, void* user)
    {
        *static_cast<std::size_t*>(user) += count;
        for (size_t i = count; i-- > 0;)
            job(i, context);
    };
    flat.m_parallelForUser = &jobs;
    std::vector<std::size_t> order;
    settingsOf(&flat).m_parallelFor(3, [&](std::size_t i) { order.push_back(i); });
    EXPECT_EQ(jobs, 3u);
    EXPECT_EQ(order, (std::vector<std::size_t>{2, 1, 0}));
}

TEST(CApi, StatisticsHaveEveryFieldAndSum)
{
    StepStatistics statistics;
    double value = 0;
#define DRAPE_NUMBER(field) statistics.field = static_cast<decltype(statistics.field)>(++value);
    DRAPE_STATISTICS_FIELDS(DRAPE_NUMBER)
#undef DRAPE_NUMBER
    const DrapeStatistics flat = statisticsOf(statistics);
#define DRAPE_COMPARE(field) EXPECT_EQ(double(flat.field), double(statistics.field)) << #field;
    DRAPE_STATISTICS_FIELDS(DRAPE_COMPARE)
#undef DRAPE_COMPARE
    EXPECT_EQ(flat.m_collisionMs, statistics.collisionMs());
    EXPECT_EQ(flat.m_solverMs, statistics.solverMs());
    EXPECT_EQ(flat.m_callsMs, statistics.callsMs());
}

// A new bit of the status has a text: it must have a constant in C, too.
TEST(CApi, StatusBitsAreComplete)
{
    std::uint32_t all = 0;
#define DRAPE_ADD(name, enumerator) all |= DRAPE_STEP_##name;
    DRAPE_STATUS_BITS(DRAPE_ADD)
#undef DRAPE_ADD
    EXPECT_STREQ(drapeStatusText(0xffffffffu), statusText(all).c_str());
}

TEST(CApi, QueriesGiveTheAnswersOfCpp)
{
    DrapeSettings flat = {};
    drapeDefaultSettings(&flat);
    flat.m_backend = DRAPE_BACKEND_HOST;
    const TriangleMesh soup = makeSoup(1, 0.3f, 200, 5), other = makeSoup(1, 0.3f, 100, 9);
    const auto meshOf = [](const TriangleMesh& mesh)
    {
        DrapeMesh own = {};
        own.m_positions = mesh.m_positions.data();
        own.m_vertexCount = mesh.vertexCount();
        own.m_triangles = mesh.m_triangles.data();
        own.m_triangleCount = mesh.triangleCount();
        return own;
    };
    const DrapeMesh a = meshOf(soup), b = meshOf(other);
    Error error;
    const std::unique_ptr<Queries> cpp = Queries::create(settingsOf(&flat), error);
    DrapeQueries* queries = nullptr;
    ASSERT_EQ(drapeQueriesCreate(&flat, &queries), DRAPE_OK) << drapeErrorText();
    MeshPairs pairs;
    const MeshDescription second = descriptionOf(b);
    ASSERT_TRUE(cpp->meshPairs(descriptionOf(a), &second, 0.02f, pairs));
    DrapeMeshPairs found = {};
    ASSERT_EQ(drapeMeshPairs(queries, &a, &b, 0.02f, &found), DRAPE_OK) << drapeErrorText();
    ASSERT_GT(found.m_withinListed, found.m_intersectingListed);
    ASSERT_EQ(found.m_withinListed, pairs.m_within.size());
    EXPECT_EQ(std::memcmp(found.m_within, pairs.m_within.data(), pairs.m_within.size() * sizeof(NearTriangles)), 0);
    EXPECT_EQ(found.m_candidates, pairs.m_candidates);
    EXPECT_EQ(found.m_intersectingCount, pairs.m_intersectingCount);
    drapeQueriesDestroy(queries);
}

TEST(CApi, NullIsRefused)
{
    EXPECT_EQ(drapeListDevices(nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_STREQ(drapeErrorText(), "drapeListDevices: an argument is null");
    EXPECT_EQ(drapeQueriesCreate(nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeQueriesDevice(nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeMotions(nullptr, nullptr, 0, nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeTriangles(nullptr, nullptr, 0, 0, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeMeshPairs(nullptr, nullptr, nullptr, 0, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeMeshMotion(nullptr, nullptr, nullptr, nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeWorldCreate(nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeWorldStep(nullptr, 1), DRAPE_BAD_INPUT);
    EXPECT_STREQ(drapeErrorText(), "drapeWorldStep: the handle is null");
    EXPECT_EQ(drapeWorldAddCloth(nullptr, nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeWorldAddObstacle(nullptr, nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeWorldNodes(nullptr, 0, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeWorldStatistics(nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeWorldContacts(nullptr, nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeWorldClothTriangles(nullptr, nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeWorldDevice(nullptr, nullptr), DRAPE_BAD_INPUT);
    EXPECT_EQ(drapeWorldAwaitDevice(nullptr), DRAPE_BAD_INPUT);
    EXPECT_STREQ(drapeWorldReport(nullptr), "");
    EXPECT_STREQ(drapeWorldDiagnose(nullptr), "");
    EXPECT_STREQ(drapeWorldDeviceError(nullptr), "");
    drapeQueriesDestroy(nullptr);
    drapeWorldDestroy(nullptr);
    drapeDefaultSettings(nullptr);
    drapeDefaultCcdSettings(nullptr);
    drapeDefaultCloth(nullptr);
    drapeDefaultObstacle(nullptr);
}
}  // namespace drape::test
