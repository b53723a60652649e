// Determines which obstacles a back end must update: compares the state that it used last with the scene.
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_plugin/core/backends/step.h"

namespace drape
{
class ObstacleChanges
{
public:
    // Returns whether positions or poses may have changed since take(). Revisions report meshes that were added or
    // removed.
    bool any(const Scene& scene) const
    {
        return m_motion != scene.m_obstacleMotion || m_placing != scene.m_obstaclePlacing;
    }
    // Compares with the recorded scene and records the current one. Everything from slot `fresh` on is new.
    void take(const Scene& scene, std::size_t fresh);
    void forget() { *this = ObstacleChanges(); }

    // Changes found by the last take(): new positions in the obstacle's own frame, or also a new pose.
    bool given(std::size_t slot) const { return m_changes[slot] == Change::Given; }
    bool moved(std::size_t slot) const { return m_changes[slot] != Change::None; }
    // Returns the poses as recorded; they stay in place until the next take().
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
