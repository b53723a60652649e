// What the decay of the cloth's hierarchy costs, and what building it anew gains: a cloth over the bunny changes its
// shape over a run, with rebuilds and without.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "benchmarks/study/study.h"
#include "benchmarks/support/step_method.h"

namespace drape::bench
{
namespace
{
constexpr std::size_t kLayers = 8;
constexpr double kTurn = 6.283185307179586;

// How the cloth changes: its own sway; folded like a fan; crumpled to a ball on the obstacle's top; or torn into
// triangles that fly to one another's places.
enum class Change
{
    Rest,
    Fold,
    Crumple,
    Tear
};

// A node of the ball, u and v from 0 to 1: waves long enough that triangles keep their size, m.
void crumple(double u, double v, double top, float* out)
{
    constexpr double kRadius = 0.4;
    out[0] = static_cast<float>(kRadius * std::sin(kTurn * (u + 0.3 * v)));
    out[1] = static_cast<float>(top + kRadius * std::sin(kTurn * (0.4 * u + 1.1 * v)));
    out[2] = static_cast<float>(kRadius * std::sin(kTurn * (0.7 * u - v)));
}

// Makes the cloth's triangles loose; returns where each flies to. A stride that has no divisor in common with their
// number sends no two to one place.
std::vector<float> tear(StepScene& scene)
{
    TriangleMesh& cloth = scene.m_cloths.front();
    std::vector<float> loose;
    for (const std::int32_t vertex : cloth.m_triangles)
        loose.insert(loose.end(), &scene.m_frames.front()[3 * static_cast<std::size_t>(vertex)],
                     &scene.m_frames.front()[3 * static_cast<std::size_t>(vertex)] + 3);
    std::iota(cloth.m_triangles.begin(), cloth.m_triangles.end(), 0);
    cloth.m_positions = scene.m_frames.front() = loose;
    std::vector<float> target(loose.size());
    const std::size_t count = cloth.triangleCount();
    std::size_t stride = count / 3;
    while (std::gcd(stride, count) != 1)
        ++stride;
    for (std::size_t i = 0; i < count; ++i)
        std::copy_n(&loose[9 * i], 9, &target[9 * (i * stride % count)]);
    return target;
}

// x y z per node after the change. Layers of a fold lie half a thickness apart, over the middle.
std::vector<float> changed(const std::vector<float>& rest, Change change, int cells, float thickness)
{
    std::vector<float> target = rest;
    const std::size_t side = static_cast<std::size_t>(cells) + 1, width = std::max<std::size_t>(1, side / kLayers);
    for (std::size_t node = 0; change == Change::Fold && node < side * side; ++node)
    {
        const std::size_t row = node / side, layer = row / width, along = row % width;
        const std::size_t middle = (side - width) / 2, column = node % side;
        const std::size_t onto = (middle + (layer % 2 == 0 ? along : width - 1 - along)) * side + column;
        std::copy(&rest[3 * onto], &rest[3 * onto] + 3, &target[3 * node]);
        target[3 * node + 1] += 0.5f * thickness * static_cast<float>(layer);
    }
    double top = 0;
    for (std::size_t i = 1; i < rest.size(); i += 3)
        top = std::max(top, static_cast<double>(rest[i]));
    for (std::size_t node = 0; change == Change::Crumple && node < side * side; ++node)
        crumple(static_cast<double>(node / side) / cells, static_cast<double>(node % side) / cells, top,
                &target[3 * node]);
    return target;
}

// Positions at the start of each step and the end of the last: half of the steps change the cloth, the rest keep it.
void makeFrames(StepScene& scene, Change change, int steps)
{
    const std::vector<std::vector<float>> sway = scene.m_frames;
    if (change == Change::Rest)
    {
        while (scene.m_frames.size() <= static_cast<std::size_t>(steps))
            scene.m_frames.push_back(sway[scene.m_frames.size() % sway.size()]);
        return;
    }
    const std::vector<float> target =
        change == Change::Tear ? tear(scene) : changed(sway.front(), change, scene.m_spec.m_cells, scene.m_thickness);
    const std::vector<float> rest = scene.m_frames.front();
    scene.m_frames.clear();
    for (int step = 0; step <= steps; ++step)
    {
        const float share = std::min(1.0f, 2.0f * static_cast<float>(step) / static_cast<float>(steps));
        std::vector<float> frame = rest;
        for (std::size_t i = 0; i < frame.size(); ++i)
            frame[i] += share * (target[i] - frame[i]);
        scene.m_frames.push_back(frame);
    }
}

struct Variant
{
    std::string m_name;
    Settings m_settings;
    bool m_orderedAnew = false;  // the cloth is added in its last shape
};

// The host is the reference, so it is first.
std::vector<Variant> variants(const StudyOptions& options)
{
    std::vector<Variant> all;
    const auto addBoth = [&all](const std::string& name, Settings settings, Traversal traversal)
    {
        settings.m_methods.m_traversal = traversal;
        settings.m_profileKernels = settings.m_backend != Backend::Host;
        for (const float decay : {0.0f, Methods().m_rebuildDecay})
        {
            settings.m_methods.m_rebuildDecay = decay;
            all.push_back({name + (decay > 0 ? ", rebuilt" : ", never rebuilt"), settings});
        }
    };
    Settings host;
    host.m_backend = Backend::Host;
    addBoth("host, thesis: front", host, Traversal::Front);
    addBoth("host, pairs of subtrees", host, Traversal::Pairs);
    if (options.m_backend == "host") return all;
    addBoth("pairs of subtrees", options.settings(), Traversal::Pairs);
    addBoth("thesis: front", options.settings(), Traversal::Front);
    for (const bool anew : {false, true})
    {
        all.push_back({anew ? "default, cloth in the order of its last shape" : "default", options.settings(), anew});
        all.back().m_settings.m_profileKernels = true;
    }
    return all;
}

struct Run
{
    std::vector<StepOutcome> m_outcomes;
    Row m_device;
};

// counting: the volume tests instead of the times, which counting would lengthen.
Run run(StepScene scene, Variant variant, bool counting)
{
    std::string error;
    variant.m_settings.m_methods.m_countTests = counting;
    if (variant.m_orderedAnew) scene.m_cloths.front().m_positions = scene.m_frames.back();
    const std::unique_ptr<StepMethod> method = makeDrapeMethod(scene, variant.m_settings, error);
    if (!method) throw std::runtime_error(error);
    Run run;
    method->describe(run.m_device);
    for (std::size_t step = 0; step + 1 < scene.m_frames.size(); ++step)
        run.m_outcomes.push_back(method->step(scene.m_frames[step].data(), scene.m_frames[step + 1].data()));
    return run;
}

void addRows(const StepScene& scene, const std::string& change, const Variant& variant, const Run& timed,
             const Run& counted, const Run& reference, Table& table)
{
    for (std::size_t step = 0; step < timed.m_outcomes.size(); ++step)
    {
        const StepOutcome& outcome = timed.m_outcomes[step];
        Row row;
        row["part"] = "rebuild";
        row["model"] = scene.m_spec.m_name + ", " + change;
        row["cloth_triangles"] = scene.m_spec.clothTriangles();
        row["triangles"] = scene.m_obstacle.triangleCount();
        row["variant"] = variant.m_name;
        row.update(timed.m_device);
        row["step"] = step;
        row["candidates"] = outcome.m_candidates;
        row["contacts"] = outcome.m_contacts;
        row["rebuilds"] = outcome.m_rebuilds;
        if (counted.m_outcomes[step].m_volumeTests > 0) row["volume_tests"] = counted.m_outcomes[step].m_volumeTests;
        for (const StageTime& stage : outcome.m_stages)
        {
            if (stage.m_name == "step" || stage.m_name == "refit" || stage.m_name == "broad")
                row[stage.m_name + "_ms"] = stage.m_ms;
        }
        row["hash"] = outcome.m_hash;
        judgeRow(row, reference.m_outcomes[step].m_hash);
        table.add(row);
    }
}

void studyScene(const SceneSpec& spec, const TriangleMesh& obstacle, const StudyOptions& options, Table& table)
{
    constexpr int kSteps = 64;
    constexpr int kQuickSteps = 24;
    for (const auto& [name, change] : {std::pair<const char*, Change>("rest", Change::Rest),
                                       {"folded", Change::Fold},
                                       {"crumpled", Change::Crumple},
                                       {"torn", Change::Tear}})
    {
        StepScene scene = makeStepScene(spec, obstacle);
        makeFrames(scene, change, options.m_quick ? kQuickSteps : kSteps);
        Run reference;
        for (const Variant& variant : variants(options))
        {
            if (options.tooLate(spec.m_name + ", " + name + ", " + variant.m_name)) continue;
            const Run timed = run(scene, variant, false);
            if (reference.m_outcomes.empty()) reference = timed;
            addRows(scene, name, variant, timed, run(scene, variant, true), reference, table);
        }
    }
}
}  // namespace

void studyRebuilds(const StudyOptions& options, Table& table)
{
    for (const SceneSpec& spec : studyScenes(options))
    {
        TriangleMesh obstacle;
        if (loadModel(spec.m_model, options, obstacle)) studyScene(spec, obstacle, options, table);
    }
}
}  // namespace drape::bench
