// An implementation of a collision step, timed stage by stage: Drape on a back end, or a peer.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/support/step_scene.h"
#include "benchmarks/support/table.h"
#include "drape/settings.h"

namespace drape::bench
{
struct StageTime
{
    std::string m_name;
    double m_ms;
};

struct StepOutcome
{
    std::vector<StageTime> m_stages;  // "step" is the whole, from positions in host memory to the result in host memory
    std::size_t m_candidates = 0;
    std::size_t m_contacts = 0;
    std::size_t m_volumeTests = 0;  // 0: not counted
    std::string m_hash;             // hash of the contacts; empty for a method that finds only candidates
};

class StepMethod
{
public:
    virtual ~StepMethod() = default;

    // Runs one step of all cloths: x y z per node at the step's start and end, in the scene's order. Only the work
    // itself is timed, not the hashing.
    virtual StepOutcome step(const float* start, const float* end) = 0;

    // Adds what says which method it is (backend, device, threads …), and one-time costs.
    virtual void describe(Row& row) const = 0;
    // Rows beside the times: memory by buffer. Called after the last step.
    virtual std::vector<Row> extraRows() const { return {}; }
};

// Makes the pipeline's method, host to host. With the host back end its contacts' hash is the reference. The scene must
// outlive the method.
std::unique_ptr<StepMethod> makeDrapeMethod(const StepScene& scene, const Settings& settings, std::string& error);
// Makes the pipeline's method with redundant contacts left out, as in the plugin.

// Returns the distance within which Drape finds contacts with default settings: thickness and activation.
float contactReach(const StepScene& scene);
// Returns the reach of a cloth to itself, or 0 if it does not collide with itself.
float selfReach(const StepScene& scene);
}  // namespace drape::bench
