#include "study/programs/tree_method.h"

#include <map>

#include "benchmarks/support/machine.h"
#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/samples.h"
#include "bullet_plugin/core/device/device_choice.h"
#include "bullet_plugin/core/device/profiler.h"
#include "study/step/tree_step.h"

namespace drape::bench
{
namespace
{
std::string stageOfKernel(const std::string& kernel)
{
    const std::pair<const char*, const char*> stages[] = {
        {"refit", "refit"}, {"narrowPhase", "narrow"}, {"ordering", "order"}};
    for (const auto& stage : stages)
    {
        if (kernel.rfind(stage.first, 0) == 0) return stage.second;
    }
    return "broad";
}

class TreeMethod : public StepMethod
{
public:
    TreeMethod(const StepScene& scene, const Settings& settings, const Methods& methods, std::unique_ptr<Device> device)
        : m_scene(scene.m_cloths, scene.m_obstacle, methods.m_tree, scene.m_thickness, 1.0f + settings.m_activation),
          m_device(std::move(device))
    {
        if (m_device)
            m_step = std::make_unique<DeviceTreeStep>(*m_device, m_scene, methods, settings.m_cacheFolder);
        else
            m_step = std::make_unique<HostTreeStep>(m_scene, methods.m_traversal);
    }

    StepOutcome step(const float* start, const float* end) override
    {
        StepOutcome outcome;
        TreeStepResult result;
        const Clock::time_point begin = Clock::now();
        const bool done = m_step->run(start, end, result);
        outcome.m_stages.push_back({"step", millisecondsSince(begin)});
        addStages(result, outcome);
        outcome.m_candidates = result.m_candidates;
        outcome.m_contacts = result.m_contacts.size();
        outcome.m_volumeTests = result.m_volumeTests;
        outcome.m_hash = done ? hashText(hashOf(result.m_contacts)) : "left the device";
        return outcome;
    }

    void describe(Row& row) const override
    {
        row["backend"] = m_device ? "opencl" : "host";
        if (m_device)
            fillDevice(row, m_device->info());
        else
            row["device"] = "host";
        row["threads"] = m_device ? 0 : 1;
    }

    std::vector<Row> extraRows() const override
    {
        std::vector<Row> rows;
        if (!m_device || m_device->profiler()) return rows;
        for (const MemoryUse& use : m_device->memory().list())
            rows.push_back({{"stage", "memory: " + use.m_name}, {"bytes", use.m_bytes}});
        return rows;
    }

private:
    void addStages(const TreeStepResult& result, StepOutcome& outcome)
    {
        if (!m_device)
        {
            outcome.m_stages.push_back({"refit", result.m_refitMs});
            outcome.m_stages.push_back({"broad", result.m_broadMs});
            outcome.m_stages.push_back({"narrow", result.m_narrowMs});
            return;
        }
        if (!m_device->profiler()) return;
        std::map<std::string, double> kernels;
        for (const KernelTime& launch : m_device->profiler()->take())
        {
            kernels[stageOfKernel(launch.m_kernel)] += launch.m_ms;
            kernels["kernels"] += launch.m_ms;
        }
        for (const auto& kernel : kernels)
            outcome.m_stages.push_back({kernel.first, kernel.second});
    }

    TreeScene m_scene;
    std::unique_ptr<Device> m_device;
    std::unique_ptr<TreeStep> m_step;
};
}  // namespace

std::unique_ptr<StepMethod> makeTreeMethod(const StepScene& scene, const Settings& settings, const Methods& methods,
                                           std::string& error)
{
    Error problem;
    const DeviceChoice choice = chooseDevice(settings, problem);
    std::unique_ptr<Device> device;
    if (!problem.failed() && !choice.m_onHost)
        device = Device::open(choice.m_index, problem, settings.m_profileKernels);
    std::unique_ptr<StepMethod> method;
    if (!problem.failed())
    {
        Device* const opened = device.get();
        method = std::make_unique<TreeMethod>(scene, settings, methods, std::move(device));
        if (opened && opened->failed()) problem = opened->error();
    }
    if (!problem.failed()) return method;
    error = problem.text();
    return nullptr;
}
}  // namespace drape::bench
