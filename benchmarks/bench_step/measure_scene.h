// Runs the methods on a scene and makes the rows.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/bench_step/peer_methods.h"
#include "benchmarks/support/table.h"

namespace drape::bench
{
struct MeasureSettings
{
    int m_repeats = 3;       // periods that are timed, at most
    double m_seconds = 10;   // for a method's timed steps; one period is timed in any case
    std::string m_expected;  // hash that the reference itself must have; empty: any
};

// The results of a method over an untimed period and some timed ones. `hash` belongs to the first period. If a later
// period gave other contacts, `hash` says so instead.
struct MethodRun
{
    Row m_description;
    std::vector<std::pair<std::string, class Samples>> m_stages;
    double m_firstMs = 0;
    double m_candidates = 0, m_contacts = 0;  // means
    std::string m_hash;                       // empty for methods without contacts
};

MethodRun runMethod(StepMethod& method, const StepScene& scene, const MeasureSettings& settings);

// Measures the methods. The first one gives the reference hash. A method that cannot run is reported on standard error
// and leaves no row; the function then returns false.
bool measureScene(const StepScene& scene, const std::vector<MethodEntry>& methods, const MeasureSettings& settings,
                  Table& table);
}  // namespace drape::bench
