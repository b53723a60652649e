// The automatic choice of the back end. A scene that changes its back end midway gives the contacts of one that does
// not. The report names the back end and the reason.
#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "scenes/cloth_grid.h"
#include "scenes/shapes.h"
#include "tests/support/backends.h"
#include "tests/support/cases.h"
#include "tests/support/environment.h"
#include "tests/support/live_scene.h"
#include "tests/support/pipeline_driver.h"
#include "tests/support/side.h"

namespace drape::test
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The device is the first one.
Settings byCost(double crossover)
{
    Settings settings;
    settings.m_backend = Backend::ByCost;
    settings.m_crossover = crossover;
    return settings;
}

// Adds a cloth over a ball, with a pair.
MeshId addDraped(Pipeline& pipeline, MeshId ball, int nodes)
{
    const TriangleMesh mesh = makeClothGrid(nodes, nodes, 0.8f, 0.51f).m_mesh;
    const MeshId cloth = addCloth(pipeline, mesh);
    setMotion(pipeline, cloth, mesh.m_positions, mesh.m_positions);
    pipeline.addPair(cloth, ball, 0.02f);
    return cloth;
}

std::vector<std::filesystem::path> crossoverFiles(const std::string& folder)
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().filename().string().rfind("crossover-", 0) == 0) files.push_back(entry.path());
    return files;
}

bool isMeasuredNow(const Pipeline& pipeline)
{
    return pipeline.deviceReport().m_crossoverSource.rfind("measured now", 0) == 0;
}

// Returns true if the machine was busy while the crossover was measured.
bool wasBusy(const Pipeline& pipeline)
{
    return pipeline.deviceReport().m_crossoverSource.find("busy") != std::string::npos;
}

void expectFromCache(const Pipeline& later, const Pipeline& earlier)
{
    EXPECT_EQ(isMeasuredNow(later), wasBusy(earlier)) << later.deviceReport().m_crossoverSource;
    EXPECT_EQ(later.deviceReport().m_measureMs == 0, !isMeasuredNow(later));
}

// Processes that compute until this ends.
class BusyProcesses
{
public:
    explicit BusyProcesses(unsigned count)
    {
        for (unsigned i = 0; i < count; ++i)
        {
            const pid_t child = fork();
            for (volatile unsigned spins = 0; child == 0;)
                spins = spins + 1;
            if (child > 0) m_children.push_back(child);
        }
    }
    ~BusyProcesses()
    {
        for (const pid_t child : m_children)
        {
            kill(child, SIGKILL);
            waitpid(child, nullptr, 0);
        }
    }
    BusyProcesses(const BusyProcesses&) = delete;
    BusyProcesses& operator=(const BusyProcesses&) = delete;

private:
    std::vector<pid_t> m_children;
};
}  // namespace

// Uses the first device only. The environment decides nothing.
class BackendMove : public BackendTest
{
protected:
    ScopedVariable m_noDevice{"DRAPE_DEVICE", nullptr}, m_noCrossover{"DRAPE_CROSSOVER", nullptr};
};

// Meshes come and go at random, so that the work passes a crossover in its range time and again.
TEST_P(BackendMove, ContactsDoNotDependOnMoves)
{
    Settings host;
    host.m_backend = Backend::Host;
    std::size_t contacts = 0;
    int moves = 0;
    for (std::uint32_t seed = 1200; seed < 1204; ++seed)
    {
        const std::unique_ptr<Pipeline> moving = makePipeline(byCost(3000)), onHost = makePipeline(host),
                                        onDevice = makePipeline(GetParam().m_settings);
        ASSERT_TRUE(moving && onHost && onDevice);
        LiveScene scene({moving.get(), onHost.get(), onDevice.get()}, seed, true);
        bool wasOnHost = true;
        for (int step = 0; step < 80; ++step)
        {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
            scene.nextStep();
            const std::vector<Contact> found = runStep(*moving);
            const std::vector<Contact> first = runStep(*onHost), second = runStep(*onDevice);
            ASSERT_TRUE(sameBytes(found, first)) << difference(found, first);
            ASSERT_TRUE(sameBytes(found, second)) << difference(found, second);
            const DeviceReport& report = moving->deviceReport();
            EXPECT_EQ(moving->statistics().m_onHost, report.m_onHost && !moving->statistics().m_skipped);
            moves += report.m_onHost != wasOnHost;
            wasOnHost = report.m_onHost;
            contacts += found.size();
        }
    }
    EXPECT_GT(moves, 8);
    EXPECT_GT(contacts, 10000u);
}

// Cloths lie on a ball before the device is there and while it is taken.
TEST_P(BackendMove, AStartInTheBackgroundChangesNoContact)
{
    Settings host;
    host.m_backend = Backend::Host;
    Error error;
    const std::unique_ptr<Pipeline> moving = Pipeline::create(byCost(0), error), onHost = makePipeline(host);
    ASSERT_TRUE(moving && onHost) << error.text();
    EXPECT_TRUE(moving->deviceReport().m_isStarting);
    EXPECT_TRUE(moving->deviceReport().m_onHost);
    LiveScene scene({moving.get(), onHost.get()}, 1250, true);
    std::size_t contacts = 0;
    for (int step = 0; step < 40; ++step)
    {
        if (step == 20) moving->endStart();
        scene.nextStep();
        const std::vector<Contact> found = runStep(*moving), expected = runStep(*onHost);
        ASSERT_TRUE(sameBytes(found, expected)) << "step " << step << ": " << difference(found, expected);
        if (!moving->statistics().m_skipped)
        {
            EXPECT_EQ(moving->statistics().m_onHost, step < 20) << "step " << step;
        }
        contacts += found.size();
    }
    EXPECT_GT(contacts, 1000u);
    EXPECT_FALSE(moving->deviceReport().m_isStarting);
    EXPECT_EQ(moving->deviceReport().m_device.m_name, listDevices()[0].m_name);
    EXPECT_GT(moving->deviceReport().m_buildMs, 0);
}

TEST_P(BackendMove, AGrowingSceneMovesOnceAndTheReportSaysWhy)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(byCost(6000));
    ASSERT_TRUE(pipeline);
    const DeviceReport& report = pipeline->deviceReport();
    EXPECT_TRUE(report.m_byCost);
    EXPECT_TRUE(report.m_onHost);
    EXPECT_EQ(report.m_device.m_name, "host");
    const MeshId ball = addObstacle(*pipeline, makeSphere(0.5f, 3));
    const MeshId small = addDraped(*pipeline, ball, 9);
    EXPECT_GT(runStep(*pipeline).size(), 0u);
    EXPECT_TRUE(report.m_onHost);
    EXPECT_GT(report.m_expectedPairs, 128);
    EXPECT_EQ(report.m_reason, std::to_string(std::lround(report.m_expectedPairs)) + " expected triangle pairs; " +
                                   listDevices()[0].m_name + " above 6000 (set)");

    const MeshId large = addDraped(*pipeline, ball, 41);
    pipeline->addPair(small, ball, 0.02f);
    EXPECT_GT(runStep(*pipeline).size(), 0u);
    EXPECT_FALSE(report.m_onHost);
    EXPECT_FALSE(pipeline->statistics().m_onHost);
    EXPECT_EQ(report.m_device.m_name, listDevices()[0].m_name);
    EXPECT_GT(report.m_expectedPairs, 6000);

    // A step in which the large cloth has no pair is no other scene.
    pipeline->addPair(small, ball, 0.02f);
    runStep(*pipeline);
    EXPECT_FALSE(report.m_onHost);

    pipeline->remove(large);
    pipeline->addPair(small, ball, 0.02f);
    runStep(*pipeline);
    EXPECT_TRUE(report.m_onHost);
    EXPECT_TRUE(pipeline->statistics().m_onHost);
}

TEST_P(BackendMove, AnObstacleThatIsScaledCountsAnew)
{
    const std::unique_ptr<Pipeline> pipeline = makePipeline(byCost(2500));
    ASSERT_TRUE(pipeline);
    TriangleMesh mesh = makeSphere(1.0f, 3);
    const MeshId ball = addObstacle(*pipeline, mesh);
    const MeshId cloth = addDraped(*pipeline, ball, 9);
    runStep(*pipeline);
    const double before = pipeline->deviceReport().m_expectedPairs;
    for (float& coordinate : mesh.m_positions)
        coordinate *= 0.5f;
    pipeline->moveObstacle(ball, mesh.m_positions.data());
    pipeline->addPair(cloth, ball, 0.02f);
    runStep(*pipeline);
    EXPECT_GT(pipeline->deviceReport().m_expectedPairs, before);
}

// The host's preparation of 81,920 triangles takes many times as long as the step.
TEST_P(BackendMove, PrepareLeavesTheHostNothingToBuild)
{
    const auto firstStepMs = [](double crossover, bool prepared)
    {
        const std::unique_ptr<Pipeline> pipeline = makePipeline(byCost(crossover));
        const MeshId ball = addObstacle(*pipeline, makeSphere(0.5f, 6));
        addDraped(*pipeline, ball, 3);
        if (prepared) pipeline->prepare();
        const auto start = std::chrono::steady_clock::now();
        runStep(*pipeline);
        EXPECT_TRUE(pipeline->statistics().m_onHost);
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    for (const double crossover : {1e5, kInfinity})
        EXPECT_LT(firstStepMs(crossover, true), 0.25 * firstStepMs(crossover, false)) << crossover;
}

TEST_P(BackendMove, SettingsAndTheVariableForceIt)
{
    for (const double crossover : {0.0, kInfinity})
    {
        const std::unique_ptr<Pipeline> pipeline = makePipeline(byCost(crossover));
        ASSERT_TRUE(pipeline);
        EXPECT_EQ(pipeline->deviceReport().m_onHost, crossover > 0);
        EXPECT_EQ(pipeline->deviceReport().m_crossoverSource, "set");
        EXPECT_EQ(pipeline->deviceReport().m_reason, "0 expected triangle pairs; " +
                                                         (crossover > 0 ? "the host" : listDevices()[0].m_name) +
                                                         " for any number (set)");
        const MeshId ball = addObstacle(*pipeline, makeSphere(0.5f, 3));
        addDraped(*pipeline, ball, 41);
        runStep(*pipeline);
        EXPECT_EQ(pipeline->statistics().m_onHost, crossover > 0);
    }
    const ScopedVariable variable("DRAPE_CROSSOVER", "77.5");
    EXPECT_EQ(makePipeline(byCost(-1))->deviceReport().m_crossover, 77.5);
    EXPECT_EQ(makePipeline(byCost(12))->deviceReport().m_crossover, 12);
    const ScopedVariable never("DRAPE_CROSSOVER", "inf");
    EXPECT_EQ(makePipeline(byCost(-1))->deviceReport().m_crossover, kInfinity);
    for (const char* wrong : {"-3", "many", "12 pairs", "nan"})
    {
        const ScopedVariable bad("DRAPE_CROSSOVER", wrong);
        Error error;
        EXPECT_FALSE(Pipeline::create(byCost(-1), error)) << wrong;
        EXPECT_NE(error.text().find(wrong), std::string::npos) << error.text();
    }
}

TEST_P(BackendMove, WhoAsksForABackEndGetsItUnmeasured)
{
    const TemporaryFolder folder;
    Settings opencl = GetParam().m_settings, host, named;
    host.m_backend = Backend::Host;
    named.m_device = listDevices()[0].m_name;
    for (Settings settings : {opencl, host, named})
    {
        settings.m_cacheFolder = folder.path();
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings);
        ASSERT_TRUE(pipeline);
        EXPECT_FALSE(pipeline->deviceReport().m_byCost);
        EXPECT_EQ(pipeline->deviceReport().m_onHost, settings.m_backend == Backend::Host);
    }
    EXPECT_TRUE(crossoverFiles(folder.path()).empty());
}

// The crossover is measured once for a cache folder; a damaged file is measured again.
TEST_P(BackendMove, TheCrossoverIsMeasuredOnce)
{
    const TemporaryFolder folder;
    Settings settings = byCost(-1);
    settings.m_cacheFolder = folder.path();
    const std::unique_ptr<Pipeline> first = makePipeline(settings), second = makePipeline(settings);
    ASSERT_TRUE(first && second);
    const DeviceReport& report = first->deviceReport();
    EXPECT_TRUE(isMeasuredNow(*first)) << report.m_reason;
    const bool isHost = std::isinf(report.m_crossover);
    EXPECT_EQ(report.m_reason.find("the host is faster than " + listDevices()[0].m_name) != std::string::npos, isHost)
        << report.m_reason;
    EXPECT_LT(first->deviceReport().m_measureMs, 20000);
    expectFromCache(*second, *first);
    const double measured = first->deviceReport().m_crossover, kept = second->deviceReport().m_crossover;
    if (!wasBusy(*first))
    {
        EXPECT_EQ(std::isinf(kept), std::isinf(measured));
        EXPECT_TRUE(std::isinf(measured) || std::fabs(kept - measured) < 1e-6 * measured);
    }
    ASSERT_EQ(crossoverFiles(folder.path()).size(), 1u);
    std::ofstream(crossoverFiles(folder.path())[0]) << "something else";
    const std::unique_ptr<Pipeline> third = makePipeline(settings), fourth = makePipeline(settings);
    EXPECT_TRUE(isMeasuredNow(*third));
    expectFromCache(*fourth, *third);
}

// Other processes use all of the cores meanwhile.
TEST_P(BackendMove, ABusyMachineIsMeasuredAgain)
{
    const TemporaryFolder folder;
    Settings settings = byCost(-1);
    settings.m_cacheFolder = folder.path();
    {
        const BusyProcesses others(2 * std::thread::hardware_concurrency());
        const std::unique_ptr<Pipeline> first = makePipeline(settings);
        ASSERT_TRUE(first);
        EXPECT_EQ(first->deviceReport().m_crossoverSource, "measured now, on a busy machine");
    }
    EXPECT_TRUE(isMeasuredNow(*makePipeline(settings)));
}

// A pipeline that has measured equals one that has not: ids begin at 0, and the ladder's steps leave no memory.
TEST_P(BackendMove, MeasuringLeavesNothingBehind)
{
    const TemporaryFolder folder;
    Settings settings = byCost(-1);
    settings.m_cacheFolder = folder.path();
    for (int start = 0; start < 2; ++start)
    {
        const std::unique_ptr<Pipeline> pipeline = makePipeline(settings), plain = makePipeline(byCost(kInfinity));
        ASSERT_TRUE(pipeline && plain);
        EXPECT_TRUE(start > 0 || isMeasuredNow(*pipeline));
        EXPECT_EQ(pipeline->statistics().m_candidates, 0u);
        LiveScene scene({pipeline.get(), plain.get()}, 1300);
        for (int step = 0; step < 20; ++step)
        {
            scene.nextStep();
            const std::vector<Contact> found = runStep(*pipeline), expected = runStep(*plain);
            ASSERT_TRUE(sameBytes(found, expected)) << difference(found, expected);
        }
    }
}

// Adds more meshes than the measurement had; they reuse its numbers.
TEST_P(BackendMove, MeshesThatComeAfterMeasuringHaveTreesOfTheirOwn)
{
    constexpr std::size_t kMeshes = 80, kTriangles = 30;
    const TemporaryFolder folder;
    Settings settings = byCost(-1);
    settings.m_cacheFolder = folder.path();
    const std::unique_ptr<Pipeline> measured = makePipeline(settings), plain = makePipeline(byCost(kInfinity));
    ASSERT_TRUE(measured && plain);
    EXPECT_TRUE(isMeasuredNow(*measured));
    const StepCase step = soupCase(600, int(kMeshes * kTriangles), false, 1310);
    SCOPED_TRACE(step.trace());
    std::vector<Contact> found[2];
    for (Pipeline* pipeline : {measured.get(), plain.get()})
    {
        std::vector<MeshId> obstacles;
        for (std::size_t i = 0; i < kMeshes; ++i)
        {
            TriangleMesh mesh;  // no corner of the soup is shared
            const auto first = step.m_obstacle.m_positions.begin() + std::ptrdiff_t(9 * kTriangles * i);
            mesh.m_positions.assign(first, first + 9 * kTriangles);
            for (std::size_t corner = 0; corner < 3 * kTriangles; ++corner)
                mesh.m_triangles.push_back(std::int32_t(corner));
            obstacles.push_back(addObstacle(*pipeline, mesh));
        }
        const MeshId cloth = addCloth(*pipeline, step.m_cloth);
        setMotion(*pipeline, cloth, step.m_cloth.m_positions, step.m_end);
        for (const MeshId obstacle : obstacles)
            pipeline->addPair(cloth, obstacle, step.m_thickness);
        found[pipeline == plain.get()] = runStep(*pipeline);
    }
    EXPECT_GT(found[1].size(), 100u);
    EXPECT_TRUE(sameBytes(found[0], found[1])) << difference(found[0], found[1]);
}

INSTANTIATE_TEST_SUITE_P(Device, BackendMove, testing::Values(openClBackends().front()), backendName);
}  // namespace drape::test
