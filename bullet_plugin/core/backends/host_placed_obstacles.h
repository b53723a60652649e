// A scene's obstacles in world coordinates, on the host: the scene's own arrays if no obstacle has a pose.
#pragma once

#include <vector>

#include "bullet_plugin/core/scene/growing_arrays.h"
#include "bullet_plugin/core/scene/obstacle_changes.h"
#include "kernels/lib/narrow_phase/pair_contact.h"

namespace drape
{
class HostPlacedObstacles
{
public:
    // Returns whether positions or poses may have changed since update().
    bool changed(const Scene& scene) const { return m_changes.any(scene); }
    // Updates obstacles from slot `fresh` on, and earlier ones whose positions or poses changed.
    void update(const Scene& scene, std::size_t fresh);
    // Returns whether the last update() moved the obstacle.
    bool moved(std::size_t slot) const { return m_changes.moved(slot); }

    void giveBackRoom()
    {
        shrinkSparse(m_positions);
        shrinkSparse(m_vertexCones);
        shrinkSparse(m_edgeCones);
    }

    ObstacleView view(const Scene& scene) const;

private:
    void place(const Scene& scene);

    ObstacleChanges m_changes;
    std::vector<float> m_positions;
    std::vector<NormalCone> m_vertexCones, m_edgeCones;
};
}  // namespace drape
