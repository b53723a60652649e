#include "obstacle_changes.h"

#include <algorithm>
#include <cstring>

namespace drape
{
void ObstacleChanges::update(const Scene& scene, std::size_t fresh)
{
    const std::size_t count = scene.m_places.size();
    m_changes.assign(count, Change::None);
    fresh = std::min(fresh, m_places.size());
    for (std::size_t slot = 0; slot < count; ++slot)
    {
        if (slot >= fresh || scene.m_obstacles.mesh(slot).m_positionsRevision > m_positions)
            m_changes[slot] = Change::Reshaped;
        else if (std::memcmp(&scene.m_places[slot], &m_places[slot], sizeof(ObstaclePlace)) != 0)
            m_changes[slot] = Change::Moved;
    }
    m_places = scene.m_places;
    m_positions = scene.m_positionsRevision;
    m_poses = scene.m_posesRevision;
}
}  // namespace drape
