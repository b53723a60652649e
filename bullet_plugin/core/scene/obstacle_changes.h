// Determines which obstacles a back end must update: compares the state that it used last with the scene.
#pragma once

#include <cstdint>
#include <vector>

#include "scene.h"

namespace drape
{
class ObstacleChanges
{
public:
    // Returns whether positions or poses may have changed since update(). Revisions report meshes that were added or
    // removed.
    bool any(const Scene& scene) const
    {
        return m_positions != scene.m_positionsRevision || m_poses != scene.m_posesRevision;
    }
    // Compares with the recorded scene and records the current one. Everything from slot `fresh` on is new.
    void update(const Scene& scene, std::size_t fresh);
    void forget() { *this = ObstacleChanges(); }

    // Return changes that the last update() found: new positions in the obstacle's own frame, or also a new pose.
    bool reshaped(std::size_t slot) const { return m_changes[slot] == Change::Reshaped; }
    bool moved(std::size_t slot) const { return m_changes[slot] != Change::None; }
    // Returns the poses as recorded; they stay in place until the next update().
    const std::vector<ObstaclePlace>& places() const { return m_places; }

private:
    enum class Change : std::uint8_t
    {
        None,
        Moved,
        Reshaped
    };

    std::uint32_t m_positions = 0, m_poses = 0;  // revisions
    std::vector<ObstaclePlace> m_places;
    std::vector<Change> m_changes;  // per slot
};
}  // namespace drape
