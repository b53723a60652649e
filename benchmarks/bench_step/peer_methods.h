// The peers of bench_step, and the list of methods that it runs.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "benchmarks/support/step_method.h"

namespace drape::bench
{
// A method and its name in the rows. m_make returns null with one line in `error` if it cannot run here.
struct MethodEntry
{
    std::string m_name;
    std::function<std::unique_ptr<StepMethod>(const StepScene& scene, std::string& error)> m_make;
};

// Makes Embree's method: user geometry with a box per triangle over the step's motion, grown by `reach` m, refitted and
// collided. With contacts, Drape's host narrow phase tests the candidates on the same threads. `reach` must then be
// contactReach().
std::unique_ptr<StepMethod> makeEmbreeMethod(const StepScene& scene, int threads, float reach, bool contacts,
                                             std::string& error);

// Makes FCL's method: 18-DOP trees in float, refitted and collided by one thread. With `grown`, volumes cover the
// step's motion, grown by contactReach(), and the results are pairs of triangles. Otherwise FCL returns the triangles
// that intersect at the step's end.
std::unique_ptr<StepMethod> makeFclMethod(const StepScene& scene, bool grown, std::string& error);
}  // namespace drape::bench
