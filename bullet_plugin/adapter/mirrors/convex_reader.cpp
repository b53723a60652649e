#include "bullet_plugin/adapter/mirrors/convex_reader.h"

#include <algorithm>

#include "BulletCollision/BroadphaseCollision/btBroadphaseProxy.h"
#include "BulletCollision/CollisionShapes/btCapsuleShape.h"
#include "BulletCollision/CollisionShapes/btConeShape.h"
#include "BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h"
#include "BulletCollision/CollisionShapes/btCylinderShape.h"
#include "BulletCollision/CollisionShapes/btPolyhedralConvexShape.h"
#include "BulletCollision/CollisionShapes/btStridingMeshInterface.h"
#include "BulletCollision/CollisionShapes/btTriangleCallback.h"
#include "LinearMath/btConvexHullComputer.h"

namespace drape
{
namespace
{
// Meridians of a round shape, and circles of latitude between its poles.
constexpr int kMeridians = 32, kCircles = 15;

class ListCorners : public btInternalTriangleIndexCallback
{
public:
    explicit ListCorners(std::vector<btVector3>& corners) : m_corners(corners) {}
    void internalProcessTriangleIndex(btVector3* corners, int, int) override
    {
        m_corners.insert(m_corners.end(), corners, corners + 3);
    }

private:
    std::vector<btVector3>& m_corners;
};

int axisOf(const btConvexShape& shape)
{
    switch (shape.getShapeType())
    {
        case CAPSULE_SHAPE_PROXYTYPE:
            return static_cast<const btCapsuleShape&>(shape).getUpAxis();
        case CYLINDER_SHAPE_PROXYTYPE:
            return static_cast<const btCylinderShape&>(shape).getUpAxis();
        case CONE_SHAPE_PROXYTYPE:
            return static_cast<const btConeShape&>(shape).getConeUpIndex();
        default:
            return 1;
    }
}

// Lists the points of a round shape that lie farthest in directions around its axis.
void listRound(const btConvexShape& shape, std::vector<btVector3>& points)
{
    const int axis = axisOf(shape);
    const bool isCone = shape.getShapeType() == CONE_SHAPE_PROXYTYPE;
    for (int circle = 0; circle <= kCircles + 1; ++circle)
    {
        const btScalar latitude = SIMD_PI * (btScalar(circle) / (kCircles + 1) - btScalar(0.5));
        const bool isPole = circle == 0 || circle == kCircles + 1;
        for (int side = 0; side < (isPole ? 1 : kMeridians); ++side)
        {
            const btScalar longitude = SIMD_2_PI * btScalar(side) / kMeridians, across = isPole ? 0 : btCos(latitude);
            btVector3 direction;
            direction[axis] = btSin(latitude);
            direction[(axis + 1) % 3] = across * btCos(longitude);
            direction[(axis + 2) % 3] = across * btSin(longitude);
            points.push_back(isCone ? shape.localGetSupportingVertexWithoutMargin(direction)
                                    : shape.localGetSupportingVertex(direction));
        }
    }
}
}  // namespace

bool isConvexType(int shapeType)
{
    return btBroadphaseProxy::isConvex(shapeType) && !btBroadphaseProxy::isConvex2d(shapeType);
}

bool isConvexShape(const btCollisionShape& shape)
{
    return isConvexType(shape.getShapeType());
}

btScalar convexMargin(const btCollisionShape& shape)
{
    const int type = shape.getShapeType();
    const bool isOutside =
        type == CONE_SHAPE_PROXYTYPE || (btBroadphaseProxy::isPolyhedral(type) && type != BOX_SHAPE_PROXYTYPE);
    return isOutside ? std::max(btScalar(0), shape.getMargin()) : btScalar(0);
}

void listSurface(const btConvexShape& shape, std::vector<btVector3>& points)
{
    const int type = shape.getShapeType();
    if (!btBroadphaseProxy::isPolyhedral(type)) return listRound(shape, points);
    if (type == CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE)
    {
        const auto& mesh = static_cast<const btConvexTriangleMeshShape&>(shape);
        const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
        const std::size_t first = points.size();
        ListCorners list(points);
        mesh.getMeshInterface()->InternalProcessAllTriangles(&list, -far, far);
        for (std::size_t i = first; i < points.size(); ++i)
            points[i] = points[i] * mesh.getLocalScaling();
        return;
    }
    const auto& polyhedron = static_cast<const btPolyhedralConvexShape&>(shape);
    for (int i = 0; i < polyhedron.getNumVertices(); ++i)
    {
        btVector3 vertex;
        polyhedron.getVertex(i, vertex);
        points.push_back(vertex);
    }
}

void readConvex(const btConvexShape& shape, std::vector<btVector3>& vertices, std::vector<std::int32_t>& triangles)
{
    std::vector<btVector3> points;
    listSurface(shape, points);
    vertices.clear();
    triangles.clear();
    if (points.empty()) return;
    btConvexHullComputer hull;
    hull.compute(points[0].m_floats, sizeof(btVector3), static_cast<int>(points.size()), 0, 0);
    // The hull's own vertices are rounded.
    for (int i = 0; i < hull.vertices.size(); ++i)
        vertices.push_back(points[static_cast<std::size_t>(hull.original_vertex_index[i])]);
    for (int face = 0; face < hull.faces.size(); ++face)
    {
        const btConvexHullComputer::Edge* edge = &hull.edges[hull.faces[face]];
        const int first = edge->getSourceVertex();
        int last = edge->getTargetVertex();
        for (edge = edge->getNextEdgeOfFace(); edge->getTargetVertex() != first; edge = edge->getNextEdgeOfFace())
        {
            triangles.insert(triangles.end(), {first, last, edge->getTargetVertex()});
            last = edge->getTargetVertex();
        }
    }
}
}  // namespace drape
