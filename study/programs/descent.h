// A cloth comes down on an obstacle, a step at a time, so that overlaps grow from none to those at rest; there it
// sways.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "study/programs/step_judge.h"
#include "study/programs/study.h"
#include "study/programs/tree_method.h"

namespace drape::bench
{
// One way of doing a step.
struct StepVariant
{
    std::string m_name;
    Settings m_settings;
    std::optional<Methods> m_methods = {};  // for a step over trees; none: the pipeline's own
};

// Throws where the variant cannot be made. scene outlives the method.
std::unique_ptr<StepMethod> makeMethod(const StepScene& scene, const StepVariant& variant);

struct DescentScene
{
    DescentScene(const SceneSpec& spec, const TriangleMesh& obstacle, bool quick);
    std::size_t stepCount() const { return m_scene.m_frames.size() - 1; }

    StepScene m_scene;
    std::size_t m_descent;  // steps of it; the cloth sways in the others
};

// One variant over the descent, several times.
class DescentRun
{
public:
    // Throws where the variant cannot be made. scene outlives the run.
    DescentRun(const DescentScene& scene, const StepVariant& variant);

    // Steps at rest, where lists are longest, so that buffers grow before what is timed.
    void warmUp();
    // All steps once.
    void pass();
    // Volume tests of each step. A device's are counted in a run of their own, since that costs an atomic a work-item;
    // the host counts anyway. 0 where the variant cannot count.
    void countTests();

    const std::vector<StepOutcome>& outcomes() const { return m_outcomes; }
    // A row a step, void where the run does not agree with the reference. The host's steps are the reference.
    void addRows(const char* part, const std::vector<StepOutcome>& reference, Table& table) const;

private:
    const DescentScene& m_scene;
    StepVariant m_variant;
    std::unique_ptr<StepMethod> m_method;
    std::vector<std::map<std::string, Samples>> m_times;  // by step and stage
    std::vector<StepOutcome> m_outcomes;                  // results of the last pass
    bool m_repeatable = true;                             // every pass found the same
};
}  // namespace drape::bench
