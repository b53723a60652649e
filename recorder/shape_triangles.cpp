#include "recorder/shape_triangles.h"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>
#include <utility>

#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/CollisionShapes/btConcaveShape.h"
#include "bullet_plugin/adapter/mirrors/convex_reader.h"

namespace drape
{
namespace
{
constexpr btScalar kLargest = 100;  // m, from the shape's origin to the end of a plane

class TriangleCollector : public btTriangleCallback
{
public:
    ShapeTriangles m_result;
    btTransform m_pose = btTransform::getIdentity();

    void processTriangle(btVector3* triangle, int, int) override { add(triangle[0], triangle[1], triangle[2]); }

    void add(const btVector3& a, const btVector3& b, const btVector3& c)
    {
        const std::int32_t corners[3] = {vertex(a), vertex(b), vertex(c)};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
        m_result.m_triangles.insert(m_result.m_triangles.end(), corners, corners + 3);
    }

private:
    std::int32_t vertex(const btVector3& local)
    {
        const btVector3 point = m_pose * local;
        const std::array<float, 3> key = {float(point.x()), float(point.y()), float(point.z())};
        const auto [found, added] = m_numbers.emplace(key, static_cast<std::int32_t>(m_numbers.size()));
        if (added) m_result.m_vertices.insert(m_result.m_vertices.end(), key.begin(), key.end());
        return found->second;
    }

    std::map<std::array<float, 3>, std::int32_t> m_numbers;
};

void collect(const btCollisionShape& shape, const btTransform& pose, TriangleCollector& collector)
{
    if (shape.isCompound())
    {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < compound.getNumChildShapes(); ++i)
            collect(*compound.getChildShape(i), pose * compound.getChildTransform(i), collector);
        return;
    }
    collector.m_pose = pose;
    const btVector3 far(kLargest, kLargest, kLargest);
    if (shape.isConcave()) static_cast<const btConcaveShape&>(shape).processAllTriangles(&collector, -far, far);
    if (!isConvexShape(shape)) return;
    std::vector<btVector3> points;
    std::vector<std::int32_t> triangles;
    readConvex(static_cast<const btConvexShape&>(shape), points, triangles);
    for (std::size_t i = 0; i < triangles.size(); i += 3)
        collector.add(points[std::size_t(triangles[i])], points[std::size_t(triangles[i + 1])],
                      points[std::size_t(triangles[i + 2])]);
}
}  // namespace

bool ShapeTriangles::closed() const
{
    std::unordered_map<std::uint64_t, std::pair<int, int>> edges;  // triangles on either side
    for (std::size_t i = 0; i < m_triangles.size(); ++i)
    {
        const auto from = static_cast<std::uint64_t>(m_triangles[i]);
        const auto to = static_cast<std::uint64_t>(m_triangles[i % 3 == 2 ? i - 2 : i + 1]);
        const std::uint64_t key = std::min(from, to) << 32 | std::max(from, to);
        ++(from < to ? edges[key].first : edges[key].second);
    }
    return !edges.empty() && std::all_of(edges.begin(), edges.end(),
                                         [](const auto& edge) { return edge.second == std::pair<int, int>(1, 1); });
}

ShapeTriangles trianglesOf(const btCollisionShape& shape)
{
    TriangleCollector collector;
    collect(shape, btTransform::getIdentity(), collector);
    return std::move(collector.m_result);
}
}  // namespace drape
