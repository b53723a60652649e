#include "bullet_plugin/adapter/cloth_world/obstacle_body.h"

#include <algorithm>

#include "bullet_plugin/adapter/cloth_world/input_checks.h"

namespace drape
{
namespace
{
btTransform poseOf(const double position[3], const double rotation[4])
{
    btQuaternion turn;
    turn.setValue(btScalar(rotation[0]), btScalar(rotation[1]), btScalar(rotation[2]), btScalar(rotation[3]));
    return btTransform(turn.normalized(),
                       btVector3(btScalar(position[0]), btScalar(position[1]), btScalar(position[2])));
}
}  // namespace

void requirePose(const double position[3], const double rotation[4])
{
    requireValues(position, 3, "position");
    requireValues(rotation, 4, "rotation");
    const double square =
        rotation[0] * rotation[0] + rotation[1] * rotation[1] + rotation[2] * rotation[2] + rotation[3] * rotation[3];
    requireNumber(square, 1e-12, 1e12, "rotation should be a quaternion of length 1");
}

void ObstacleBody::check(const ObstacleDescription& obstacle)
{
    MeshDescription mesh;
    mesh.m_positions = obstacle.m_positions;
    mesh.m_vertexCount = obstacle.m_vertexCount;
    mesh.m_triangles = obstacle.m_triangles;
    mesh.m_triangleCount = obstacle.m_triangleCount;
    require(obstacle.m_triangleCount > 0, "an obstacle has one triangle at least");
    requireMesh(mesh);
    requireNumber(obstacle.m_margin, 0, 1e30, "margin should be 0 or more");
    requireNumber(obstacle.m_friction, 0, 1e30, "friction should be 0 or more");
    requireNumber(obstacle.m_oneSided, 0, 1, "oneSided should be 0 or 1");
    requirePose(obstacle.m_position, obstacle.m_rotation);
}

ObstacleBody::ObstacleBody(const ObstacleDescription& obstacle)
    : m_positions(obstacle.m_positions, obstacle.m_positions + 3 * obstacle.m_vertexCount),
      m_triangles(obstacle.m_triangles, obstacle.m_triangles + 3 * obstacle.m_triangleCount)
{
    btIndexedMesh part;
    part.m_numTriangles = int(obstacle.m_triangleCount);
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(m_triangles.data());
    part.m_triangleIndexStride = 3 * sizeof(std::int32_t);
    part.m_numVertices = int(obstacle.m_vertexCount);
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(m_positions.data());
    part.m_vertexStride = 3 * sizeof(float);
    part.m_vertexType = PHY_FLOAT;
    m_arrays.addIndexedMesh(part, PHY_INTEGER);
    m_shape.reset(new btBvhTriangleMeshShape(&m_arrays, true));
    m_shape->setMargin(btScalar(obstacle.m_margin));
    m_body.reset(new btRigidBody(btScalar(0), nullptr, m_shape.get()));
    m_body->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    m_body->setActivationState(DISABLE_DEACTIVATION);
    m_body->setFriction(btScalar(obstacle.m_friction));
    setPose(obstacle.m_position, obstacle.m_rotation, true);
}

void ObstacleBody::setPose(const double position[3], const double rotation[4], bool teleport)
{
    m_body->setWorldTransform(poseOf(position, rotation));
    if (teleport) m_body->setInterpolationWorldTransform(m_body->getWorldTransform());
}

void ObstacleBody::setVertices(const float* positions)
{
    std::copy(positions, positions + m_positions.size(), m_positions.begin());
    btVector3 low(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY), high = -low;
    for (std::size_t i = 0; i < m_positions.size(); i += 3)
    {
        const btVector3 vertex(m_positions[i], m_positions[i + 1], m_positions[i + 2]);
        low.setMin(vertex);
        high.setMax(vertex);
    }
    m_shape->refitTree(low, high);
}
}  // namespace drape
