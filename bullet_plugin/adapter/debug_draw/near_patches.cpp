#include "bullet_plugin/adapter/debug_draw/near_patches.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btAabbUtil2.h"
#include "bullet_plugin/adapter/mirrors/surface_reader.h"
#include "bullet_plugin/adapter/wiring/plugin_state.h"
#include "bullet_plugin/core/scene/patches.h"
#include "bullet_plugin/core/scene/scene.h"

namespace drape
{
namespace
{
constexpr std::uint32_t kWidth = 16;  // triangles of a patch

// An empty box.
SurfaceBox emptyBox()
{
    const btVector3 most(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
    return {most, -most};
}

void addPoint(SurfaceBox& box, const btVector3& point)
{
    box.m_low.setMin(point);
    box.m_high.setMax(point);
}

bool meet(const SurfaceBox& a, const SurfaceBox& b)
{
    return TestAabbAgainstAabb2(a.m_low, a.m_high, b.m_low, b.m_high);
}

// Returns the boxes of the cloth's faces, and of its links if it has none, grown by the reach, m.
std::vector<SurfaceBox> boxesOf(const btSoftBody& cloth, btScalar reach)
{
    std::vector<SurfaceBox> boxes;
    const auto add = [&](btSoftBody::Node* const* nodes, int count)
    {
        SurfaceBox box = emptyBox();
        for (int k = 0; k < count; ++k)
            addPoint(box, nodes[k]->m_x);
        box.grow(btVector3(reach, reach, reach));
        boxes.push_back(box);
    };
    for (int i = 0; i < cloth.m_faces.size(); ++i)
        add(cloth.m_faces[i].m_n, 3);
    for (int i = 0; i < cloth.m_links.size() && cloth.m_faces.size() == 0; ++i)
        add(cloth.m_links[i].m_n, 2);
    return boxes;
}

// Returns the mesh's triangles at the step's end, patch by patch.
std::vector<DrawnTriangle> trianglesOf(const PooledMesh& mesh)
{
    const ObstaclePoses& poses = mesh.m_poses;
    const auto place = [&](std::uint32_t vertex)
    {
        const float* const at = &mesh.m_positions[3 * std::size_t(vertex)];
        btVector3 point(at[0], at[1], at[2]);
        if (!poses.m_posed) return point;
        btVector3 moved;
        for (int row = 0; row < 3; ++row)
        {
            const float* const factors = &poses.m_end[std::size_t(4 * row)];
            moved[row] = factors[0] * point.x() + factors[1] * point.y() + factors[2] * point.z() + factors[3];
        }
        return moved;
    };
    std::vector<DrawnTriangle> triangles;
    for (const std::uint32_t triangle : clusteredOrder(mesh, mesh.m_positions.data(), kWidth))
    {
        const std::uint32_t* const corners = mesh.m_topology.m_triangles[triangle].m_vertices;
        triangles.push_back({place(corners[0]), place(corners[1]), place(corners[2])});
    }
    return triangles;
}
}  // namespace

std::vector<DrawnTriangle> nearTriangles(const PluginState& state)
{
    std::vector<DrawnTriangle> near;
    const MeshPool& obstacles = state.pipeline().scene().m_obstacles;
    std::unordered_map<MeshId, std::vector<const FoundPair*>> pairs;
    for (const FoundPair& pair : state.m_found.pairs())
        pairs[pair.m_obstacle].push_back(&pair);
    for (const FoundPair& first : state.m_found.pairs())
    {
        const auto found = pairs.find(first.m_obstacle);
        const std::size_t slot = obstacles.slot(first.m_obstacle);
        if (found == pairs.end() || slot == obstacles.meshCount()) continue;
        std::vector<SurfaceBox> boxes;
        SurfaceBox all = emptyBox();
        for (const FoundPair* pair : found->second)
        {
            const std::vector<SurfaceBox> own =
                boxesOf(*pair->m_body, btScalar(pair->m_thickness * (1 + state.settings().m_activation)));
            boxes.insert(boxes.end(), own.begin(), own.end());
        }
        pairs.erase(found);
        for (const SurfaceBox& box : boxes)
            all.add(box);
        const std::vector<DrawnTriangle> triangles = trianglesOf(obstacles.mesh(slot));
        for (std::size_t i = 0; i < triangles.size(); i += kWidth)
        {
            const std::size_t end = std::min(triangles.size(), i + kWidth);
            SurfaceBox patch = emptyBox();
            for (std::size_t k = i; k < end; ++k)
                for (const btVector3& corner : triangles[k])
                    addPoint(patch, corner);
            const auto isNear = [&](const SurfaceBox& box) { return meet(box, patch); };
            if (meet(all, patch) && std::any_of(boxes.begin(), boxes.end(), isNear))
                near.insert(near.end(), triangles.begin() + std::ptrdiff_t(i), triangles.begin() + std::ptrdiff_t(end));
        }
    }
    return near;
}
}  // namespace drape
