#include "placed_obstacles.h"

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

void PlacedObstacles::create(Device& device, const cl::Program& program)
{
    m_place.create(device, program, "placeObstacles");
}

void PlacedObstacles::forget()
{
    m_changes.forget();
    m_anyPosed = false;
}

void PlacedObstacles::reserve(Device& device, const Scene& scene, std::size_t fresh)
{
    const MeshOffsets end = scene.m_obstacles.begin(scene.m_obstacles.meshCount());
    const MeshOffsets kept = scene.m_obstacles.begin(fresh);
    const bool begins = scene.m_anyPosed && !m_anyPosed;
    m_anyPosed = scene.m_anyPosed;
    const auto extend = [&](auto& world, auto& own, std::size_t count, std::size_t keptCount)
    {
        world.extend(device, count, keptCount);
        if (!m_anyPosed)
            own.release();
        else if (begins)
            own.copy(device, world, count, keptCount);  // every obstacle's own frame was the world's
        else
            own.extend(device, count, keptCount);
    };
    extend(m_positions, m_ownPositions, 3 * std::size_t(end.m_vertex), 3 * std::size_t(kept.m_vertex));
    extend(m_vertexCones, m_ownVertexCones, end.m_vertex, kept.m_vertex);
    extend(m_edgeCones, m_ownEdgeCones, end.m_edge, kept.m_edge);
}

void PlacedObstacles::upload(Device& device, const Scene& scene, SlotRange slots)
{
    const bool own = scene.m_anyPosed;
    const MeshOffsets first = scene.m_obstacles.begin(slots.m_first), last = scene.m_obstacles.begin(slots.m_last);
    (own ? m_ownPositions : m_positions)
        .write(device, scene.m_obstaclePositions.data() + 3 * std::size_t(first.m_vertex),
               3 * std::size_t(last.m_vertex - first.m_vertex), 3 * std::size_t(first.m_vertex));
    (own ? m_ownVertexCones : m_vertexCones)
        .write(device, scene.m_vertexCones.data() + first.m_vertex, last.m_vertex - first.m_vertex, first.m_vertex);
    (own ? m_ownEdgeCones : m_edgeCones)
        .write(device, scene.m_edgeCones.data() + first.m_edge, last.m_edge - first.m_edge, first.m_edge);
}

void PlacedObstacles::enqueuePlacing(Device& device, const Scene& scene, SlotRange slots)
{
    const MeshOffsets first = scene.m_obstacles.begin(slots.m_first), last = scene.m_obstacles.begin(slots.m_last);
    m_place.launch(device, last.m_vertex - first.m_vertex + last.m_edge - first.m_edge, kPlaceGroup, m_places.handle(),
                   cl_uint(scene.m_places.size()), first.m_vertex, last.m_vertex - first.m_vertex, first.m_edge,
                   last.m_edge - first.m_edge, m_ownPositions.handle(), m_ownVertexCones.handle(),
                   m_ownEdgeCones.handle(), m_positions.handle(), m_vertexCones.handle(), m_edgeCones.handle());
}

std::vector<SlotRange> PlacedObstacles::update(Device& device, const Scene& scene, std::size_t fresh)
{
    const MeshPool& obstacles = scene.m_obstacles;
    m_changes.update(scene, fresh);
    reserve(device, scene, fresh);
    for (const SlotRange& run : runsOf(device, obstacles, [&](std::size_t slot) { return m_changes.reshaped(slot); }))
        upload(device, scene, run);
    const std::vector<SlotRange> runs =
        runsOf(device, obstacles, [&](std::size_t slot) { return m_changes.moved(slot); });
    if (scene.m_anyPosed && !runs.empty())
    {
        m_places.assign(device, m_changes.places());
        for (const SlotRange& run : runs)
            enqueuePlacing(device, scene, run);
    }
    return runs;
}
}  // namespace drape
