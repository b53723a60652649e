// A cloth comes down on an obstacle, a step at a time, so that overlaps grow from none to those at rest; there it
// sways.
#include <algorithm>
#include <map>
#include <stdexcept>

#include "benchmarks/study/study.h"
#include "benchmarks/support/step_method.h"

namespace drape::bench
{
namespace
{
struct Variant
{
    std::string m_name;
    Settings m_settings;
};

// The host's default is the reference, so it is first.
std::vector<Variant> variants(const StudyOptions& options)
{
    std::vector<Variant> all;
    const auto add = [&all](const std::string& name, Settings settings, Traversal traversal)
    {
        settings.m_methods.m_traversal = traversal;
        all.push_back({name, settings});
    };
    Settings host, device = options.settings();
    host.m_backend = Backend::Host;
    device.m_profileKernels = true;
    add("host, thesis: front", host, Traversal::Front);
    add("host, eight wide", host, Traversal::WideLeaves);
    add("host, thesis: simple", host, Traversal::Single);
    add("host, as front, from the roots", host, Traversal::Groups);
    if (options.m_backend == "host") return all;
    add("default", device, Traversal::Auto);
    add("thesis: simple", device, Traversal::Single);
    add("thesis: front", device, Traversal::Front);
    add("as front, from fixed pairs", device, Traversal::Groups);
    add("pairs of subtrees", device, Traversal::Pairs);
    add("leaves", device, Traversal::Leaves);
    add("leaves, eight wide", device, Traversal::WideLeaves);
    add("groups, eight wide", device, Traversal::WideGroups);
    return all;
}

// The scene's cloths from above: each step comes down by `kFall` thicknesses, the last one ends at rest. Then they sway
// as in the scene, so that hardly anything changes from step to step.
constexpr float kFall = 0.15f;  // 3 mm at 20 mm, as fast as the motion of the scenes

void descend(StepScene& scene, int descent, int sway)
{
    const std::vector<std::vector<float>> motion = scene.m_frames;
    scene.m_frames.assign(static_cast<std::size_t>(descent), motion.front());
    for (int step = 0; step < descent; ++step)
    {
        std::vector<float>& frame = scene.m_frames[static_cast<std::size_t>(step)];
        for (std::size_t i = 1; i < frame.size(); i += 3)
            frame[i] += kFall * scene.m_thickness * static_cast<float>(descent - step);
    }
    for (std::size_t step = 0; step <= static_cast<std::size_t>(sway); ++step)
        scene.m_frames.push_back(motion[step % motion.size()]);
}

// One variant over the descent: times by step and stage over the passes, and the last outcome of each step.
struct Descent
{
    std::vector<std::map<std::string, Samples>> m_times;
    std::vector<StepOutcome> m_outcomes;
};

// Between passes the cloth hangs at the top for a while: a front climbs in every eighth step only, and would carry what
// it has at rest into the next descent.
constexpr int kSettlingSteps = 8;

Descent run(StepMethod& method, const StepScene& scene, int passes, double seconds)
{
    const std::size_t steps = scene.m_frames.size() - 1;
    const float* top = scene.m_frames.front().data();
    Descent descent;
    descent.m_times.resize(steps);
    descent.m_outcomes.resize(steps);
    const Clock::time_point begin = Clock::now();
    // The first pass lets buffers grow.
    for (int pass = 0; pass <= passes; ++pass)
    {
        if (pass > 1 && millisecondsSince(begin) > 1000 * seconds) break;
        for (int step = 0; step < kSettlingSteps; ++step)
            method.step(top, top);
        for (std::size_t step = 0; step < steps; ++step)
        {
            const StepOutcome outcome = method.step(scene.m_frames[step].data(), scene.m_frames[step + 1].data());
            std::string& hash = descent.m_outcomes[step].m_hash;
            const bool changed = pass > 0 && hash != outcome.m_hash;
            descent.m_outcomes[step] = outcome;
            if (changed) hash = "changed in pass " + std::to_string(pass);
            if (pass == 0) continue;
            for (const StageTime& stage : outcome.m_stages)
                descent.m_times[step][stage.m_name].add(stage.m_ms);
        }
    }
    return descent;
}

// Volume tests of each step. A device's are counted in a run of their own, since that costs an atomic a work-item; the
// host counts anyway. 0 where the variant cannot count.
void countTests(const StepScene& scene, Variant variant, Descent& descent)
{
    if (variant.m_settings.m_backend == Backend::Host) return;
    std::string error;
    variant.m_settings.m_methods.m_countTests = true;
    const std::unique_ptr<StepMethod> method = makeDrapeMethod(scene, variant.m_settings, error);
    if (!method) throw std::runtime_error(error);
    const Descent counted = run(*method, scene, 1, 0);
    for (std::size_t step = 0; step < descent.m_outcomes.size(); ++step)
        descent.m_outcomes[step].m_volumeTests = counted.m_outcomes[step].m_volumeTests;
}

void addRows(const StepScene& scene, const Variant& variant, const StepMethod& method, const Descent& descent,
             const Descent& reference, int descentSteps, Table& table)
{
    for (std::size_t step = 0; step < descent.m_times.size(); ++step)
    {
        const StepOutcome& outcome = descent.m_outcomes[step];
        Row row;
        row["part"] = "traversal";
        row["model"] = scene.m_spec.m_name;
        row["cloth_triangles"] = scene.m_spec.clothTriangles();
        row["triangles"] = scene.m_obstacle.triangleCount();
        row["variant"] = variant.m_name;
        method.describe(row);
        row["step"] = step;
        row["phase"] = step < static_cast<std::size_t>(descentSteps) ? "descent" : "rest";
        row["candidates"] = outcome.m_candidates;
        row["contacts"] = outcome.m_contacts;
        if (outcome.m_volumeTests > 0) row["volume_tests"] = outcome.m_volumeTests;
        for (const char* stage : {"step", "refit", "broad", "narrow", "order"})
        {
            const auto found = descent.m_times[step].find(stage);
            if (found != descent.m_times[step].end()) row[std::string(stage) + "_ms"] = found->second.median();
        }
        row["hash"] = outcome.m_hash;
        judgeRow(row, reference.m_outcomes[step].m_hash);
        table.add(row);
    }
}
}  // namespace

void studyTraversals(const StudyOptions& options, Table& table)
{
    const int steps = options.m_quick ? 6 : 40, sway = options.m_quick ? 4 : 24;
    for (const SceneSpec& spec : studyScenes(options))
    {
        TriangleMesh obstacle;
        if (!loadModel(spec.m_model, options, obstacle)) continue;
        StepScene scene = makeStepScene(spec, obstacle);
        descend(scene, steps, sway);
        Descent reference;
        for (const Variant& variant : variants(options))
        {
            if (options.tooLate(spec.m_name + ", " + variant.m_name)) continue;
            std::string error;
            const std::unique_ptr<StepMethod> method = makeDrapeMethod(scene, variant.m_settings, error);
            if (!method) throw std::runtime_error(error);
            Descent descent = run(*method, scene, options.m_repeats, options.m_seconds);
            countTests(scene, variant, descent);
            if (reference.m_outcomes.empty()) reference = descent;
            addRows(scene, variant, *method, descent, reference, steps, table);
        }
    }
}
}  // namespace drape::bench
