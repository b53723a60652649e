#include "benchmarks/error_vs_time/trial_run.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/error_vs_time/trial_simulation.h"
#include "benchmarks/support/samples.h"
#include "examples/cloth_drop/capped_child.h"
#include "examples/cloth_drop/step_stream.h"

namespace drape::bench
{
namespace
{
// Share of the frames, the last ones, over which the speed at rest is taken.
constexpr double kRestShare = 0.1;

std::vector<std::string> childArguments(const ErrorOptions& options, const std::string& scene, int number)
{
    std::vector<std::string> arguments = {"error_vs_time",
                                          "--child-scene",
                                          scene,
                                          "--child-trial",
                                          std::to_string(number),
                                          "--backend",
                                          options.m_backend,
                                          "--frames",
                                          std::to_string(options.frames())};
    if (!options.m_device.empty()) arguments.insert(arguments.end(), {"--device", options.m_device});
    if (!options.m_models.empty()) arguments.insert(arguments.end(), {"--models", options.m_models});
    if (options.m_quick) arguments.push_back("--quick");
    return arguments;
}

// Largest rise of the energy from any step to a later one, over what the fall gave.
double energyGain(const std::vector<double>& energies)
{
    if (energies.empty()) return 0;
    double least = energies.front(), gain = 0;
    for (const double energy : energies)
    {
        least = std::min(least, energy);
        gain = std::max(gain, energy - least);
    }
    return gain / std::max(energies.front() - least, 1e-9);
}

double restSpeed(const std::vector<double>& speeds)
{
    const std::size_t count = std::max<std::size_t>(1, std::size_t(double(speeds.size()) * kRestShare));
    double squares = 0;
    for (std::size_t i = speeds.size() - count; i < speeds.size(); ++i)
        squares += speeds[i] * speeds[i];
    return std::sqrt(squares / double(count));
}

void describe(Row& row, const std::string& scene, const Trial& trial)
{
    row["scene"] = scene;
    row["method"] = trial.method();
    row["knob"] = trial.m_knob;
    row["value"] = trial.m_value;
    row["thickness_m"] = trial.m_thickness;
    row["activation"] = trial.m_activation;
    row["substeps"] = trial.m_substeps;
    row["iterations"] = trial.m_iterations;
    row["voxel_m"] = trial.m_voxel;
}

// Sums of each frame's substeps, of the frames that were in contact; of all, where none was.
void fillTimes(Row& row, const std::vector<StepRecord>& steps, std::size_t substeps)
{
    Samples frames, collisions, freeFrames, freeCollisions;
    std::size_t contactsMost = 0;
    for (std::size_t first = 0; first + substeps <= steps.size(); first += substeps)
    {
        double frame = 0, collision = 0;
        std::size_t contacts = 0;
        for (std::size_t i = first; i < first + substeps; ++i)
        {
            frame += steps[i].m_times.m_stepMs;
            collision += steps[i].m_times.m_collisionMs;
            contacts = std::max(contacts, steps[i].m_times.m_contacts);
        }
        contactsMost = std::max(contactsMost, contacts);
        (contacts == 0 ? freeFrames : frames).add(frame);
        (contacts == 0 ? freeCollisions : collisions).add(collision);
    }
    row["contacts_max"] = contactsMost;
    row["frames_in_contact"] = frames.count();
    if (frames.empty())
    {
        frames = freeFrames;
        collisions = freeCollisions;
    }
    if (frames.empty()) return;
    frames.fill(row, "frame_");
    row["frame_p5_ms"] = frames.quantile(0.05);
    row["collision_median_ms"] = collisions.median();
}

// The errors of whole courses only: those of a capped one would look better than they are.
void fillErrors(Row& row, const std::vector<StepRecord>& steps, std::size_t nodes)
{
    double deepest = 0;
    std::size_t pairsMost = 0, invalidMost = 0, samples = 0;
    std::vector<float> depths;
    for (const StepRecord& step : steps)
    {
        deepest = std::max(deepest, step.m_measure.m_penetrationMax);
        pairsMost = std::max(pairsMost, step.m_measure.m_intersectingPairs);
        invalidMost = std::max(invalidMost, step.m_measure.m_invalidNodes);
        if (step.m_times.m_contacts > 0 || !step.m_measure.m_nodeDepths.empty()) samples += nodes;
        depths.insert(depths.end(), step.m_measure.m_nodeDepths.begin(), step.m_measure.m_nodeDepths.end());
    }
    // Nodes that are not below count as 0.
    std::sort(depths.begin(), depths.end(), std::greater<>());
    const std::size_t above = samples / 100;
    row["penetration_max"] = deepest / kThickness;
    row["penetration_p99"] = above < depths.size() ? double(depths[above]) / kThickness : 0.0;
    row["intersecting_max"] = pairsMost;
    row["invalid_nodes"] = invalidMost;
    row["intersecting_end"] = steps.back().m_measure.m_intersectingPairs;
    row["nodes_below_end"] = steps.back().m_measure.nodesBelow();
}
}  // namespace

TrialResult runTrial(const ErrorOptions& options, const std::string& scene, const Trial& trial, int number,
                     double capSeconds)
{
    TrialResult result;
    describe(result.m_row, scene, trial);
    std::vector<StepRecord> steps;
    Row end;
    const ChildEnd child = runCappedChild(childArguments(options, scene, number), capSeconds,
                                          [&](int, const std::string& line)
                                          {
                                              if (line.rfind("{\"end\"", 0) == 0)
                                                  end = Row::parse(line).at("end");
                                              else
                                                  steps.push_back(stepFromLine(line));
                                          });
    const std::size_t substeps = std::size_t(trial.m_substeps);
    result.m_error = child.m_error;
    result.m_row["ended"] = child.m_capped ? "capped" : child.m_error.empty() ? "whole" : "failed";
    result.m_row["frames"] = steps.size() / substeps;
    fillTimes(result.m_row, steps, substeps);
    if (child.m_capped || !child.m_error.empty() || steps.empty() || !end.is_object()) return result;
    fillErrors(result.m_row, steps, end.at("nodes"));
    result.m_row["rest_speed_mm_s"] = 1000 * end.at("rest_speed").get<double>();
    result.m_row["nodes_through"] = end.at("crossed");
    result.m_row["energy_gain"] = end.at("energy_gain");
    result.m_row["device"] = end.at("device");
    result.m_final = end.at("final").get<std::vector<float>>();
    result.m_hash = hashText(steps.back().m_hash);
    result.m_row["hash"] = result.m_hash;
    return result;
}

int streamTrial(const ErrorOptions& options, const ErrorScene& scene, const Trial& trial)
{
    std::string error;
    const std::unique_ptr<TrialSimulation> simulation = makeTrialSimulation(scene, trial, options.settings(), error);
    if (!simulation) return fail("error_vs_time", kExitFailed, error);
    streamRun(*simulation, sceneOf(scene, trial), options.frames() * trial.m_substeps,
              [&]
              {
                  Row end;
                  end["nodes"] = scene.m_drop.m_cloth.m_mesh.vertexCount();
                  end["device"] = simulation->device();
                  end["rest_speed"] = restSpeed(simulation->speeds());
                  end["crossed"] = simulation->crossed();
                  end["energy_gain"] = energyGain(simulation->energies());
                  end["final"] = simulation->positions();
                  return Row{{"end", end}}.dump();
              });
}

double shapeDistance(const std::vector<float>& a, const std::vector<float>& b)
{
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        squares += (double(a[i]) - double(b[i])) * (double(a[i]) - double(b[i]));
    return std::sqrt(squares / (double(a.size()) / 3));
}
}  // namespace drape::bench
