// A scene's data on a device as the stages take it: buffers, and where each array is (kernels/shared/arenas.h).
#pragma once

#include "bullet_plugin/core/device/buffer_view.h"
#include "kernels/shared/arenas.h"
#include "kernels/shared/motion.h"

namespace drape
{
struct ClothBuffers
{
    BufferView<float> m_nodes;
    BufferView<ClothWord> m_topology;
    ClothLayout m_layout;
};

struct ObstacleBuffers
{
    BufferView<ObstacleWord> m_geometry;
    ObstacleLayout m_layout;
};

struct PatchBuffers
{
    BufferView<PatchWord> m_patches;
    PatchLayout m_layout;
    std::size_t m_count;
};

// The pairs of a step. radius: m, per cloth, negative for cloths outside the step; thickness: m, cloths × obstacles,
// negative for untested pairs; motions: of the moving obstacles, in the order of slots.
struct PairBuffers
{
    BufferView<float> m_radius;
    BufferView<float> m_thickness;
    BufferView<ObstacleMotion> m_motions;
    std::size_t m_motionCount;
    std::size_t m_obstacleMeshes;
};
}  // namespace drape
