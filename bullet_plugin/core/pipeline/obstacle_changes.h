// Which obstacles a back end has to bring up to date: what it brought last is remembered, and held against the scene.
#pragma once

#include <cstdint>
#include <vector>

#include "step.h"

namespace drape
{
class ObstacleChanges
{
public:
    // Whether positions or places may have changed since take(); of meshes that came or went revisions tell.
    bool any(const Scene& scene) const
    {
        return m_motion != scene.m_obstacleMotion || m_placing != scene.m_obstaclePlacing;
    }
    // Compares, and remembers the scene. From slot `fresh` on everything is new.
    void take(const Scene& scene, std::size_t fresh);
    void forget() { *this = ObstacleChanges(); }

    // By the last take(): whether the obstacle has other positions in its own frame, or also another place.
    bool given(std::size_t slot) const { return m_changes[slot] == Change::Given; }
    bool moved(std::size_t slot) const { return m_changes[slot] != Change::None; }
    // As taken; they stay where they are until the next take().
    const std::vector<ObstaclePlace>& places() const { return m_places; }

private:
    enum class Change : std::uint8_t
    {
        None,
        Place,
        Given
    };

    std::uint32_t m_motion = 0, m_placing = 0;
    std::vector<ObstaclePlace> m_places;
    std::vector<Change> m_changes;  // per slot
};
}  // namespace drape
