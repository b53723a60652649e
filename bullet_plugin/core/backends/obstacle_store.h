// A scene's obstacles on a device: topology, geometry in world coordinates joined as in the scene, and patches.
//
// If one obstacle has a pose, the geometry is also kept in the obstacles' own frames, and placed on the device. Cost:
// changed obstacles are uploaded, placed and packed; resting obstacles cost nothing.
#pragma once

#include <vector>

#include "bullet_plugin/core/scene/obstacle_changes.h"
#include "bullet_plugin/core/scene/patch_packing.h"

namespace drape
{
class ObstacleStore
{
public:
    void create(Device& device, const ProgramLoader& load);
    // Uploads the next scene from its first mesh on.
    void forget();

    // Updates the obstacles that were added or removed, or whose positions or poses changed. Returns after enqueueing.
    // The scene must stay unchanged until a wait for the device, and the device must have been waited for since the
    // last call.
    void update(Device& device, const Scene& scene);

    ObstacleBuffers obstacles() const { return {m_world.m_arena, layoutOf(m_world)}; }
    PatchBuffers patches() const { return m_packing.patches(); }

private:
    // Positions and cones of the obstacles in one frame.
    struct Geometry
    {
        explicit Geometry(const std::string& frame)
            : m_positions(m_arena, "obstacle positions" + frame),
              m_vertexCones(m_arena, "obstacle cones" + frame),
              m_edgeCones(m_arena, "obstacle cones" + frame)
        {
        }
        void demand(MeshOffsets count, MeshOffsets kept);

        Arena<ObstacleWord> m_arena;
        ArenaArray<float> m_positions;
        ArenaArray<NormalCone> m_vertexCones, m_edgeCones;
    };

    ObstacleLayout layoutOf(const Geometry& geometry) const;
    // Makes room for the scene's obstacles; keeps those before slot `fresh`.
    void reserve(Device& device, const Scene& scene, std::size_t fresh);
    void upload(Device& device, const Scene& scene, SlotRange slots);
    void enqueuePlacing(Device& device, const Scene& scene, SlotRange slots);
    // Uploads and places the obstacles from slot `fresh` on, and earlier ones that changed. Returns runs of the slots
    // whose world positions are new.
    std::vector<SlotRange> place(Device& device, const Scene& scene, std::size_t fresh);

    BoundKernel<kernels::placeObstacles> m_place;
    PatchPacking m_packing;
    std::uint32_t m_revision = 0;
    ObstacleChanges m_changes;
    bool m_anyPosed = false;  // at the last update
    Geometry m_world{""};
    ArenaArray<Triangle> m_triangles{m_world.m_arena, "obstacle triangles"};
    Geometry m_own{" in own frame"};  // only if an obstacle has a pose
    Buffer<ObstaclePlace> m_places{"obstacle places"};
};
}  // namespace drape
