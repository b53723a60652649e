#include "benchmarks/error_vs_time/trial.h"

#include <algorithm>

namespace drape::bench
{
namespace
{
constexpr int kReferenceSubsteps = 16;
// Voxels small enough for the bunny's ears; the knobs beside the voxel are turned at this size.
constexpr double kSmallVoxel = 0.05;  // m
// Cloth at rest must move by at most 1 mm/s, RMS, over 2,000 steps; before them it gets time to settle. A quick run
// only shows that the measurement works.
constexpr int kSettleFrames = 400, kRestFrames = 2000;
constexpr int kQuickSettleFrames = 30, kQuickRestFrames = 50;
// The cloth's speed is measured over this share of the frames of other trials, at their end.
constexpr double kLateShare = 0.1;
constexpr int kFallsOfDrape = 8, kFallsOfBullet = 4, kRestFallsOfDrape = 3;

// The most significant values come first: each is a round of its own.
template <typename T>
void sweep(std::vector<Trial>& trials, Trial base, const char* knob, T Trial::*field, const std::vector<double>& values)
{
    base.m_knob = knob;
    base.m_sameContacts = false;
    base.m_round = 0;
    for (const double value : values)
    {
        ++base.m_round;
        base.m_value = value;
        base.*field = T(value);
        trials.push_back(base);
    }
}

// The time of impact of Discrete differs; everything else must not.
void addModes(std::vector<Trial>& trials, Trial base)
{
    base.m_knob = "mode";
    base.m_round = 1;
    base.m_mode = ContactMode::Continuous;
    base.m_setting = "continuous";
    trials.push_back(base);
    base.m_mode = ContactMode::Discrete;
    base.m_setting = "discrete";
    base.m_sameContacts = false;
    trials.push_back(base);
}

void addFalls(std::vector<Trial>& trials, const Trial& base, int count)
{
    std::vector<double> seeds;
    for (int seed = 1; seed <= count; ++seed)
        seeds.push_back(seed);
    sweep(trials, base, "fall", &Trial::m_seed, seeds);
}

// Adds the usual fall first. Drape's trials then repeat it with other falls.
void addRest(std::vector<Trial>& trials, Trial base, bool quick)
{
    base.m_knob = "rest";
    base.m_sameContacts = false;
    base.m_round = 1;
    base.m_speedFrames = quick ? kQuickRestFrames : kRestFrames;
    base.m_frames = base.m_speedFrames + (quick ? kQuickSettleFrames : kSettleFrames);
    trials.push_back(base);
    if (!base.isDrape()) return;
    for (int seed = 1; seed <= (quick ? 1 : kRestFallsOfDrape); ++seed)
    {
        ++base.m_round;
        base.m_seed = std::uint32_t(seed);
        base.m_value = seed;
        trials.push_back(base);
    }
}
}  // namespace

std::string Trial::method() const
{
    return m_method == Method::Drape ? "drape" : m_method == Method::DrapeHost ? "drape_host" : "bullet";
}

std::vector<Trial> makeTrials(bool quick, bool withDevice, int frames)
{
    Trial host, drape, stock, tuned;
    host.m_method = Method::DrapeHost;
    drape.m_method = withDevice ? Method::Drape : Method::DrapeHost;
    stock.m_method = tuned.m_method = Method::BuiltIn;
    tuned.m_voxel = kSmallVoxel;
    for (Trial* base : {&host, &drape, &stock, &tuned})
    {
        base->m_frames = frames;
        base->m_speedFrames = std::max(1, int(frames * kLateShare));
    }
    Trial reference = drape;
    reference.m_knob = "reference";
    reference.m_value = reference.m_substeps = quick ? 4 : kReferenceSubsteps;
    reference.m_sameContacts = false;

    std::vector<Trial> trials = {host};
    if (withDevice) trials.push_back(drape);
    trials.push_back(stock);
    trials.push_back(reference);
    addModes(trials, drape);
    if (quick)
    {
        sweep(trials, drape, "substeps", &Trial::m_substeps, {2});
        addFalls(trials, drape, 1);
        addRest(trials, drape, quick);
        return trials;
    }
    sweep(trials, drape, "substeps", &Trial::m_substeps, {2, 4, 8});
    sweep(trials, drape, "iterations", &Trial::m_iterations, {20, 2, 40});
    sweep(trials, drape, "thickness", &Trial::m_thickness, {0.01, 0.04, 0.005});
    sweep(trials, drape, "activation", &Trial::m_activation, {1, 0.25, 2});
    sweep(trials, stock, "voxel", &Trial::m_voxel, {0.05, 0.1, 0.025});
    sweep(trials, tuned, "substeps", &Trial::m_substeps, {2, 4, 8});
    sweep(trials, tuned, "margin", &Trial::m_thickness, {0.04, 0.08, 0.16});
    sweep(trials, tuned, "iterations", &Trial::m_iterations, {20, 10});
    addFalls(trials, drape, kFallsOfDrape);
    addFalls(trials, tuned, kFallsOfBullet);
    addRest(trials, drape, quick);
    addRest(trials, tuned, quick);
    return trials;
}

int roundsOf(const std::vector<Trial>& trials)
{
    int rounds = 0;
    for (const Trial& trial : trials)
        rounds = std::max(rounds, trial.m_round + 1);
    return rounds;
}
}  // namespace drape::bench
