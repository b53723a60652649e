// What the decay of the cloth's hierarchy costs, and what building it anew gains: a cloth over the bunny changes its
// shape over a run, with rebuilds and without. A rebuild is waited for after the step in which it began, and its time
// is in no figure, so that counts and times are of the same hierarchies in every run.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "benchmarks/study/step_judge.h"
#include "benchmarks/study/study.h"

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
};

void addVariants(const std::string& name, Settings settings, const std::vector<float>& decays,
                 std::vector<Variant>& all)
{
    settings.m_methods.m_traversal = Traversal::Front;
    settings.m_profileKernels = settings.m_backend != Backend::Host;
    for (const float decay : decays)
    {
        std::ostringstream text;
        text << name << (decay > 0 ? ", rebuilt from " : ", never rebuilt");
        if (decay > 0) text << decay;
        settings.m_methods.m_rebuildDecay = decay;
        all.push_back({text.str(), settings});
    }
}

// The front, whose pairs are of nodes of both hierarchies, by every threshold. Of what takes long, and of a device,
// only by the default one: the tests of volumes are those of the host but for the pairs it starts from. At rest nothing
// should be rebuilt even by the lowest.
std::vector<Variant> variants(Change change, bool isLarge, const StudyOptions& options)
{
    const std::vector<float> all = {0, 1.2f, 1.5f, 2, 3}, one = {0, Methods().m_rebuildDecay}, least = {0, 1.2f};
    std::vector<Variant> variants;
    Settings host;
    host.m_backend = Backend::Host;
    // The host is the reference, so it is first.
    addVariants("host, thesis: front", host, change == Change::Rest ? least : isLarge ? one : all, variants);
    if (options.m_backend != "host" && change != Change::Rest)
        addVariants("thesis: front", options.settings(), one, variants);
    return variants;
}

// What some passes over the frames took and found. Each begins with a hierarchy of the cloth at rest, and after every
// step a rebuild under way is waited for: the same steps rebuild in each pass.
class Run
{
public:
    // counting: for volume tests, which cost a device time; the host counts anyway.
    Run(const StepScene& scene, const Variant& variant, bool counting = false) : m_scene(scene), m_name(variant.m_name)
    {
        std::string error;
        Settings settings = variant.m_settings;
        settings.m_methods.m_countTests = counting;
        m_method = makeDrapeMethod(scene, settings, error);
        if (!m_method) throw std::runtime_error(error);
        m_times.resize(scene.m_frames.size() - 1);
        // Buffers grow before what is timed.
        for (std::size_t frame = 0; frame < scene.m_frames.size(); frame += 8)
            m_method->step(scene.m_frames[frame].data(), scene.m_frames[frame].data());
    }

    void pass()
    {
        m_method->restart();
        std::vector<StepOutcome> outcomes;
        for (std::size_t step = 0; step < m_times.size(); ++step)
        {
            outcomes.push_back(m_method->step(m_scene.m_frames[step].data(), m_scene.m_frames[step + 1].data()));
            m_method->settle();
            for (const StageTime& stage : outcomes.back().m_stages)
                m_times[step][stage.m_name].add(stage.m_ms);
        }
        if (!m_outcomes.empty()) hold(outcomes);
        m_outcomes = std::move(outcomes);
    }

    // Takes volume tests over from a run that counted.
    void takeCounts(const Run& counted)
    {
        hold(counted.m_outcomes);
        for (std::size_t step = 0; step < m_outcomes.size(); ++step)
            m_outcomes[step].m_volumeTests = counted.m_outcomes[step].m_volumeTests;
    }

    const std::vector<StepOutcome>& outcomes() const { return m_outcomes; }
    bool repeatable() const { return m_repeatable; }
    const std::map<std::string, Samples>& times(std::size_t step) const { return m_times[step]; }
    void describe(Row& row) const { m_method->describe(row); }

private:
    // Another pass must find the same and rebuild in the same steps.
    void hold(const std::vector<StepOutcome>& other)
    {
        const auto rebuiltAlike = [](const StepOutcome& a, const StepOutcome& b)
        { return a.m_rebuilds == b.m_rebuilds; };
        const bool alike = std::equal(other.begin(), other.end(), m_outcomes.begin(), m_outcomes.end(), rebuiltAlike);
        if (!alike) std::cerr << "study: " << m_name << ": other steps rebuild" << std::endl;
        m_repeatable = agree(m_name + ", again", other, m_outcomes, true) && alike && m_repeatable;
    }

    const StepScene& m_scene;
    std::string m_name;
    std::unique_ptr<StepMethod> m_method;
    std::vector<std::map<std::string, Samples>> m_times;  // by step and stage
    std::vector<StepOutcome> m_outcomes;                  // of the last pass
    bool m_repeatable = true;
};

void addRows(const StepScene& scene, const std::string& change, const Variant& variant, const Run& run,
             const std::vector<StepOutcome>& reference, Table& table)
{
    const bool agrees = agree(variant.m_name, run.outcomes(), reference, true) && run.repeatable();
    for (std::size_t step = 0; step < reference.size(); ++step)
    {
        const StepOutcome& outcome = run.outcomes()[step];
        Row row;
        row["part"] = "rebuild";
        row["model"] = scene.m_spec.m_name + ", " + change;
        row["cloth_triangles"] = scene.m_spec.clothTriangles();
        row["triangles"] = scene.m_obstacle.triangleCount();
        row["variant"] = variant.m_name;
        run.describe(row);
        row["decay"] = variant.m_settings.m_methods.m_rebuildDecay;
        row["step"] = step;
        row["candidates"] = outcome.m_candidates;
        row["contacts"] = outcome.m_contacts;
        row["rebuilds"] = outcome.m_rebuilds;
        if (outcome.m_volumeTests > 0) row["volume_tests"] = outcome.m_volumeTests;
        for (const char* stage : {"step", "refit", "broad"})
        {
            const auto found = run.times(step).find(stage);
            if (found != run.times(step).end()) row[std::string(stage) + "_ms"] = found->second.median();
        }
        row["hash"] = outcome.m_hash;
        judgeStep(row, reference[step], agrees);
        table.add(row);
    }
}

// Passes, of what is long fewer; at least two.
void measure(Run& run, const Variant& variant, const StepScene& scene, const StudyOptions& options)
{
    const Clock::time_point begin = Clock::now();
    for (int pass = 0; pass < options.m_repeats; ++pass)
    {
        if (pass < 2 || millisecondsSince(begin) < 1000 * options.m_seconds) run.pass();
    }
    if (variant.m_settings.m_backend == Backend::Host) return;
    Run counted(scene, variant, true);
    counted.pass();
    run.takeCounts(counted);
}

void studyChange(const SceneSpec& spec, const TriangleMesh& obstacle, const std::string& name, Change change,
                 const StudyOptions& options, Table& table)
{
    constexpr std::size_t kLarge = 100000;  // cloth triangles, of which a step takes a third of a second
    constexpr int kSteps = 64, kLargeSteps = 40, kQuickSteps = 24;
    const bool isLarge = spec.clothTriangles() > kLarge;
    // The large cloth says no more of these than the small one.
    if (isLarge && (change == Change::Rest || change == Change::Tear)) return;
    StepScene scene = makeStepScene(spec, obstacle);
    makeFrames(scene, change, options.m_quick ? kQuickSteps : isLarge ? kLargeSteps : kSteps);
    std::vector<StepOutcome> reference;
    for (const Variant& variant : variants(change, isLarge, options))
    {
        if (options.tooLate(spec.m_name + ", " + name + ", " + variant.m_name)) continue;
        Run run(scene, variant);
        measure(run, variant, scene, options);
        if (reference.empty()) reference = run.outcomes();
        addRows(scene, name, variant, run, reference, table);
    }
}
}  // namespace

void studyRebuilds(const StudyOptions& options, Table& table)
{
    for (const SceneSpec& spec : studyScenes(options))
    {
        TriangleMesh obstacle;
        if (!loadModel(spec.m_model, options, obstacle)) continue;
        for (const auto& [name, change] : {std::pair<const char*, Change>("rest", Change::Rest),
                                           {"folded", Change::Fold},
                                           {"crumpled", Change::Crumple},
                                           {"torn", Change::Tear}})
            studyChange(spec, obstacle, name, change, options, table);
    }
}
}  // namespace drape::bench
