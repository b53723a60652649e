// Measures the step in which obstacles are added, removed and moved beside a large one that rests.
#include "study/programs/study.h"
#include "benchmarks/support/machine.h"
#include "benchmarks/support/result_hash.h"
#include "bullet_plugin/core/pipeline/pipeline.h"
#include "scenes/cloth_grid.h"
#include "scenes/describe_mesh.h"
#include "scenes/shapes.h"

namespace drape::bench
{
namespace
{
constexpr float kThickness = 0.02f;  // m
constexpr float kStride = 0.001f;    // m, of an obstacle that moves, a step
constexpr float kRadius = 0.2f;      // m, of those that come, go and move
constexpr float kHeight = 1.0f;      // m, of the cloth
constexpr int kWarmSteps = 3;

enum class Event
{
    Nothing,
    Comes,
    Goes,
    Moves
};

struct NamedEvent
{
    Event m_event;
    const char* m_name;
};
constexpr NamedEvent kEvents[] = {{Event::Nothing, "nothing happens"},
                                  {Event::Comes, "one comes"},
                                  {Event::Goes, "one goes"},
                                  {Event::Moves, "two move"}};

// A cloth of 512 triangles that rests at the height of the model's middle, and two spheres of 320 triangles just below
// it, added before the model and after it.
class ObstacleScene
{
public:
    ObstacleScene(std::unique_ptr<Pipeline> pipeline, const TriangleMesh& model)
        : m_pipeline(std::move(pipeline)),
          m_sphere(makeSphere(kRadius, 2)),
          m_first(m_pipeline->addObstacle(describeMesh(m_sphere))),
          m_model(m_pipeline->addObstacle(describeMesh(model))),
          m_last(m_pipeline->addObstacle(describeMesh(m_sphere))),
          m_cloth(m_pipeline->addCloth(describeMesh(makeClothGrid(17, 17, 2.0f, kHeight).m_mesh)))
    {
    }

    // ms of the step in which it happens, and of what the call takes that says so.
    double step(Event event)
    {
        const Clock::time_point begin = Clock::now();
        if (event == Event::Comes) m_visitor = m_pipeline->addObstacle(describeMesh(m_sphere));
        if (event == Event::Goes) m_pipeline->remove(m_visitor);
        if (event == Event::Goes) m_visitor = kNoMesh;
        if (event == Event::Moves) m_shift += kStride;
        place(m_first, m_shift - (event == Event::Moves ? kStride : 0));
        place(m_last, m_shift - (event == Event::Moves ? kStride : 0));
        for (const MeshId obstacle : {m_first, m_model, m_last, m_visitor})
            if (obstacle != kNoMesh) m_pipeline->addPair(m_cloth, obstacle, kThickness);
        m_pipeline->submit();
        m_contacts = m_pipeline->finish();
        return millisecondsSince(begin);
    }

    std::string hash() const { return hashText(hashOf(std::vector<Contact>(m_contacts.begin(), m_contacts.end()))); }
    std::size_t contacts() const { return m_contacts.size(); }
    const DeviceReport& device() const { return m_pipeline->deviceReport(); }
    bool failed() const { return m_pipeline->deviceFailed(); }

private:
    void place(MeshId obstacle, float before)
    {
        const float y = kHeight - kRadius - 0.5f * kThickness;
        const float start[12] = {1, 0, 0, before, 0, 1, 0, y, 0, 0, 1, 0};
        const float end[12] = {1, 0, 0, m_shift, 0, 1, 0, y, 0, 0, 1, 0};
        m_pipeline->placeObstacle(obstacle, start, end);
    }

    std::unique_ptr<Pipeline> m_pipeline;
    TriangleMesh m_sphere;
    MeshId m_first, m_model, m_last, m_cloth, m_visitor = kNoMesh;
    float m_shift = 0;
    ContactList m_contacts;
};

// Times and the last result of every event.
struct Times
{
    Samples m_samples[std::size(kEvents)];
    std::string m_hashes[std::size(kEvents)];
    std::size_t m_contacts[std::size(kEvents)] = {};
};

// Rounds in which each event has its step; those before them see memory grow.
Times measure(ObstacleScene& scene, const StudyOptions& options)
{
    for (int step = 0; step < kWarmSteps; ++step)
        for (const NamedEvent& named : kEvents)
            scene.step(named.m_event);
    Times times;
    const Clock::time_point begin = Clock::now();
    const int most = std::max(options.m_repeats, 20);
    for (int round = 0; round < most; ++round)
    {
        if (round >= int(kLeastRepeats) && millisecondsSince(begin) > 1000 * options.m_seconds) break;
        for (std::size_t i = 0; i < std::size(kEvents); ++i)
        {
            times.m_samples[i].add(scene.step(kEvents[i].m_event));
            if (round + 1 != int(kLeastRepeats)) continue;
            times.m_hashes[i] = scene.hash();
            times.m_contacts[i] = scene.contacts();
        }
    }
    return times;
}

void addRows(const std::string& model, std::size_t triangles, ObstacleScene& scene, const Times& times,
             const Times& reference, Table& table)
{
    for (std::size_t i = 0; i < std::size(kEvents); ++i)
    {
        Row row;
        row["part"] = "obstacles";
        row["model"] = model;
        row["triangles"] = triangles;
        row["variant"] = kEvents[i].m_name;
        row["backend"] = scene.device().m_onHost ? "host" : "opencl";
        fillDevice(row, scene.device().m_device);
        row["threads"] = scene.device().m_onHost ? 1 : 0;
        row["contacts"] = times.m_contacts[i];
        times.m_samples[i].fill(row);
        row["hash"] = scene.failed() ? "left the device" : times.m_hashes[i];
        judgeRow(row, reference.m_hashes[i]);
        table.add(row);
    }
}

void studyModel(const std::string& model, const TriangleMesh& mesh, const StudyOptions& options, Table& table)
{
    Settings host;
    host.m_backend = Backend::Host;
    Times reference;
    for (const Settings& settings : {host, options.settings()})
    {
        if (settings.m_backend == Backend::Host && !reference.m_hashes[0].empty()) continue;
        Error error;
        std::unique_ptr<Pipeline> pipeline = Pipeline::create(settings, error);
        if (!pipeline) throw std::runtime_error(error.text());
        ObstacleScene scene(std::move(pipeline), mesh);
        const Times times = measure(scene, options);
        if (reference.m_hashes[0].empty()) reference = times;
        addRows(model, mesh.triangleCount(), scene, times, reference, table);
    }
}
}  // namespace

void studyObstacles(const StudyOptions& options, Table& table)
{
    forEachModel(options,
                 [&](const std::string& model, const TriangleMesh& mesh) { studyModel(model, mesh, options, table); });
}
}  // namespace drape::bench
