// A scene's obstacles on a device, in world coordinates: positions and normal cones, joined as in the scene.
//
// If one obstacle has a pose, all are also kept in their own frames, and placed on the device. Cost: changed
// obstacles are uploaded and placed; resting obstacles cost nothing.
#pragma once

#include <vector>

#include "bullet_plugin/core/device/program.h"
#include "bullet_plugin/core/scene/obstacle_changes.h"

namespace drape
{
class PlacedObstacles
{
public:
    void create(Device& device, const cl::Program& program);
    // Uploads the next scene from its first mesh on.
    void forget();

    // Returns whether positions or poses may have changed since update().
    bool changed(const Scene& scene) const { return m_changes.any(scene); }
    // Uploads and places the obstacles from slot `fresh` on, and earlier ones whose positions or poses changed.
    // Returns after enqueueing, with runs of the slots whose world positions are new. The scene must stay unchanged
    // until a wait for the device, and the device must have been waited for since the last call.
    std::vector<SlotRange> update(Device& device, const Scene& scene, std::size_t fresh);

    Buffer<float>& positions() { return m_positions; }
    Buffer<NormalCone>& vertexCones() { return m_vertexCones; }
    Buffer<NormalCone>& edgeCones() { return m_edgeCones; }

private:
    void reserve(Device& device, const Scene& scene, std::size_t fresh);
    void upload(Device& device, const Scene& scene, SlotRange slots);
    void enqueuePlacing(Device& device, const Scene& scene, SlotRange slots);

    Kernel m_place;
    ObstacleChanges m_changes;
    bool m_anyPosed = false;  // at the last update
    Buffer<float> m_positions{"obstacle positions"};
    Buffer<NormalCone> m_vertexCones{"obstacle cones"}, m_edgeCones{"obstacle cones"};
    // Data in the obstacles' own frames; only if one has a pose.
    Buffer<float> m_ownPositions{"obstacle positions in own frame"};
    Buffer<NormalCone> m_ownVertexCones{"obstacle cones in own frame"}, m_ownEdgeCones{"obstacle cones in own frame"};
    Buffer<ObstaclePlace> m_places{"obstacle places"};
};
}  // namespace drape
