// The step on the host. Needs no OpenCL device.
#pragma once

#include <memory>
#include <utility>

#include "drape/settings.h"
#include "host_patches.h"

namespace drape
{
class HostBackend
{
public:
    explicit HostBackend(std::shared_ptr<ThreadTeam> threads) : m_threads(std::move(threads)) {}

    // Does what a step does after meshes came or obstacles moved.
    void prepare(const Scene& scene) { m_patches.update(scene); }
    // Runs the whole step. The result says whether the step exceeded a limit; if not, its counts are written to the
    // statistics. Retries and times are added.
    void run(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepResult& result,
             StepStatistics& statistics);

    // Releases memory that only earlier, larger steps needed. Call between steps.
    void giveBackRoom() { m_patches.giveBackRoom(); }

    // Returns HostPatches::countTests() of the step.
    std::vector<std::uint64_t> countTests(const Scene& scene, const StepPairs& pairs, const Settings& settings);

private:
    static SelfStep selfStep(const Scene& scene, const StepPairs& pairs, const Settings& settings);
    void runSelf(const Scene& scene, const StepPairs& pairs, const Settings& settings, StepCounters& counters,
                 StepResult& result, StepStatistics& statistics);

    std::shared_ptr<ThreadTeam> m_threads;
    HostPatches m_patches;
};
}  // namespace drape
