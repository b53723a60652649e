// A trial: one method with its knobs, on a scene. The same list for every scene, so that a number names a trial.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/error_vs_time/error_scene.h"
#include "drape/settings.h"

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
    std::string m_knob = "defaults";  // the varied setting; "reference": the run that shapes are compared with
    double m_value = 0;
    std::string m_setting;       // the value's name, where it is no number
    int m_round = 0;             // trials of earlier rounds are run first: those that say most
    bool m_sameContacts = true;  // Drape only: must give the defaults' trajectory, bit for bit

    double m_thickness = kThickness;  // m: both margins
    double m_activation = 0.5;        // Drape, see Settings
    ContactMode m_mode = ContactMode::Automatic;
    int m_substeps = 1;        // steps a frame
    int m_iterations = 5;      // iterations of Bullet's position solver
    double m_voxel = 0;        // m, of the distance field; 0: as Bullet sets it up
    std::uint32_t m_seed = 0;  // random seed of the fall; 0: flat and from rest
    int m_frames = 0;          // number of frames of 1/60 s
    int m_speedFrames = 0;     // the last ones, over which the cloth's RMS speed is taken

    std::string method() const;
    bool isDrape() const { return m_method != Method::BuiltIn; }
};

// Defaults and reference first, then Drape's knobs and Bullet's. Without a device there is no Method::Drape. frames:
// of every trial but those that wait for the cloth to come to rest. A rest trial's value is the seed of its fall.
std::vector<Trial> makeTrials(bool quick, bool withDevice, int frames);

// Returns 1 + the last round of any trial.
int roundsOf(const std::vector<Trial>& trials);
}  // namespace drape::bench
