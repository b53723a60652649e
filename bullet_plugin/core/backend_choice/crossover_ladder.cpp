#include "crossover_ladder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "bullet_plugin/core/backends/device_backend.h"
#include "bullet_plugin/core/backends/host_backend.h"
#include "bullet_plugin/core/backends/step_input.h"
#include "bullet_plugin/core/stopwatch.h"
#include "expected_pairs.h"
#include "machine_load.h"

namespace drape
{
namespace
{
constexpr double kPi = 3.14159265358979323846;

// m. Cells and thickness of a cloth of 2,048 triangles and 2.4 m that hangs over an obstacle of 2 m.
constexpr double kCell = 0.075;
constexpr float kThickness = 0.02f;
constexpr double kGap = 0.75 * kThickness;  // vertical
constexpr double kMargin = 0.1;             // margin of the sheet around the cloth

constexpr int kClothCells[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96};  // along a side
constexpr int kFineness[] = {1, 4};                                            // cells of the sheet in one of the cloth

constexpr int kWarmUpSteps = 2;  // build trees and grow buffers
constexpr int kFewestSteps = 5, kMostSteps = 15;
constexpr double kStepsMs = 10;       // for the steps of one rung on one back end, if more than the fewest
constexpr double kLongestStepMs = 5;  // on the host; after a longer one the ladder ends
// Maximum ratio of the median to the shortest time of a scene's steps, averaged over all scenes. Beyond it half of
// the steps were disturbed, and possibly the shortest.
constexpr double kMostSpread = 1.6;
constexpr double kAhead = 2;  // ratio of times; the ladder ends after two rungs with a higher one

struct Sheet
{
    std::vector<std::int32_t> m_triangles;
    std::vector<float> m_positions;

    MeshDescription describe() const
    {
        MeshDescription mesh;
        mesh.m_triangles = m_triangles.data();
        mesh.m_triangleCount = m_triangles.size() / 3;
        mesh.m_positions = m_positions.data();
        mesh.m_vertexCount = m_positions.size() / 3;
        return mesh;
    }
};

// A square of cells × cells, each two triangles, over waves of 0.1 m.
Sheet makeSheet(int cells, double side, double above)
{
    Sheet sheet;
    const int nodes = cells + 1;
    for (int i = 0; i < nodes; ++i)
    {
        for (int j = 0; j < nodes; ++j)
        {
            const double x = side * (double(i) / cells - 0.5), z = side * (double(j) / cells - 0.5);
            for (double value : {x, 0.1 * std::sin(2 * kPi * x) * std::cos(2 * kPi * z) + above, z})
                sheet.m_positions.push_back(float(value));
            if (i == cells || j == cells) continue;
            const std::int32_t a = i * nodes + j, b = a + 1, c = a + nodes, d = c + 1;
            sheet.m_triangles.insert(sheet.m_triangles.end(), {a, b, c, c, b, d});
        }
    }
    return sheet;
}

// Places the cloth at a step's start. It sways by at most 3 mm a step, and no step equals the one before.
void placeCloth(const Sheet& cloth, int step, float* out)
{
    const double phase = 0.6 * step;
    const float x = float(0.004 * std::sin(phase)), y = float(0.002 * std::sin(1.3 * phase));
    for (std::size_t i = 0; i < cloth.m_positions.size(); i += 3)
    {
        out[i] = cloth.m_positions[i] + x;
        out[i + 1] = cloth.m_positions[i + 1] + y;
        out[i + 2] = cloth.m_positions[i + 2];
    }
}

constexpr const char* kFailed = "it failed";
constexpr const char* kFull = "it cannot hold the lists of a step";
constexpr const char* kDiffers = "its contacts differ from the host's";

// The scene of one rung at a time, in memory that the device can copy fast.
class Ladder
{
public:
    explicit Ladder(const LadderBackends& backends) : m_backends(backends) {}

    // Returns null, or why the device cannot be measured. spread: gets two values, see leastMs().
    const char* measure(int cells, int fineness, CrossoverRung& rung, std::vector<double>& spread)
    {
        const int sheetCells = (cells + int(std::ceil(2 * kMargin / kCell))) * fineness;
        m_sheet = makeSheet(cells, cells * kCell, kGap);
        m_cloth = m_scene.addCloth(m_sheet.describe());
        m_obstacle = m_scene.addObstacle(makeSheet(sheetCells, sheetCells * kCell / fineness, 0).describe());
        rung.m_pairs = expectedPairs(surfaceOf(m_scene.m_cloths.existing(m_cloth)),
                                     surfaceOf(m_scene.m_obstacles.existing(m_obstacle)),
                                     double(kThickness) * (1 + double(m_backends.m_settings.m_activation)));
        m_scene.join(&m_backends.m_device.device());
        rung.m_hostMs = leastMs(true, spread);
        runStep(true, 0);
        const std::vector<Contact> onHost = contacts();
        rung.m_deviceMs = leastMs(false, spread);
        runStep(false, 0);
        const std::vector<Contact> onDevice = contacts();
        m_scene.remove(m_cloth);
        m_scene.remove(m_obstacle);
        if (m_why) return m_why;
        const bool same =
            onHost.size() == onDevice.size() &&
            (onHost.empty() || std::memcmp(onHost.data(), onDevice.data(), onHost.size() * sizeof(Contact)) == 0);
        return same ? nullptr : kDiffers;
    }

private:
    static Surface surfaceOf(const PooledMesh& mesh) { return {mesh.m_topology.m_triangles.size(), mesh.m_area}; }

    // Returns the step's time, host to host, ms.
    double runStep(bool onHost, int step)
    {
        const std::size_t first = 3 * std::size_t(m_scene.m_cloths.existing(m_cloth).m_firstVertex);
        placeCloth(m_sheet, step, m_scene.m_clothNodes.start() + first);
        placeCloth(m_sheet, step + 1, m_scene.m_clothNodes.end() + first);
        m_input.addPair({m_cloth, m_obstacle, kThickness});
        StepStatistics statistics;
        Stopwatch watch;
        m_input.collect(m_scene, m_backends.m_settings.m_activation, m_pairs, statistics);
        if (onHost)
        {
            m_backends.m_host.run(m_scene, m_pairs, m_result, statistics);
        }
        else
        {
            m_backends.m_device.submit(m_scene, m_pairs);
            if (!m_backends.m_device.finish(m_scene, m_pairs, m_result, statistics))
                m_why = m_backends.m_device.device().failed() ? kFailed : kFull;
        }
        return watch.lapMs();
    }

    // spread: gets the logarithm of the ratio of the median to the shortest step.
    double leastMs(bool onHost, std::vector<double>& spread)
    {
        std::vector<double> times;
        double sum = 0;
        for (int step = 0; step < kWarmUpSteps; ++step)
            runStep(onHost, step);
        for (int i = 0; i < kMostSteps && (i < kFewestSteps || sum < kStepsMs); ++i)
        {
            times.push_back(runStep(onHost, kWarmUpSteps + i));
            sum += times.back();
        }
        std::sort(times.begin(), times.end());
        spread.push_back(std::log(times[times.size() / 2] / times[0]));
        return times[0];
    }

    std::vector<Contact> contacts() const
    {
        const ContactList found = m_result.contacts();
        return {found.begin(), found.end()};
    }

    const LadderBackends m_backends;
    Scene m_scene;
    StepInput m_input;
    StepPairs m_pairs;
    StepResult m_result;
    Sheet m_sheet;
    MeshId m_cloth = kNoMesh, m_obstacle = kNoMesh;
    const char* m_why = nullptr;  // the device failed a step
};
}  // namespace

const char* measureLadder(const LadderBackends& backends, std::vector<CrossoverRung>& rungs, bool& busy)
{
    const MachineLoad load;
    Ladder ladder(backends);
    const WaitAtEnd wait(backends.m_device.device());  // it reads the ladder's memory
    std::vector<double> spread;
    for (const int fineness : kFineness)
    {
        int ahead = 0;
        for (const int cells : kClothCells)
        {
            CrossoverRung rung;
            if (const char* const why = ladder.measure(cells, fineness, rung, spread)) return why;
            rungs.push_back(rung);
            ahead = rung.m_hostMs > kAhead * rung.m_deviceMs ? ahead + 1 : 0;
            if (ahead == 2 || rung.m_hostMs > kLongestStepMs) break;
        }
    }
    const double sum = std::accumulate(spread.begin(), spread.end(), 0.0);
    busy = sum > std::log(kMostSpread) * double(spread.size()) || load.isBusy(backends.m_threads);
    return nullptr;
}
}  // namespace drape
