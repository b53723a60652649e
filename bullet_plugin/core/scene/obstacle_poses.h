// Computes an obstacle's frames at a step's start and end, and the records that the step reads.
//
// Input: poses and the mesh's box. Output: records of kernels/shared/motion.h. Everything is computed in double and
// rounded once; boxes are padded for the rounding of positions that are placed in float. Host only, O(1).
#pragma once

#include <array>

#include "kernels/shared/motion.h"

namespace drape
{
using Pose = std::array<float, DRAPE_MAP_FLOATS>;  // three rows of three factors and a shift, m

struct MeshBox
{
    float m_low[3], m_high[3];  // m; low above high when empty
};

struct ObstaclePoses
{
    bool m_posed = false;  // false: positions are the world's
    Pose m_start = {}, m_end = {};

    bool moves() const { return m_posed && m_start != m_end; }
};

// Returns the box of a mesh at a pose; own: box in the mesh's frame.
MeshBox placedBox(const Pose& pose, const MeshBox& own);

// Returns the record of a moving obstacle. A start pose without an inverse gives a map that is not finite, and no
// contacts.
ObstacleMotion makeMotion(const ObstaclePoses& poses, const MeshBox& own, std::uint32_t slot);
}  // namespace drape
