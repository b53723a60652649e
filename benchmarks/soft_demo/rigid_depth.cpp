#include "benchmarks/soft_demo/rigid_depth.h"

#include <algorithm>
#include <cmath>

namespace drape::bench
{
namespace
{
double depthInBox(const btBoxShape& box, const btVector3& point)
{
    const btVector3 within = box.getHalfExtentsWithMargin() - point.absolute();
    return double(within[within.minAxis()]);
}

// The axis is 0 for x, 1 for y, 2 for z.
double depthInCylinder(const btCylinderShape& cylinder, const btVector3& point)
{
    const int axis = cylinder.getUpAxis();
    const double along = double(cylinder.getHalfExtentsWithMargin()[axis] - std::abs(point[axis]));
    btVector3 across = point;
    across[axis] = 0;
    return std::min(along, double(cylinder.getRadius() - across.length()));
}

double depthInCapsule(const btCapsuleShape& capsule, const btVector3& point)
{
    const int axis = capsule.getUpAxis();
    btVector3 off = point;
    off[axis] -= std::clamp(point[axis], -capsule.getHalfHeight(), capsule.getHalfHeight());
    return double(capsule.getRadius() - off.length());
}
}  // namespace

double depthIn(const btCollisionShape& shape, const btTransform& pose, const btVector3& point)
{
    const btVector3 local = pose.invXform(point);
    switch (shape.getShapeType())
    {
        case BOX_SHAPE_PROXYTYPE:
            return std::max(0.0, depthInBox(static_cast<const btBoxShape&>(shape), local));
        case SPHERE_SHAPE_PROXYTYPE:
            return std::max(0.0, double(static_cast<const btSphereShape&>(shape).getRadius() - local.length()));
        case CYLINDER_SHAPE_PROXYTYPE:
            return std::max(0.0, depthInCylinder(static_cast<const btCylinderShape&>(shape), local));
        case CAPSULE_SHAPE_PROXYTYPE:
            return std::max(0.0, depthInCapsule(static_cast<const btCapsuleShape&>(shape), local));
        case COMPOUND_SHAPE_PROXYTYPE:
        {
            const auto& compound = static_cast<const btCompoundShape&>(shape);
            double deepest = 0;
            for (int i = 0; i < compound.getNumChildShapes(); ++i)
                deepest = std::max(deepest, depthIn(*compound.getChildShape(i), compound.getChildTransform(i), local));
            return deepest;
        }
        default:
            return 0;
    }
}
}  // namespace drape::bench
