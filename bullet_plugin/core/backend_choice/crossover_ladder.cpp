#include "crossover_ladder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "bullet_plugin/core/scene/topology.h"
#include "bullet_plugin/core/stopwatch.h"
#include "machine_load.h"
#include "scene_work.h"

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

class Rung
{
public:
    Rung(Pipeline& pipeline, int cells, int fineness, float activation)
        : m_pipeline(pipeline),
          m_clothSheet(makeSheet(cells, cells * kCell, kGap)),
          m_obstacleSheet(makeSheet(sheetCells(cells, fineness), sheetCells(cells, fineness) * kCell / fineness, 0)),
          m_cloth(pipeline.addCloth(m_clothSheet.describe())),
          m_obstacle(pipeline.addObstacle(m_obstacleSheet.describe())),
          m_expectedPairs(expectedPairs(surfaceOf(m_clothSheet), surfaceOf(m_obstacleSheet),
                                        double(kThickness) * (1 + double(activation))))
    {
    }
    ~Rung()
    {
        m_pipeline.remove(m_cloth);
        m_pipeline.remove(m_obstacle);
    }
    Rung(const Rung&) = delete;
    Rung& operator=(const Rung&) = delete;

    double expected() const { return m_expectedPairs; }

    // ms, host to host.
    double run(int step, std::vector<Contact>& contacts)
    {
        placeCloth(m_clothSheet, step, m_pipeline.clothStart(m_cloth));
        placeCloth(m_clothSheet, step + 1, m_pipeline.clothEnd(m_cloth));
        m_pipeline.addPair(m_cloth, m_obstacle, kThickness);
        Stopwatch watch;
        m_pipeline.submit();
        const ContactList found = m_pipeline.finish();
        const double ms = watch.lapMs();
        contacts.assign(found.begin(), found.end());
        return ms;
    }

    // spread: gets the logarithm of the ratio of the median to the shortest step.
    double leastMs(std::vector<double>& spread)
    {
        std::vector<Contact> contacts;
        std::vector<double> times;
        double sum = 0;
        for (int step = 0; step < kWarmUpSteps; ++step)
            run(step, contacts);
        for (int i = 0; i < kMostSteps && (i < kFewestSteps || sum < kStepsMs); ++i)
        {
            const double ms = run(kWarmUpSteps + i, contacts);
            times.push_back(ms);
            sum += ms;
        }
        std::sort(times.begin(), times.end());
        spread.push_back(std::log(times[times.size() / 2] / times[0]));
        return times[0];
    }

private:
    static int sheetCells(int cells, int fineness) { return (cells + int(std::ceil(2 * kMargin / kCell))) * fineness; }
    static Surface surfaceOf(const Sheet& sheet)
    {
        const Topology topology =
            buildTopology(sheet.m_triangles.data(), sheet.m_triangles.size() / 3, sheet.m_positions.size() / 3);
        return {topology.m_triangles.size(), surfaceArea(topology.m_triangles, sheet.m_positions.data())};
    }

    Pipeline& m_pipeline;
    Sheet m_clothSheet, m_obstacleSheet;
    MeshId m_cloth, m_obstacle;
    double m_expectedPairs;
};

// Returns null, or why the device cannot be measured.
const char* measureRung(Pipeline& pipeline, Rung& scene, const std::function<void(bool)>& use, CrossoverRung& rung,
                        std::vector<double>& spread)
{
    std::vector<Contact> host, device;
    rung.m_pairs = scene.expected();
    use(true);
    rung.m_hostMs = scene.leastMs(spread);
    scene.run(0, host);
    use(false);
    rung.m_deviceMs = scene.leastMs(spread);
    scene.run(0, device);
    const std::uint32_t status = pipeline.statistics().m_status;
    if (status & kStepDeviceFailed) return "it failed";
    if (status & kStepDeviceFull) return "it cannot hold the lists of a step";
    const bool same = host.size() == device.size() &&
                      (host.empty() || std::memcmp(host.data(), device.data(), host.size() * sizeof(Contact)) == 0);
    return same ? nullptr : "its contacts differ from the host's";
}
}  // namespace

const char* measureLadder(Pipeline& pipeline, float activation, const std::function<void(bool onHost)>& use,
                          std::vector<CrossoverRung>& rungs, bool& busy)
{
    const MachineLoad load;
    std::vector<double> spread;
    for (const int fineness : kFineness)
    {
        int ahead = 0;
        for (const int cells : kClothCells)
        {
            Rung scene(pipeline, cells, fineness, activation);
            CrossoverRung rung;
            if (const char* const why = measureRung(pipeline, scene, use, rung, spread)) return why;
            rungs.push_back(rung);
            ahead = rung.m_hostMs > kAhead * rung.m_deviceMs ? ahead + 1 : 0;
            if (ahead == 2 || rung.m_hostMs > kLongestStepMs) break;
        }
    }
    const double sum = std::accumulate(spread.begin(), spread.end(), 0.0);
    busy = sum > std::log(kMostSpread) * double(spread.size()) || load.isBusy(pipeline.threads()->size());
    return nullptr;
}
}  // namespace drape
