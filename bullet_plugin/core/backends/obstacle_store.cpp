#include "obstacle_store.h"

#include <algorithm>

namespace drape
{
namespace
{
constexpr std::size_t kPlaceGroup = 64;
// Maximum unchanged obstacle triangles between two changed ranges that are updated together with them. They cost at
// most as much as a range's launches, 0.1 ms; a triangle takes 0.2 us on two cores.
constexpr std::size_t kTrianglesBetweenCpu = 1 << 8;
constexpr std::size_t kTrianglesBetweenGpu = 1 << 14;

// Returns runs of changed obstacles. Unchanged ones between two changed ones are included if they cost less than
// separate launches.
template <typename Changed>
std::vector<SlotRange> runsOf(const Device& device, const MeshPool& obstacles, const Changed& changed)
{
    const std::size_t between = device.isGpu() ? kTrianglesBetweenGpu : kTrianglesBetweenCpu;
    std::vector<SlotRange> runs;
    for (std::size_t slot = 0; slot < obstacles.meshCount(); ++slot)
    {
        if (!changed(slot)) continue;
        const bool near = !runs.empty() &&
                          obstacles.begin(slot).m_triangle - obstacles.begin(runs.back().m_last).m_triangle <= between;
        if (near)
            runs.back().m_last = slot + 1;
        else
            runs.push_back({slot, slot + 1});
    }
    return runs;
}
}  // namespace

void ObstacleStore::create(Device& device, const ProgramLoader& load)
{
    m_place.create(device, load("scene/place_obstacles"));
    m_packing.create(device, load("scene/patch_pack"));
}

void ObstacleStore::forget()
{
    m_revision = 0;
    m_changes.forget();
    m_anyPosed = false;
}

void ObstacleStore::Geometry::demand(MeshOffsets count, MeshOffsets kept)
{
    m_positions.demand(3 * std::size_t(count.m_vertex), 3 * std::size_t(kept.m_vertex));
    m_vertexCones.demand(count.m_vertex, kept.m_vertex);
    m_edgeCones.demand(count.m_edge, kept.m_edge);
}

ObstacleLayout ObstacleStore::layoutOf(const Geometry& geometry) const
{
    return {geometry.m_positions.word(), geometry.m_vertexCones.word(), geometry.m_edgeCones.word(),
            &geometry == &m_world ? m_triangles.word() : 0};
}

void ObstacleStore::reserve(Device& device, const Scene& scene, std::size_t fresh)
{
    const MeshOffsets end = scene.m_obstacles.begin(scene.m_obstacles.meshCount());
    const MeshOffsets kept = scene.m_obstacles.begin(fresh);
    const bool begins = scene.m_anyPosed && !m_anyPosed;
    m_anyPosed = scene.m_anyPosed;
    m_world.demand(end, kept);
    m_triangles.demand(end.m_triangle, kept.m_triangle);
    m_world.m_arena.make(device);
    if (!m_anyPosed) return m_own.m_arena.release();
    m_own.demand(end, begins ? MeshOffsets{0, 0, 0} : kept);
    m_own.m_arena.make(device);
    if (!begins) return;
    // Every obstacle's own frame was the world's.
    m_own.m_positions.copy(device, m_world.m_positions, 3 * std::size_t(kept.m_vertex));
    m_own.m_vertexCones.copy(device, m_world.m_vertexCones, kept.m_vertex);
    m_own.m_edgeCones.copy(device, m_world.m_edgeCones, kept.m_edge);
}

void ObstacleStore::upload(Device& device, const Scene& scene, SlotRange slots)
{
    Geometry& geometry = scene.m_anyPosed ? m_own : m_world;
    const MeshOffsets first = scene.m_obstacles.begin(slots.m_first), last = scene.m_obstacles.begin(slots.m_last);
    geometry.m_positions.write(device, scene.m_obstaclePositions.data() + 3 * std::size_t(first.m_vertex),
                               3 * std::size_t(last.m_vertex - first.m_vertex), 3 * std::size_t(first.m_vertex));
    geometry.m_vertexCones.write(device, scene.m_vertexCones.data() + first.m_vertex, last.m_vertex - first.m_vertex,
                                 first.m_vertex);
    geometry.m_edgeCones.write(device, scene.m_edgeCones.data() + first.m_edge, last.m_edge - first.m_edge,
                               first.m_edge);
}

void ObstacleStore::enqueuePlacing(Device& device, const Scene& scene, SlotRange slots)
{
    const MeshOffsets first = scene.m_obstacles.begin(slots.m_first), last = scene.m_obstacles.begin(slots.m_last);
    const PlaceValues values = {layoutOf(m_own),
                                layoutOf(m_world),
                                cl_uint(scene.m_places.size()),
                                first.m_vertex,
                                last.m_vertex - first.m_vertex,
                                first.m_edge,
                                last.m_edge - first.m_edge};
    m_place.launch(device, values.m_vertexCount + values.m_edgeCount, kPlaceGroup, values, m_places, m_own.m_arena,
                   m_world.m_arena);
}

std::vector<SlotRange> ObstacleStore::place(Device& device, const Scene& scene, std::size_t fresh)
{
    const MeshPool& pool = scene.m_obstacles;
    m_changes.update(scene, fresh);
    for (const SlotRange& run : runsOf(device, pool, [&](std::size_t slot) { return m_changes.reshaped(slot); }))
        upload(device, scene, run);
    const std::vector<SlotRange> runs = runsOf(device, pool, [&](std::size_t slot) { return m_changes.moved(slot); });
    if (scene.m_anyPosed && !runs.empty())
    {
        m_places.assign(device, m_changes.places());
        for (const SlotRange& run : runs)
            enqueuePlacing(device, scene, run);
    }
    return runs;
}

void ObstacleStore::update(Device& device, const Scene& scene)
{
    const MeshPool& pool = scene.m_obstacles;
    const bool anew = m_revision != pool.revision();
    if (!anew && !m_changes.any(scene)) return;
    const std::size_t fresh = anew ? pool.firstSince(m_revision) : pool.meshCount();
    m_revision = pool.revision();
    reserve(device, scene, fresh);
    if (anew)
    {
        m_triangles.append(device, pool.triangles(), pool.begin(fresh).m_triangle);
        m_packing.setTopology(device, pool, fresh);
    }
    const std::vector<SlotRange> runs = place(device, scene, fresh);
    m_packing.pack(device, {fresh, pool.meshCount()}, obstacles());
    for (const SlotRange& run : runs)
        m_packing.pack(device, {run.m_first, std::min(run.m_last, fresh)}, obstacles());
    // Releases data that only packing reads, once resting obstacles are packed. Obstacles whose positions change
    // later keep it from then on.
    if (anew && !scene.m_anyPosed) m_packing.releasePacking();
}
}  // namespace drape
