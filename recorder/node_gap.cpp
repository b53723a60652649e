#include "recorder/node_gap.h"

#include <cmath>

#include "BulletCollision/CollisionShapes/btCompoundShape.h"
#include "BulletCollision/CollisionShapes/btConcaveShape.h"
#include "bullet_plugin/adapter/vectors.h"
#include "kernels/lib/geometry/closest.h"

namespace drape
{
namespace
{
constexpr float kSame = 1e-4f;  // share of the distance within which triangles count as equally near

class NearestTriangle : public btTriangleCallback
{
public:
    NearestTriangle(const btVector3& point, float reach) : m_point(vec3Of(point)), m_nearest(reach) {}

    void processTriangle(btVector3* triangle, int, int) override
    {
        const Vec3 a = vec3Of(triangle[0]), b = vec3Of(triangle[1]), c = vec3Of(triangle[2]);
        const Vec3 weights = closestOnTriangle(m_point, a, b, c);
        const Vec3 nearest = vec3AddScaled(vec3AddScaled(vec3Scale(a, weights.x), b, weights.y), c, weights.z);
        const Vec3 towards = vec3Sub(m_point, nearest);
        const float distance = vec3Length(towards);
        if (!(distance <= m_nearest * (1 + kSame))) return;
        const Vec3 normal = vec3Cross(vec3Sub(b, a), vec3Sub(c, a));
        const float facing = vec3Dot(towards, normal) / std::fmax(vec3Length(normal), 1e-30f);
        const bool nearer = distance < m_nearest * (1 - kSame);
        if (nearer || std::fabs(facing) > std::fabs(m_facing)) m_facing = facing;
        m_nearest = std::fmin(m_nearest, distance);
        m_found = true;
    }

    // Returns the distance, with the sign of the side if the shape is closed.
    double distance(bool closed) const
    {
        if (!m_found) return std::numeric_limits<double>::infinity();
        return closed && m_facing < 0 ? -double(m_nearest) : double(m_nearest);
    }

private:
    Vec3 m_point;
    float m_nearest, m_facing = 0;
    bool m_found = false;
};

void look(const btCollisionShape& shape, const btVector3& point, btScalar reach, double& nearest, bool closed)
{
    if (shape.isCompound())
    {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        for (int i = 0; i < compound.getNumChildShapes(); ++i)
            look(*compound.getChildShape(i), compound.getChildTransform(i).invXform(point), reach, nearest, closed);
    }
    if (!shape.isConcave()) return;
    const btVector3 around(reach, reach, reach);
    NearestTriangle triangles(point, float(reach));
    static_cast<const btConcaveShape&>(shape).processAllTriangles(&triangles, point - around, point + around);
    const double distance = triangles.distance(closed);
    if (std::fabs(distance) < std::fabs(nearest)) nearest = distance;
}
}  // namespace

bool hasGaps(const btCollisionShape& shape)
{
    if (!shape.isCompound()) return shape.isConcave();
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
        if (hasGaps(*compound.getChildShape(i))) return true;
    return false;
}

double distanceTo(const GapObstacle& obstacle, const btVector3& point, double reach)
{
    const btVector3 local = obstacle.m_object->getWorldTransform().invXform(point);
    double nearest = std::numeric_limits<double>::infinity();
    look(*obstacle.m_object->getCollisionShape(), local, static_cast<btScalar>(reach), nearest, obstacle.m_closed);
    return nearest;
}
}  // namespace drape
