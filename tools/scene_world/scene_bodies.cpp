#include "tools/scene_world/scene_bodies.h"

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "scenes/mesh_volume.h"

namespace drape
{
namespace
{
// Appends springs with their lengths in `rest`.
void addSprings(btSoftBody& body, const std::vector<float>& rest, const std::vector<std::int32_t>& springs,
                btSoftBody::Material* material)
{
    for (std::size_t i = 0; i < springs.size(); i += 2)
    {
        body.appendLink(springs[i], springs[i + 1], material);
        const btVector3 way = placeOf(rest, std::size_t(springs[i])) - placeOf(rest, std::size_t(springs[i + 1]));
        btSoftBody::Link& link = body.m_links[body.m_links.size() - 1];
        link.m_rl = way.length();
        link.m_c1 = link.m_rl * link.m_rl;
    }
}

void configure(btSoftBody& body, const ClothScene& scene, const SceneCloth& cloth)
{
    const double margin = cloth.m_margin < 0 ? 0.5 * scene.m_thickness : cloth.m_margin;
    body.getCollisionShape()->setMargin(btScalar(margin));
    body.m_cfg.piterations = scene.m_iterations;
    body.m_cfg.kDP = btScalar(cloth.m_material.m_damping);
    body.m_cfg.kDF = btScalar(cloth.m_material.m_friction);
    body.m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
}

std::unique_ptr<btTriangleIndexVertexArray> arraysOf(const TriangleMesh& mesh)
{
    btIndexedMesh part;
    part.m_numTriangles = int(mesh.triangleCount());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(mesh.m_triangles.data());
    part.m_triangleIndexStride = 3 * sizeof(std::int32_t);
    part.m_numVertices = int(mesh.vertexCount());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(mesh.m_positions.data());
    part.m_vertexStride = 3 * sizeof(float);
    part.m_vertexType = PHY_FLOAT;
    auto arrays = std::make_unique<btTriangleIndexVertexArray>();
    arrays->addIndexedMesh(part, PHY_INTEGER);
    return arrays;
}

std::unique_ptr<btCollisionShape> meshShape(const SceneObstacle& obstacle, double margin,
                                            std::unique_ptr<btTriangleIndexVertexArray>& arrays)
{
    arrays = arraysOf(obstacle.m_mesh);
    std::unique_ptr<btCollisionShape> shape;
    if (obstacle.m_mass > 0)
        shape = std::make_unique<btGImpactMeshShape>(arrays.get());
    else
        shape = std::make_unique<btBvhTriangleMeshShape>(arrays.get(), true);
    shape->setMargin(btScalar(margin));
    if (obstacle.m_mass > 0) static_cast<btGImpactMeshShape&>(*shape).updateBound();
    return shape;
}

// A height field's origin is halfway between its limits, which are made to lie around 0.
std::unique_ptr<btCollisionShape> heightFieldShape(const ObstacleShape& field)
{
    float most = 0;
    for (const float height : field.m_heights)
        most = std::max(most, std::abs(height));
    const btScalar limit = std::max(btScalar(most), btScalar(1e-3));
    auto shape = std::make_unique<btHeightfieldTerrainShape>(field.m_columns, field.m_rows, field.m_heights.data(),
                                                             btScalar(1), -limit, limit, 1, PHY_FLOAT, false);
    shape->setLocalScaling(btVector3(btScalar(field.m_cell), 1, btScalar(field.m_cell)));
    return shape;
}

// The margin of a box or cylinder lies within its dimensions; Bullet needs some core beside it.
double marginWithin(double margin, double smallest)
{
    return std::min(margin, 0.25 * smallest);
}

std::unique_ptr<btCollisionShape> primitiveShape(const ObstacleShape& shape, double margin)
{
    using Kind = ObstacleShape::Kind;
    const auto radius = btScalar(shape.m_radius), half = btScalar(0.5 * shape.m_length);
    const Vector3& size = shape.m_size;
    std::unique_ptr<btCollisionShape> made;
    switch (shape.m_kind)
    {
        case Kind::Sphere:
            return std::make_unique<btSphereShape>(radius);
        case Kind::Capsule:
            return std::make_unique<btCapsuleShape>(radius, 2 * half);
        case Kind::Box:
            made = std::make_unique<btBoxShape>(vectorOf(0.5 * size));
            made->setMargin(btScalar(marginWithin(margin, std::min({size.x, size.y, size.z}))));
            return made;
        case Kind::Cylinder:
            made = std::make_unique<btCylinderShape>(btVector3(radius, half, radius));
            made->setMargin(btScalar(marginWithin(margin, std::min(2 * shape.m_radius, shape.m_length))));
            return made;
        case Kind::Plane:
            made = std::make_unique<btStaticPlaneShape>(vectorOf(shape.m_normal), btScalar(shape.m_offset));
            break;
        case Kind::HeightField:
            made = heightFieldShape(shape);
            break;
        case Kind::Mesh:
            break;
    }
    made->setMargin(btScalar(margin));
    return made;
}

void place(btRigidBody& body, const btTransform& pose)
{
    body.setWorldTransform(pose);
    body.setInterpolationWorldTransform(pose);
}
// Bending springs of ropes are no solid links, or the rope could not bend around an edge.
void markBending(btSoftBody& body, const SceneCloth& cloth)
{
    if (!cloth.isRope()) return;
    for (int i = int(cloth.m_rest.m_edgeSprings.size() / 2); i < body.m_links.size(); ++i)
        body.m_links[i].m_bbending = -1;  // a field of one bit
}

// Sets pressure and volume. btSoftBody::setPose() would take the springs' lengths from where the nodes are.
void setVolume(btSoftBody& body, const SceneCloth& cloth, const std::vector<float>& rest)
{
    body.m_cfg.kPR = btScalar(cloth.m_pressure);
    body.m_cfg.kVC = btScalar(cloth.m_volumeConservation);
    if (!(cloth.m_volumeConservation > 0)) return;
    body.m_pose.m_bvolume = true;
    body.m_pose.m_volume = btScalar(volumeOf({rest, cloth.m_rest.m_mesh.m_triangles}));
}
}  // namespace

void updateButLengths(btSoftBody& body)
{
    body.updateLinkConstants();
    body.updateArea();
    body.m_bUpdateRtCst = false;
}

btTransform poseOf(const SceneObstacle& obstacle, double time)
{
    if (!obstacle.m_poseAt) return btTransform::getIdentity();
    const ScenePose pose = obstacle.m_poseAt(time);
    return btTransform(btQuaternion(vectorOf(pose.m_axis), btScalar(pose.m_angle)), vectorOf(pose.m_shift));
}

std::unique_ptr<btSoftBody> makeClothBody(btSoftBodyWorldInfo& info, const ClothScene& scene, const SceneCloth& cloth)
{
    const std::size_t count = cloth.nodeCount();
    std::vector<btVector3> places(count);
    std::vector<btScalar> masses(count);
    for (std::size_t i = 0; i < count; ++i)
    {
        places[i] = placeOf(cloth.m_positions, i);
        masses[i] = btScalar(cloth.massOf(i));
    }
    auto owned = std::make_unique<btSoftBody>(&info, int(count), places.data(), masses.data());
    btSoftBody& body = *owned;
    const std::vector<std::int32_t>& triangles = cloth.m_rest.m_mesh.m_triangles;
    for (std::size_t t = 0; t < triangles.size(); t += 3)
        body.appendFace(triangles[t], triangles[t + 1], triangles[t + 2]);
    btSoftBody::Material* const edges = body.m_materials[0];
    edges->m_kLST = btScalar(cloth.m_material.m_stretch);
    btSoftBody::Material* const bending = body.appendMaterial();
    bending->m_kLST = btScalar(cloth.m_material.m_bending);
    const std::vector<float>& rest = cloth.m_restsAtStart ? cloth.m_positions : cloth.m_rest.m_mesh.m_positions;
    addSprings(body, rest, cloth.m_rest.m_edgeSprings, edges);
    addSprings(body, rest, cloth.m_rest.m_bendingSprings, bending);
    markBending(body, cloth);
    for (const ScenePins& pins : cloth.m_pins)
        for (const int node : pins.m_nodes)
            body.setMass(node, 0);
    updateButLengths(body);
    configure(body, scene, cloth);
    setVolume(body, cloth, rest);
    if (length(cloth.m_velocity) > 0) body.setVelocity(vectorOf(cloth.m_velocity));
    return owned;
}

ObstacleBody makeObstacleBody(const ClothScene& scene, const SceneObstacle& obstacle)
{
    const double margin = obstacle.m_margin < 0 ? 0.5 * scene.m_thickness : obstacle.m_margin;
    ObstacleBody own;
    own.m_shape = obstacle.m_shape.m_kind == ObstacleShape::Kind::Mesh ? meshShape(obstacle, margin, own.m_arrays)
                                                                       : primitiveShape(obstacle.m_shape, margin);
    btVector3 inertia(0, 0, 0);
    const auto mass = btScalar(obstacle.m_mass);
    if (mass > 0) own.m_shape->calculateLocalInertia(mass, inertia);
    own.m_body = std::make_unique<btRigidBody>(mass, nullptr, own.m_shape.get(), inertia);
    btRigidBody& body = *own.m_body;
    if (mass > 0)
    {
        body.setLinearVelocity(vectorOf(obstacle.m_velocity));
        body.setAngularVelocity(vectorOf(obstacle.m_angularVelocity));
    }
    if (!(mass > 0) && obstacle.m_moves) body.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    if (mass > 0 || obstacle.m_moves) body.setActivationState(DISABLE_DEACTIVATION);
    place(body, poseOf(obstacle, 0));
    body.setFriction(btScalar(obstacle.m_friction));
    return own;
}
}  // namespace drape
