#include "benchmarks/bench_step/measure_scene.h"

#include <algorithm>
#include <iostream>

#include "benchmarks/support/result_hash.h"
#include "benchmarks/support/samples.h"

namespace drape::bench
{
namespace
{
constexpr int kWarmUpSteps = 2;  // buffers have grown to what the scene needs then, and the first one built the trees
const std::string kNoHash = "none yet";

void addStages(MethodRun& run, const StepOutcome& outcome)
{
    for (const StageTime& stage : outcome.m_stages)
    {
        auto found = std::find_if(run.m_stages.begin(), run.m_stages.end(),
                                  [&](const auto& entry) { return entry.first == stage.m_name; });
        if (found == run.m_stages.end()) found = run.m_stages.insert(found, {stage.m_name, Samples()});
        found->second.add(stage.m_ms);
    }
}

// Combines the hashes of a period's steps into one hash.
std::string periodHash(const std::vector<std::string>& hashes)
{
    std::uint64_t hash = kEmptyHash;
    for (const std::string& step : hashes)
    {
        if (step.empty()) return "";
        hash = hashBytes(hash, step.data(), step.size());
    }
    return hashText(hash);
}

Row inputRow(const StepScene& scene)
{
    Row row;
    row["scene"] = scene.m_spec.m_name;
    row["sweep"] = scene.m_spec.m_sweep;
    row["model"] = scene.m_spec.m_model;
    row["cloths"] = scene.m_cloths.size();
    row["cloth_triangles"] = scene.m_spec.clothTriangles();
    row["obstacle_triangles"] = scene.m_obstacle.triangleCount();
    row["thickness_m"] = scene.m_thickness;
    return row;
}
}  // namespace

MethodRun runMethod(StepMethod& method, const StepScene& scene, const MeasureSettings& settings)
{
    MethodRun run;
    const int period = scene.period();
    std::vector<std::string> hashes(static_cast<std::size_t>(period), kNoHash);
    Clock::time_point begin;
    // Copies of the positions stand for an application's integrator, which has just written them. Frames unused for a
    // whole period would have to come from memory first.
    const std::size_t floats = scene.floats();
    std::vector<float> start, end;
    for (int step = 0; step < kWarmUpSteps + settings.m_repeats * period; ++step)
    {
        if (step == kWarmUpSteps) begin = Clock::now();
        if (step >= kWarmUpSteps + period && millisecondsSince(begin) > 1000 * settings.m_seconds) break;
        start.assign(scene.start(step), scene.start(step) + floats);
        end.assign(scene.end(step), scene.end(step) + floats);
        const StepOutcome outcome = method.step(start.data(), end.data());
        if (step == 0) run.m_firstMs = outcome.m_stages.front().m_ms;
        if (step >= kWarmUpSteps) addStages(run, outcome);
        std::string& hash = hashes[static_cast<std::size_t>(step % period)];
        if (hash != kNoHash)
        {
            if (hash != outcome.m_hash) run.m_hash = "changed in step " + std::to_string(step);
            continue;
        }
        hash = outcome.m_hash;
        run.m_candidates += static_cast<double>(outcome.m_candidates) / period;
        run.m_contacts += static_cast<double>(outcome.m_contacts) / period;
    }
    if (run.m_hash.empty()) run.m_hash = periodHash(hashes);
    method.describe(run.m_description);
    return run;
}

bool measureScene(const StepScene& scene, const std::vector<MethodEntry>& methods, const MeasureSettings& settings,
                  Table& table)
{
    std::string reference = settings.m_expected;
    bool good = true;
    for (const MethodEntry& entry : methods)
    {
        std::string error;
        const std::unique_ptr<StepMethod> method = entry.m_make(scene, error);
        if (!method)
        {
            std::cerr << "bench_step: " << scene.m_spec.m_name << ", " << entry.m_name << ": " << error << std::endl;
            good = false;
            continue;
        }
        const MethodRun run = runMethod(*method, scene, settings);
        if (reference.empty()) reference = run.m_hash;
        for (const auto& stage : run.m_stages)
        {
            Row row = inputRow(scene);
            row["method"] = entry.m_name;
            row.update(run.m_description);
            row["stage"] = stage.first;
            row["valid"] = "";  // stays so for methods that find candidates only
            row["hash"] = run.m_hash;
            row["steps"] = stage.second.count();
            stage.second.fill(row);
            row["first_ms"] = run.m_firstMs;
            row["candidates"] = run.m_candidates;
            row["contacts"] = run.m_contacts;
            if (!run.m_hash.empty()) judgeRow(row, reference);
            table.add(row);
        }
        for (Row& extra : method->extraRows())
        {
            Row row = inputRow(scene);
            row["method"] = entry.m_name;
            row.update(run.m_description);
            row.update(extra);
            table.add(row);
        }
    }
    return good;
}
}  // namespace drape::bench
