#include "benchmarks/error_vs_time/trial.h"

namespace drape::bench
{
namespace
{
constexpr int kReferenceSubsteps = 16;
// Voxels small enough for the bunny's ears; the knobs beside the voxel are turned at this size.
constexpr double kSmallVoxel = 0.05;  // m

template <typename T>
void sweep(std::vector<Trial>& trials, Trial base, const char* knob, T Trial::*field, const std::vector<double>& values)
{
    base.m_knob = knob;
    for (const double value : values)
    {
        base.m_value = value;
        base.*field = T(value);
        trials.push_back(base);
    }
}
}  // namespace

std::string Trial::method() const
{
    return m_method == Method::Drape ? "drape" : m_method == Method::DrapeHost ? "drape_host" : "bullet";
}

std::vector<Trial> makeTrials(bool quick, bool withDevice)
{
    Trial host, drape, stock, tuned;
    host.m_method = Method::DrapeHost;
    drape.m_method = withDevice ? Method::Drape : Method::DrapeHost;
    stock.m_method = tuned.m_method = Method::BuiltIn;
    tuned.m_voxel = kSmallVoxel;
    Trial reference = drape;
    reference.m_knob = "reference";
    reference.m_value = reference.m_substeps = quick ? 4 : kReferenceSubsteps;

    std::vector<Trial> trials = {host};
    if (withDevice) trials.push_back(drape);
    trials.push_back(stock);
    trials.push_back(reference);
    if (quick)
    {
        sweep(trials, drape, "substeps", &Trial::m_substeps, {2});
        return trials;
    }
    sweep(trials, drape, "substeps", &Trial::m_substeps, {2, 4, 8});
    sweep(trials, stock, "voxel", &Trial::m_voxel, {0.1, 0.05, 0.025});
    sweep(trials, drape, "iterations", &Trial::m_iterations, {1, 2, 10, 20, 40});
    sweep(trials, tuned, "substeps", &Trial::m_substeps, {2, 4, 8});
    sweep(trials, drape, "thickness", &Trial::m_thickness, {0.005, 0.01, 0.04, 0.08});
    sweep(trials, tuned, "margin", &Trial::m_thickness, {0.04, 0.08, 0.16});
    sweep(trials, drape, "activation", &Trial::m_activation, {0.1, 0.25, 1, 2});
    sweep(trials, tuned, "iterations", &Trial::m_iterations, {10, 20});
    return trials;
}
}  // namespace drape::bench
