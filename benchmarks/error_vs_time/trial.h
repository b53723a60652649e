// A trial: one method with its knobs, on a scene. The same list for every scene, so that a number names a trial.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/error_vs_time/error_scene.h"

namespace drape::bench
{
enum class Method
{
    Drape,
    DrapeHost,
    BuiltIn  // Bullet's distance field
};

struct Trial
{
    Method m_method = Method::Drape;
    std::string m_knob = "defaults";  // what is turned; "reference": the run that shapes are compared with
    double m_value = 0;

    double m_thickness = kThickness;  // m: both margins
    double m_activation = 0.5;        // Drape, see Settings
    int m_substeps = 1;               // steps a frame
    int m_iterations = 5;             // of Bullet's position solver
    double m_voxel = 0;               // m, of the distance field; 0: as Bullet sets it up

    std::string method() const;
    bool isDrape() const { return m_method != Method::BuiltIn; }
};

// Defaults and reference first, then knob by knob, Drape's and Bullet's in turn. Without a device there is no
// Method::Drape.
std::vector<Trial> makeTrials(bool quick, bool withDevice);
}  // namespace drape::bench
