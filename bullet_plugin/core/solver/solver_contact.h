// One resolved contact, the input of contact sweeps and cuts. Lengths in metres, world frame. Gaps have the thickness
// subtracted: 0 is the resting distance, negative is too close.
#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/lib/rigid_motion.h"
#include "kernels/lib/vec3.h"

namespace drape
{
// An obstacle's motion in the step, as it carries points near it.
struct Carry
{
    const float* m_map = nullptr;    // rigid motion, three rows of rotation and shift; null if the obstacle rests
    const Vec3* m_starts = nullptr;  // by node of the cloth: its carried start, beside an obstacle whose vertices move;
                                     // null if m_map applies

    bool moves() const { return m_map || m_starts; }
    // Returns where the motion carries a point from the step's start.
    Vec3 point(Vec3 p) const { return m_map ? mapPoint(m_map, p) : p; }
    // Returns where the motion carries a node's start.
    Vec3 start(std::size_t node, Vec3 p) const { return m_starts ? m_starts[node] : point(p); }
};

struct SolverContact
{
    int m_nodes[3];      // -1 where unused
    float m_weights[3];  // sum 1
    Vec3 m_normal;       // unit, from the obstacle to the cloth
    Vec3 m_point;        // on the obstacle
    float m_thickness;
    float m_time;       // time of impact, 0 to 1; 1 if nothing was passed
    float m_startGap;   // at the step's start, relative to the obstacle
    float m_endGap;     // at the path's end
    float m_targetGap;  // least gap at the step's end: 0, or less when the step began too close
    float m_friction;
    Carry m_carry;
};

// Minimum share of the thickness that a step recovers of an initial depth. Only positions recover; no speed remains.
// A tenth quickly corrects cloth that came a little too near while it moved along a curved obstacle.
constexpr float kRecoveredShare = 0.1f;

// Returns the least gap at the step's end. A step that began too close recovers the share `hardness` of its depth
// (Bullet's kinetic contact hardness, kKHR), or kRecoveredShare of the thickness if that is more. Cloth that starts
// inside is therefore not thrown out.
inline float targetGap(float startGap, float hardness, float thickness)
{
    const float recovered = std::max(startGap + kRecoveredShare * thickness, startGap * (1 - hardness));
    return std::min(0.0f, recovered);
}
}  // namespace drape
