#include "bullet_plugin/adapter/mirrors/surface_reader.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>

#include "BulletCollision/BroadphaseCollision/btBroadphaseProxy.h"
#include "BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h"
#include "BulletCollision/CollisionShapes/btStaticPlaneShape.h"
#include "LinearMath/btAabbUtil2.h"

namespace drape
{
namespace
{
// Cells of a height field in one mesh at most: two million triangles. More are under cloth that has burst.
constexpr double kMostCells = 1 << 20;

// Samples of a box along each side.
constexpr int kSamples = 6;

bool isPlane(const btCollisionShape& shape)
{
    return shape.getShapeType() == STATIC_PLANE_PROXYTYPE;
}

const btStaticPlaneShape& planeOf(const btCollisionShape& shape)
{
    return static_cast<const btStaticPlaneShape&>(shape);
}

bool isFinite(const SurfaceBox& box)
{
    const btVector3 size = box.m_high - box.m_low;
    return std::isfinite(size.x() + size.y() + size.z());
}

// The points n x = d of the world.
struct WorldPlane
{
    WorldPlane(const btStaticPlaneShape& shape, const btTransform& pose)
        : m_normal(pose.getBasis() * shape.getPlaneNormal()),
          m_distance(shape.getPlaneConstant() + m_normal.dot(pose.getOrigin()))
    {
    }

    btVector3 m_normal;
    btScalar m_distance;  // m
};

// The grid of a height field, in its own frame. A triangle's part and index name its cell.
class Grid
{
public:
    explicit Grid(const btHeightfieldTerrainShape& field)
        : m_field(field), m_axes{field.getUpAxis() == 0 ? 1 : 0, field.getUpAxis() == 2 ? 1 : 2}
    {
        btVector3 next;
        field.getVertex(0, 0, m_first);
        field.getVertex(1, 1, next);
        m_cell = next - m_first;
        const btTransform own = btTransform::getIdentity();
        field.getAabb(own, m_bounds.m_low, m_bounds.m_high);
        for (int side = 0; side < 2; ++side)
            m_most[side] = int(std::round(place(m_bounds.m_high - margins(), side)));
    }

    // Returns the nearest grid point along one side; no further than the field reaches.
    int nearest(const btVector3& point, int side) const
    {
        const double at = std::round(place(point, side));
        return at > 0 ? int(std::min(at, double(m_most[side]))) : 0;
    }
    // Returns the number of cells under a box, at most, with those around it that Bullet adds.
    double countCells(const SurfaceBox& box) const
    {
        double count = 1;
        for (int side = 0; side < 2; ++side)
            count *= 4 + std::max(0, nearest(box.m_high, side) - nearest(box.m_low, side));
        return count;
    }
    std::uint64_t key(const btVector3& vertex) const
    {
        return std::uint64_t(nearest(vertex, 0)) << 32 | std::uint64_t(nearest(vertex, 1));
    }
    // Calls the callback for the triangles under the box.
    void forTriangles(SurfaceBox box, btTriangleCallback& callback) const
    {
        box.m_low[m_field.getUpAxis()] = -BT_LARGE_FLOAT;
        box.m_high[m_field.getUpAxis()] = BT_LARGE_FLOAT;
        m_field.processAllTriangles(&callback, box.m_low, box.m_high);
    }
    void sample(const SurfaceBox& box, std::vector<btVector3>& points) const
    {
        const auto at = [&](int i, int side)
        {
            const int first = nearest(box.m_low, side), last = nearest(box.m_high, side);
            return first + int(std::int64_t(last - first) * i / (kSamples - 1));
        };
        for (int i = 0; i < kSamples * kSamples; ++i)
        {
            points.emplace_back();
            m_field.getVertex(at(i % kSamples, 0), at(i / kSamples, 1), points.back());
        }
    }

private:
    btVector3 margins() const { return btVector3(1, 1, 1) * m_field.getMargin(); }
    double place(const btVector3& point, int side) const
    {
        const int axis = m_axes[side];
        return double(point[axis] - m_first[axis]) / double(m_cell[axis]);
    }

    const btHeightfieldTerrainShape& m_field;
    const int m_axes[2];  // along which the grid's x and j rise
    btVector3 m_first, m_cell;
    SurfaceBox m_bounds;
    int m_most[2];
};

struct CellTriangle
{
    int m_part, m_triangle;
    btVector3 m_corners[3];

    bool operator<(const CellTriangle& other) const
    {
        return std::tie(m_triangle, m_part) < std::tie(other.m_triangle, other.m_part);
    }
    bool operator==(const CellTriangle& other) const
    {
        return m_triangle == other.m_triangle && m_part == other.m_part;
    }
};

class ListTriangles : public btTriangleCallback
{
public:
    void processTriangle(btVector3* corners, int part, int triangle) override
    {
        m_found.push_back({part, triangle, {corners[0], corners[1], corners[2]}});
    }

    std::vector<CellTriangle> m_found;
};

void readField(const btHeightfieldTerrainShape& field, const std::vector<SurfaceBox>& boxes,
               const TriangleFilter& filter, std::vector<btVector3>& vertices, std::vector<std::int32_t>& triangles,
               TriangleNames* names)
{
    const Grid grid(field);
    ListTriangles list;
    for (const SurfaceBox& box : boxes)
        grid.forTriangles(box, list);
    std::sort(list.m_found.begin(), list.m_found.end());
    list.m_found.erase(std::unique(list.m_found.begin(), list.m_found.end()), list.m_found.end());
    std::unordered_map<std::uint64_t, std::int32_t> indices;
    for (const CellTriangle& triangle : list.m_found)
    {
        if (filter && !filter(triangle.m_part, triangle.m_triangle)) continue;
        if (names) names->add(triangle.m_part, triangle.m_triangle);
        for (const btVector3& corner : triangle.m_corners)
        {
            const auto added = indices.emplace(grid.key(corner), static_cast<std::int32_t>(vertices.size()));
            if (added.second) vertices.push_back(corner);
            triangles.push_back(added.first->second);
        }
    }
}

// Makes one triangle around the boxes' circle on the plane. In double: a level plane keeps its exact height.
void readPlane(const btStaticPlaneShape& plane, const std::vector<SurfaceBox>& boxes, std::vector<btVector3>& vertices,
               std::vector<std::int32_t>& triangles)
{
    if (boxes.empty()) return;
    SurfaceBox all = boxes[0];
    for (const SurfaceBox& box : boxes)
        all.add(box);
    const btVector3 &normal = plane.getPlaneNormal(), middle = (all.m_low + all.m_high) / 2;
    const double radius = double((all.m_high - all.m_low).length());
    btVector3 across, up;
    btPlaneSpace1(normal, across, up);
    double height = -double(plane.getPlaneConstant());
    for (int axis = 0; axis < 3; ++axis)
        height += double(normal[axis]) * double(middle[axis]);
    for (int corner = 0; corner < 3; ++corner)
    {
        const double angle = corner * (2 * M_PI / 3), x = 2 * radius * std::cos(angle),
                     y = 2 * radius * std::sin(angle);
        btVector3 vertex;
        for (int axis = 0; axis < 3; ++axis)
            vertex[axis] = btScalar(double(middle[axis]) - height * double(normal[axis]) + x * double(across[axis]) +
                                    y * double(up[axis]));
        vertices.push_back(vertex);
        triangles.push_back(corner);
    }
}

const btHeightfieldTerrainShape& fieldOf(const btCollisionShape& shape)
{
    return static_cast<const btHeightfieldTerrainShape&>(shape);
}
}  // namespace

SurfaceBox SurfaceBox::in(const btTransform& frame) const
{
    SurfaceBox box;
    btTransformAabb(m_low, m_high, 0, frame.inverse(), box.m_low, box.m_high);
    return box;
}

bool isSurfaceType(int shapeType)
{
    return shapeType == STATIC_PLANE_PROXYTYPE || shapeType == TERRAIN_SHAPE_PROXYTYPE;
}

bool isSurfaceShape(const btCollisionShape& shape)
{
    return isSurfaceType(shape.getShapeType());
}

bool surfaceMeets(const btCollisionShape& shape, const btTransform& pose, const SurfaceBox& box, btScalar reach)
{
    if (!isFinite(box)) return false;
    if (!isPlane(shape))
    {
        SurfaceBox own;
        shape.getAabb(pose, own.m_low, own.m_high);
        own.grow(btVector3(reach, reach, reach));
        return TestAabbAgainstAabb2(own.m_low, own.m_high, box.m_low, box.m_high);
    }
    const WorldPlane plane(planeOf(shape), pose);
    const btVector3 half = (box.m_high - box.m_low) / 2;
    return btFabs(plane.m_normal.dot(box.m_low + half) - plane.m_distance) <=
           plane.m_normal.absolute().dot(half) + reach;
}

SurfaceBox surfaceBounds(const btCollisionShape& shape, const btTransform& pose, const SurfaceBox& box)
{
    SurfaceBox bounds;
    shape.getAabb(pose, bounds.m_low, bounds.m_high);
    if (!isPlane(shape)) return bounds;
    const WorldPlane plane(planeOf(shape), pose);
    const btVector3 middle = (box.m_low + box.m_high) / 2, half = (box.m_high - box.m_low) / 2;
    for (int axis = 0; axis < 3; ++axis)
    {
        const btScalar own = plane.m_normal[axis];
        if (own == 0) continue;
        const btScalar others = plane.m_normal.dot(middle) - own * middle[axis];
        const btScalar spread = plane.m_normal.absolute().dot(half) - btFabs(own) * half[axis];
        const btScalar at = (plane.m_distance - others) / own, reach = spread / btFabs(own);
        bounds.m_low[axis] = btMax(bounds.m_low[axis], at - reach);
        bounds.m_high[axis] = btMin(bounds.m_high[axis], at + reach);
    }
    return bounds;
}

bool isSurfaceReadable(const btCollisionShape& shape, const std::vector<SurfaceBox>& boxes)
{
    if (isPlane(shape)) return true;
    const Grid grid(fieldOf(shape));
    double count = 0;
    for (const SurfaceBox& box : boxes)
        count += grid.countCells(box);
    return count <= kMostCells;
}

void readSurface(const btCollisionShape& shape, const std::vector<SurfaceBox>& boxes, const TriangleFilter& filter,
                 std::vector<btVector3>& vertices, std::vector<std::int32_t>& triangles, TriangleNames* names)
{
    if (!isPlane(shape)) return readField(fieldOf(shape), boxes, filter, vertices, triangles, names);
    readPlane(planeOf(shape), boxes, vertices, triangles);
    if (names && !triangles.empty()) names->add(0, 0);
}

void sampleSurface(const btCollisionShape& shape, const std::vector<SurfaceBox>& boxes, std::vector<btVector3>& points)
{
    if (isPlane(shape))
    {
        points.push_back(planeOf(shape).getPlaneNormal() * planeOf(shape).getPlaneConstant());
        return points.push_back(planeOf(shape).getPlaneNormal());
    }
    const Grid grid(fieldOf(shape));
    for (const SurfaceBox& box : boxes)
        grid.sample(box, points);
}
}  // namespace drape
