// The bodies of a scene (scenes/cloth_scene.h) as Bullet's: soft bodies for cloth, rigid bodies for obstacles.
#pragma once

#include <memory>

#include <BulletSoftBody/btSoftBody.h>
#include <btBulletCollisionCommon.h>
#include <btBulletDynamicsCommon.h>

#include "scenes/cloth_scene.h"

namespace drape
{
// A rigid body and what its shape refers to.
struct ObstacleBody
{
    std::unique_ptr<btTriangleIndexVertexArray> m_arrays;
    std::unique_ptr<btCollisionShape> m_shape;
    std::unique_ptr<btRigidBody> m_body;
};

// Makes a cloth with the scene's springs, masses and material. The cloth's springs have their lengths from the cloth at
// rest. Pinned nodes have no mass.
std::unique_ptr<btSoftBody> makeClothBody(btSoftBodyWorldInfo& info, const ClothScene& scene, const SceneCloth& cloth);

// Makes an obstacle, which refers to the scene's arrays: static, kinematic if the scene moves it, or dynamic if it has
// a mass.
ObstacleBody makeObstacleBody(const ClothScene& scene, const SceneObstacle& obstacle);

// Returns where an obstacle that the scene moves is.
btTransform poseOf(const SceneObstacle& obstacle, double time);

// Updates what depends on masses and materials. btSoftBody::updateConstants() would take the springs' lengths from
// where the nodes are.
void updateButLengths(btSoftBody& body);

inline btVector3 vectorOf(const Vector3& v)
{
    return btVector3(btScalar(v.x), btScalar(v.y), btScalar(v.z));
}

inline btVector3 placeOf(const std::vector<float>& positions, std::size_t node)
{
    return btVector3(positions[3 * node], positions[3 * node + 1], positions[3 * node + 2]);
}
}  // namespace drape
