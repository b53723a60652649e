// A triangle mesh as Bullet's kinematic body, with the arrays that its shape reads.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "btBulletDynamicsCommon.h"
#include "drape/cloth_records.h"

namespace drape
{
class ObstacleBody
{
public:
    // Throws InvalidInput if a number is out of its range, an array is missing or an index is out of range.
    static void check(const ObstacleDescription& obstacle);

    // The description has been checked.
    explicit ObstacleBody(const ObstacleDescription& obstacle);

    // Moves the body, with its interpolation transform if it is placed there at once. rotation: of any length but 0.
    void setPose(const double position[3], const double rotation[4], bool teleport);
    void setVertices(const float* positions);

    std::size_t vertexCount() const { return m_positions.size() / 3; }
    std::size_t triangleCount() const { return m_triangles.size() / 3; }
    btBvhTriangleMeshShape& shape() { return *m_shape; }
    btRigidBody& body() { return *m_body; }

private:
    std::vector<float> m_positions;
    std::vector<std::int32_t> m_triangles;
    btTriangleIndexVertexArray m_arrays;
    std::unique_ptr<btBvhTriangleMeshShape> m_shape;
    std::unique_ptr<btRigidBody> m_body;
};

// Throws InvalidInput if the values are not finite or the rotation has no length.
void requirePose(const double position[3], const double rotation[4]);
}  // namespace drape
