// Drape's pipeline as a caller sees it.
#include <algorithm>

#include "benchmarks/bench_step/step_method.h"
#include "benchmarks/support/machine.h"
#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/samples.h"
#include "scenes/describe_mesh.h"

namespace drape::bench
{
namespace
{
class DrapeMethod : public StepMethod
{
public:
    DrapeMethod(std::unique_ptr<Pipeline> pipeline, const StepScene& scene)
        : m_pipeline(std::move(pipeline)), m_thickness(scene.m_thickness)
    {
        const Clock::time_point start = Clock::now();
        m_obstacle = m_pipeline->addObstacle(describeMesh(scene.m_obstacle));
        for (const TriangleMesh& cloth : scene.m_cloths)
        {
            m_cloths.push_back(m_pipeline->addCloth(describeMesh(cloth)));
            m_floats.push_back(cloth.m_positions.size());
        }
        m_prepareMs = millisecondsSince(start);
    }

    StepOutcome step(const float* start, const float* end) override
    {
        StepOutcome outcome;
        const Clock::time_point begin = Clock::now();
        std::size_t first = 0;
        for (std::size_t i = 0; i < m_cloths.size(); ++i)
        {
            std::copy(start + first, start + first + m_floats[i], m_pipeline->clothStart(m_cloths[i]));
            std::copy(end + first, end + first + m_floats[i], m_pipeline->clothEnd(m_cloths[i]));
            m_pipeline->addPair(m_cloths[i], m_obstacle, m_thickness);
            first += m_floats[i];
        }
        m_pipeline->submit();
        const std::vector<Contact>& contacts = m_pipeline->finish();
        outcome.m_stages.push_back({"step", millisecondsSince(begin)});
        const StepStatistics& statistics = m_pipeline->statistics();
        outcome.m_stages.push_back({"submit", statistics.m_uploadMs});
        outcome.m_stages.push_back({"wait", statistics.m_waitMs});
        outcome.m_candidates = statistics.m_candidates;
        outcome.m_contacts = contacts.size();
        outcome.m_hash = hashText(hashOf(contacts));
        // A step that left its device is no measurement of it.
        if (statistics.m_status & (kStepDeviceFailed | kStepContactLimit)) outcome.m_hash = "left the device";
        return outcome;
    }

    void describe(Row& row) const override
    {
        const DeviceReport& report = m_pipeline->deviceReport();
        row["backend"] = report.m_onHost ? "host" : "opencl";
        fillDevice(row, report.m_device);
        row["threads"] = report.m_onHost ? 1 : 0;
        row["prepare_ms"] = m_prepareMs;
        row["kernels_ms"] = report.m_buildMs;
    }

private:
    std::unique_ptr<Pipeline> m_pipeline;
    MeshId m_obstacle = kNoMesh;
    std::vector<MeshId> m_cloths;
    std::vector<std::size_t> m_floats;
    float m_thickness;
    double m_prepareMs = 0;
};
}  // namespace

std::unique_ptr<StepMethod> makeDrapeMethod(const StepScene& scene, const Settings& settings, std::string& error)
{
    Error problem;
    std::unique_ptr<Pipeline> pipeline = Pipeline::create(settings, problem);
    if (!pipeline)
    {
        error = problem.text();
        return nullptr;
    }
    return std::make_unique<DrapeMethod>(std::move(pipeline), scene);
}

float contactReach(const StepScene& scene)
{
    // A thousandth more than the feature tests look, as the pipeline takes it, for the rounding of both.
    return scene.m_thickness * (1.0f + Settings().m_activation) * 1.001f;
}
}  // namespace drape::bench
