// The peers of bench_step, and the list of methods that it runs.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "benchmarks/support/step_method.h"

namespace drape::bench
{
// A method by the name that rows carry. m_make returns null with one line in `error` when it cannot run here.
struct MethodEntry
{
    std::string m_name;
    std::function<std::unique_ptr<StepMethod>(const StepScene& scene, std::string& error)> m_make;
    bool m_reduced = false;  // leaves redundant contacts out: its hash is that of the reference that does
};

// Embree: user geometry with a box per triangle over the step's motion, grown by `reach` m, refitted and collided.
// With contacts: followed by Drape's host narrow phase over its candidates, on the same threads. reach must then be
// contactReach().
std::unique_ptr<StepMethod> makeEmbreeMethod(const StepScene& scene, int threads, float reach, bool contacts,
                                             std::string& error);

// FCL: 18-DOP trees in float, refitted and collided by one thread. grown: volumes over the step's motion, grown by
// contactReach(), pairs of triangles out; else as FCL does it: the triangles that intersect at the step's end.
std::unique_ptr<StepMethod> makeFclMethod(const StepScene& scene, bool grown, std::string& error);
}  // namespace drape::bench
