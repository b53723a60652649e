#include "benchmarks/error_vs_time/trial_run.h"

#include <algorithm>
#include <cmath>

#include "benchmarks/error_vs_time/trial_simulation.h"
#include "benchmarks/support/samples.h"
#include "drape/report.h"
#include "tools/cloth_drop/capped_child.h"
#include "tools/cloth_drop/step_stream.h"

namespace drape::bench
{
namespace
{
std::vector<std::string> childArguments(const ErrorOptions& options, const std::string& scene, int number)
{
    std::vector<std::string> arguments = {kProgram,
                                          "--child-scene",
                                          scene,
                                          "--child-trial",
                                          std::to_string(number),
                                          "--backend",
                                          options.m_backend,
                                          "--frames",
                                          std::to_string(options.m_frames)};
    if (!options.m_device.empty()) arguments.push_back("--device=" + options.m_device);
    if (!options.m_models.empty()) arguments.push_back("--models=" + options.m_models);
    if (options.m_quick) arguments.push_back("--quick");
    if (hasDevice(options)) arguments.push_back("--child-device");
    return arguments;
}

// Energy gained beyond that of the fall: the largest rise of the kinetic energy from any step to a later one, and the
// part of such a rise that no link had stored.
struct EnergyErrors
{
    double m_rise = 0, m_gain = 0;
};

EnergyErrors energyErrors(const std::vector<ClothEnergy>& energies)
{
    EnergyErrors errors;
    if (energies.empty()) return errors;
    double leastMotion = energies.front().m_motion, least = leastMotion + energies.front().m_links;
    for (const ClothEnergy& energy : energies)
    {
        errors.m_rise = std::max(errors.m_rise, energy.m_motion - leastMotion);
        errors.m_gain = std::max(errors.m_gain, energy.m_motion - least);
        leastMotion = std::min(leastMotion, energy.m_motion);
        least = std::min(least, energy.m_motion + energy.m_links);
    }
    const double fall = std::max(energies.front().m_motion - leastMotion, 1e-9);
    return {errors.m_rise / fall, errors.m_gain / fall};
}

// Returns the RMS of the last `count` speeds.
double lateSpeed(const std::vector<double>& speeds, std::size_t count)
{
    count = std::min(count, speeds.size());
    double squares = 0;
    for (std::size_t i = speeds.size() - count; i < speeds.size(); ++i)
        squares += speeds[i] * speeds[i];
    return std::sqrt(squares / double(count));
}

const char* modeName(ContactMode mode)
{
    return mode == ContactMode::Automatic ? "automatic" : mode == ContactMode::Discrete ? "discrete" : "continuous";
}

void describe(Row& row, const std::string& scene, const Trial& trial)
{
    row["part"] = kSimulationPart;
    row["scene"] = scene;
    row["method"] = trial.method();
    row["knob"] = trial.m_knob;
    row["value"] = trial.m_value;
    row["setting"] = trial.m_setting;
    row["thickness_m"] = trial.m_thickness;
    row["activation"] = trial.m_activation;
    row["substeps"] = trial.m_substeps;
    row["iterations"] = trial.m_iterations;
    row["voxel_m"] = trial.m_voxel;
    row["mode"] = trial.isDrape() ? modeName(trial.m_mode) : "";
    row["seed"] = trial.m_seed;
    if (trial.isDrape() && trial.m_sameContacts) row[kMustMatch] = "defaults";
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

// Adds errors of complete runs only: those of a capped run would look better than they are.
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

bool hasDevice(const ErrorOptions& options)
{
    return options.m_backend != "host" && options.m_device != "host" && !listDevices().empty();
}

Row describeTrial(const std::string& scene, const Trial& trial, const std::string& why)
{
    Row row;
    describe(row, scene, trial);
    row["ended"] = why;
    return row;
}

TrialResult runTrial(const ErrorOptions& options, const std::string& scene, const Trial& trial, int number,
                     double capSeconds)
{
    TrialResult result;
    describe(result.m_row, scene, trial);
    std::vector<StepRecord> steps;
    Row end;
    const ChildEnd child = runCappedChild(childArguments(options, scene, number), {capSeconds},
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
    const char* speed = trial.m_knob == "rest" ? "rest_speed_mm_s" : "late_speed_mm_s";
    result.m_row["speed_frames"] = trial.m_speedFrames;
    result.m_row[speed] = 1000 * end.at("late_speed").get<double>();
    result.m_row["nodes_through"] = end.at("crossed");
    for (const char* energy : {"energy_rise", "energy_gain"})
        if (end.contains(energy)) result.m_row[energy] = end.at(energy);
    result.m_row["device"] = end.at("device");
    result.m_final = end.at("final").get<std::vector<float>>();
    result.m_hash = hashText(steps.back().m_hash);
    result.m_row["hash"] = result.m_hash;
    return result;
}

int streamTrial(const ErrorOptions& options, const ErrorScene& scene, const Trial& trial)
{
    std::string error;
    const ErrorScene own = sceneOf(scene, trial);
    const std::unique_ptr<TrialSimulation> simulation = makeTrialSimulation(own, trial, options.settings(), error);
    if (!simulation) return fail(kProgram, kExitFailed, error);
    streamRun(*simulation, subjectOf(own.m_drop), trial.m_frames * trial.m_substeps,
              [&]
              {
                  Row end;
                  end["nodes"] = own.m_drop.m_cloth.m_mesh.vertexCount();
                  end["device"] = simulation->device();
                  end["late_speed"] =
                      lateSpeed(simulation->speeds(), std::size_t(trial.m_speedFrames) * std::size_t(trial.m_substeps));
                  end["crossed"] = simulation->crossed();
                  // A moving obstacle does work.
                  if (own.m_rise == 0)
                  {
                      const EnergyErrors errors = energyErrors(simulation->energies());
                      end["energy_rise"] = errors.m_rise;
                      end["energy_gain"] = errors.m_gain;
                  }
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
