// Runs Drape's pipeline as a caller does.
#include <algorithm>
#include <map>

#include "benchmarks/support/step_method.h"
#include "benchmarks/support/machine.h"
#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/samples.h"
#include "scenes/describe_mesh.h"

namespace drape::bench
{
namespace
{
// Kernels are called stageAction; those of the broad phase have many names.
std::string stageOfKernel(const std::string& kernel)
{
    const std::pair<const char*, const char*> stages[] = {
        {"self", "self"}, {"narrowPhase", "narrow"}, {"ordering", "order"}};
    for (const auto& stage : stages)
    {
        if (kernel.rfind(stage.first, 0) == 0) return stage.second;
    }
    return "broad";
}

class DrapeMethod : public StepMethod
{
public:
    DrapeMethod(std::unique_ptr<Pipeline> pipeline, const StepScene& scene, bool profiled)
        : m_pipeline(std::move(pipeline)), m_scene(scene), m_profiled(profiled)
    {
        const Clock::time_point start = Clock::now();
        m_obstacle = m_pipeline->addObstacle(describeMesh(scene.m_obstacle));
        addCloths();
        m_prepareMs = millisecondsSince(start);
    }

    StepOutcome step(const float* start, const float* end) override
    {
        StepOutcome outcome;
        const Clock::time_point begin = Clock::now();
        m_pipeline->copyNodes(m_cloths, start, end);
        for (const MeshId cloth : m_cloths)
        {
            m_pipeline->addPair(cloth, m_obstacle, m_scene.m_thickness);
            if (collidesWithItself()) m_pipeline->addSelf(cloth);
        }
        m_pipeline->submit();
        const ContactList contacts = m_pipeline->finish();
        outcome.m_stages.push_back({"step", millisecondsSince(begin)});
        const StepStatistics& statistics = m_pipeline->statistics();
        addStages(statistics, outcome);
        const ContactList self = m_pipeline->selfContacts();
        outcome.m_candidates = statistics.m_candidates + statistics.m_selfCandidates;
        outcome.m_contacts = contacts.size() + self.size();
        std::uint64_t hash = hashOf(std::vector<Contact>(contacts.begin(), contacts.end()));
        if (collidesWithItself()) hash = hashOf(std::vector<Contact>(self.begin(), self.end()), hash);
        outcome.m_hash = hashText(hash);
        // A step that left its device is no measurement of the device.
        if (statistics.m_status & (kStepDeviceFailed | kStepDeviceFull)) outcome.m_hash = "left the device";
        return outcome;
    }

    void describe(Row& row) const override
    {
        const DeviceReport& report = m_pipeline->deviceReport();
        row["backend"] = report.m_onHost ? "host" : "opencl";
        fillDevice(row, report.m_device);
        row["threads"] = report.m_onHost ? m_pipeline->threads()->size() : 0;
        row["prepare_ms"] = m_prepareMs;
        row["kernels_ms"] = report.m_buildMs;
    }

    std::vector<Row> extraRows() const override
    {
        std::vector<Row> rows;
        if (m_profiled) return rows;  // equal to the rows without profiling
        for (const MemoryUse& use : m_pipeline->deviceMemory())
            rows.push_back({{"stage", "memory: " + use.m_name}, {"bytes", use.m_bytes}});
        return rows;
    }

private:
    bool collidesWithItself() const { return m_scene.m_selfThickness > 0; }

    void addCloths()
    {
        m_cloths.clear();
        for (const TriangleMesh& cloth : m_scene.m_cloths)
        {
            MeshDescription description = describeMesh(cloth);
            description.m_selfThickness = m_scene.m_selfThickness;
            m_cloths.push_back(m_pipeline->addCloth(description));
        }
    }

    void addStages(const StepStatistics& statistics, StepOutcome& outcome)
    {
        if (m_pipeline->deviceReport().m_onHost)
        {
            outcome.m_stages.push_back({"refit", statistics.m_refitMs});
            outcome.m_stages.push_back({"broad", statistics.m_broadMs});
            outcome.m_stages.push_back({"narrow", statistics.m_narrowMs});
            return;
        }
        outcome.m_stages.push_back({"submit", statistics.m_uploadMs});
        outcome.m_stages.push_back({"wait", statistics.m_waitMs});
        // Adds the times of each kernel, of each stage's kernels, and of all.
        std::map<std::string, double> kernels;
        for (const KernelTime& launch : m_pipeline->takeKernelTimes())
        {
            kernels["kernel: " + launch.m_kernel] += launch.m_ms;
            kernels[stageOfKernel(launch.m_kernel)] += launch.m_ms;
            kernels["kernels"] += launch.m_ms;
        }
        for (const auto& kernel : kernels)
            outcome.m_stages.push_back({kernel.first, kernel.second});
    }

    std::unique_ptr<Pipeline> m_pipeline;
    const StepScene& m_scene;
    MeshId m_obstacle = kNoMesh;
    std::vector<MeshId> m_cloths;
    double m_prepareMs = 0;
    bool m_profiled;
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
    return std::make_unique<DrapeMethod>(std::move(pipeline), scene, settings.m_profileKernels);
}

float contactReach(const StepScene& scene)
{
    // A thousandth beyond the reach of the feature tests, like the pipeline, allows for the rounding of both.
    return scene.m_thickness * (1.0f + Settings().m_activation) * 1.001f;
}

float selfReach(const StepScene& scene)
{
    return scene.m_selfThickness * (1.0f + Settings().m_activation) * 1.001f;
}
}  // namespace drape::bench
