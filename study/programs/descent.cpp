#include "study/programs/descent.h"

#include <algorithm>
#include <stdexcept>

namespace drape::bench
{
namespace
{
// Each step of the descent comes down by so many thicknesses, the last one ends at rest.
constexpr float kFall = 0.15f;  // 3 mm at 20 mm, as fast as the motion of the scenes

// Between passes the cloth hangs at the top for a while: a front climbs in every eighth step only, and would carry what
// it has at rest into the next descent.
constexpr int kSettlingSteps = 8;
}  // namespace

std::unique_ptr<StepMethod> makeMethod(const StepScene& scene, const StepVariant& variant)
{
    std::string error;
    const Settings& settings = variant.m_settings;
    std::unique_ptr<StepMethod> method = variant.m_methods ? makeTreeMethod(scene, settings, *variant.m_methods, error)
                                                           : makeDrapeMethod(scene, settings, error);
    if (!method) throw std::runtime_error(error);
    return method;
}

// The scene's cloths from above; then they sway as in the scene, so that hardly anything changes from step to step.
DescentScene::DescentScene(const SceneSpec& spec, const TriangleMesh& obstacle, bool quick)
    : m_scene(makeStepScene(spec, obstacle)), m_descent(quick ? 6 : 40)
{
    const std::size_t sway = quick ? 4 : 24;
    const std::vector<std::vector<float>> motion = m_scene.m_frames;
    m_scene.m_frames.assign(m_descent, motion.front());
    for (std::size_t step = 0; step < m_descent; ++step)
    {
        std::vector<float>& frame = m_scene.m_frames[step];
        for (std::size_t i = 1; i < frame.size(); i += 3)
            frame[i] += kFall * m_scene.m_thickness * static_cast<float>(m_descent - step);
    }
    for (std::size_t step = 0; step <= sway; ++step)
        m_scene.m_frames.push_back(motion[step % motion.size()]);
}

DescentRun::DescentRun(const DescentScene& scene, const StepVariant& variant)
    : m_scene(scene), m_variant(variant), m_method(makeMethod(scene.m_scene, variant))
{
    m_times.resize(scene.stepCount());
}

void DescentRun::warmUp()
{
    const float* rest = m_scene.m_scene.m_frames.back().data();
    for (int step = 0; step < kSettlingSteps; ++step)
        m_method->step(rest, rest);
}

void DescentRun::pass()
{
    const std::vector<std::vector<float>>& frames = m_scene.m_scene.m_frames;
    const float* top = frames.front().data();
    for (int step = 0; step < kSettlingSteps; ++step)
        m_method->step(top, top);
    std::vector<StepOutcome> outcomes;
    for (std::size_t step = 0; step < m_scene.stepCount(); ++step)
    {
        outcomes.push_back(m_method->step(frames[step].data(), frames[step + 1].data()));
        for (const StageTime& stage : outcomes.back().m_stages)
            m_times[step][stage.m_name].add(stage.m_ms);
    }
    m_repeatable = m_repeatable && agree(m_variant.m_name + ", again", outcomes, m_outcomes, true);
    m_outcomes = std::move(outcomes);
}

void DescentRun::countTests()
{
    if (m_variant.m_settings.m_backend == Backend::Host || !m_variant.m_methods) return;
    StepVariant variant = m_variant;
    variant.m_name += ", counting";
    variant.m_methods->m_countTests = true;
    DescentRun counted(m_scene, variant);
    counted.warmUp();
    counted.pass();
    m_repeatable = m_repeatable && agree(variant.m_name, counted.m_outcomes, m_outcomes, true);
    for (std::size_t step = 0; step < m_outcomes.size(); ++step)
        m_outcomes[step].m_volumeTests = counted.m_outcomes[step].m_volumeTests;
}

void DescentRun::addRows(const char* part, const std::vector<StepOutcome>& reference, Table& table) const
{
    const StepScene& scene = m_scene.m_scene;
    const bool agrees = m_repeatable && agree(m_variant.m_name, m_outcomes, reference, m_variant.m_methods.has_value());
    for (std::size_t step = 0; step < m_times.size(); ++step)
    {
        const StepOutcome& outcome = m_outcomes[step];
        Row row;
        row["part"] = part;
        row["model"] = scene.m_spec.m_name;
        row["cloth_triangles"] = scene.m_spec.clothTriangles();
        row["triangles"] = scene.m_obstacle.triangleCount();
        row["variant"] = m_variant.m_name;
        m_method->describe(row);
        row["step"] = step;
        row["phase"] = step < m_scene.m_descent ? "descent" : "rest";
        row["candidates"] = outcome.m_candidates;
        row["contacts"] = outcome.m_contacts;
        if (outcome.m_volumeTests > 0) row["volume_tests"] = outcome.m_volumeTests;
        for (const char* stage : {"step", "refit", "broad", "narrow", "order"})
        {
            const auto found = m_times[step].find(stage);
            if (found != m_times[step].end()) row[std::string(stage) + "_ms"] = found->second.median();
        }
        row["hash"] = outcome.m_hash;
        judgeStep(row, reference[step], agrees);
        table.add(row);
    }
}
}  // namespace drape::bench
