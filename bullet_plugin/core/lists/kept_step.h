// The step of a cloth whose nodes stay on a device (solver/device/kept_nodes.h).
#pragma once

#include <cstdint>

#include "kernels/shared/kept_nodes.h"

namespace drape
{
using KeptId = std::uint32_t;

struct KeptStep
{
    KeptId m_id = 0;
    Vec3 m_gravity = {};       // m/s, what gravity adds to a velocity in the step
    float m_time = 0;          // s
    float m_perSecond = 0;     // 1/s, the inverse as Bullet has it
    float m_shift = 0;         // s², of the acceleration: see SubstepBody::afterPrediction()
    float m_supportShift = 0;  // s², the same of a node's support
};

// Boxes around a kept cloth in its coming step, m: of its nodes' positions, of the ends that Bullet predicts, and of
// those that substeps predict. They hold for the time and the gravity of the step before.
struct KeptBoxes
{
    float m_low[DRAPE_KEPT_BOXES][3], m_high[DRAPE_KEPT_BOXES][3];
    bool m_areFinite = false;
};
}  // namespace drape
