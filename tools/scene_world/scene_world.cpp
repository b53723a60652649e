#include "tools/scene_world/scene_world.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>

namespace drape
{
namespace
{
constexpr double kGravity = 9.81;     // m/s²
constexpr int kNodesPerCluster = 16;  // Bullet's demos have 10 to 30

btVector3 vectorOf(const Vector3& v)
{
    return btVector3(btScalar(v.x), btScalar(v.y), btScalar(v.z));
}

btVector3 placeOf(const std::vector<float>& positions, std::size_t node)
{
    return btVector3(positions[3 * node], positions[3 * node + 1], positions[3 * node + 2]);
}

btTransform poseOf(const SceneObstacle& obstacle, double time)
{
    if (!obstacle.m_poseAt) return btTransform::getIdentity();
    const ScenePose pose = obstacle.m_poseAt(time);
    return btTransform(btQuaternion(vectorOf(pose.m_axis), btScalar(pose.m_angle)), vectorOf(pose.m_shift));
}

// Updates what depends on masses and materials. btSoftBody::updateConstants() would take the springs' lengths from
// where the nodes are.
void updateButLengths(btSoftBody& body)
{
    body.updateLinkConstants();
    body.updateArea();
    body.m_bUpdateRtCst = false;
}

// Appends springs with their lengths at rest.
void addSprings(btSoftBody& body, const SceneCloth& cloth, const std::vector<std::int32_t>& springs,
                btSoftBody::Material* material)
{
    const std::vector<float>& rest = cloth.m_rest.m_mesh.m_positions;
    for (std::size_t i = 0; i < springs.size(); i += 2)
    {
        body.appendLink(springs[i], springs[i + 1], material);
        const btVector3 way = placeOf(rest, std::size_t(springs[i])) - placeOf(rest, std::size_t(springs[i + 1]));
        btSoftBody::Link& link = body.m_links[body.m_links.size() - 1];
        link.m_rl = way.length();
        link.m_c1 = link.m_rl * link.m_rl;
    }
}
}  // namespace

SceneWorld::SceneWorld(const ClothScene& scene, std::unique_ptr<btCollisionConfiguration> configuration,
                       std::unique_ptr<btSoftBodySolver> solver)
    : m_scene(scene),
      m_configuration(std::move(configuration)),
      m_solver(std::move(solver)),
      m_dispatcher(m_configuration.get()),
      m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, m_configuration.get(), m_solver.get())
{
    const btVector3 gravity(0, btScalar(-kGravity), 0);
    m_world.setGravity(gravity);
    m_world.getWorldInfo().m_gravity = gravity;
    for (const SceneObstacle& obstacle : scene.m_obstacles)
        addObstacle(obstacle);
}

SceneWorld::SceneWorld(const ClothScene& scene, Plugin& plugin, const SceneWorldOptions& options)
    : SceneWorld(scene, std::make_unique<CollisionConfiguration>(plugin), std::make_unique<SoftBodySolver>(plugin))
{
    for (const SceneCloth& cloth : scene.m_cloths)
        plugin.setSelfCollision(addCloth(cloth, options), true);
}

SceneWorld::SceneWorld(const ClothScene& scene, BulletCollision collision, const SceneWorldOptions& options)
    : SceneWorld(scene, std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>(),
                 std::make_unique<btDefaultSoftBodySolver>())
{
    using Flags = btSoftBody::fCollision;
    for (const SceneCloth& cloth : scene.m_cloths)
    {
        btSoftBody& body = addCloth(cloth, options);
        body.setSelfCollision(true);
        if (collision == BulletCollision::NodesAndFaces) body.m_cfg.collisions |= Flags::VF_SS;
        if (collision != BulletCollision::Clusters) continue;
        body.m_cfg.collisions |= Flags::CL_SS | Flags::CL_SELF;
        body.generateClusters(std::max(2, body.m_nodes.size() / kNodesPerCluster));
    }
}

SceneWorld::~SceneWorld()
{
    for (const std::unique_ptr<btSoftBody>& cloth : m_cloths)
        m_world.removeSoftBody(cloth.get());
    for (const Obstacle& obstacle : m_obstacles)
        m_world.removeRigidBody(obstacle.m_body.get());
}

btSoftBody& SceneWorld::addCloth(const SceneCloth& cloth, const SceneWorldOptions& options)
{
    const std::size_t count = cloth.m_positions.size() / 3;
    std::vector<btVector3> places(count);
    for (std::size_t i = 0; i < count; ++i)
        places[i] = placeOf(cloth.m_positions, i);
    const std::vector<btScalar> masses(count, btScalar(cloth.m_mass / double(count)));
    m_cloths.push_back(std::make_unique<btSoftBody>(&m_world.getWorldInfo(), int(count), places.data(), masses.data()));
    btSoftBody& body = *m_cloths.back();
    const std::vector<std::int32_t>& triangles = cloth.m_rest.m_mesh.m_triangles;
    for (std::size_t t = 0; t < triangles.size(); t += 3)
        body.appendFace(triangles[t], triangles[t + 1], triangles[t + 2]);
    btSoftBody::Material* const edges = body.m_materials[0];
    edges->m_kLST = btScalar(options.m_stiffness);
    btSoftBody::Material* const bending = body.appendMaterial();
    bending->m_kLST = btScalar(options.m_bending);
    addSprings(body, cloth, cloth.m_rest.m_edgeSprings, edges);
    addSprings(body, cloth, cloth.m_rest.m_bendingSprings, bending);
    for (const int node : cloth.m_held)
        body.setMass(node, 0);
    updateButLengths(body);
    body.getCollisionShape()->setMargin(btScalar(0.5 * m_scene.m_thickness));
    body.m_cfg.piterations = options.m_iterations;
    body.m_cfg.kDP = btScalar(options.m_damping);
    body.m_cfg.kDF = btScalar(options.m_friction);
    body.m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
    m_world.addSoftBody(&body);
    return body;
}

void SceneWorld::addObstacle(const SceneObstacle& obstacle)
{
    Obstacle own;
    const TriangleMesh& mesh = obstacle.m_mesh;
    btIndexedMesh part;
    part.m_numTriangles = int(mesh.triangleCount());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(mesh.m_triangles.data());
    part.m_triangleIndexStride = 3 * sizeof(std::int32_t);
    part.m_numVertices = int(mesh.vertexCount());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(mesh.m_positions.data());
    part.m_vertexStride = 3 * sizeof(float);
    part.m_vertexType = PHY_FLOAT;
    own.m_arrays = std::make_unique<btTriangleIndexVertexArray>();
    own.m_arrays->addIndexedMesh(part, PHY_INTEGER);
    own.m_shape = std::make_unique<btBvhTriangleMeshShape>(own.m_arrays.get(), true);
    own.m_shape->setMargin(btScalar(0.5 * m_scene.m_thickness));
    own.m_body = std::make_unique<btRigidBody>(btScalar(0), nullptr, own.m_shape.get());
    own.m_body->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    own.m_body->setActivationState(DISABLE_DEACTIVATION);
    own.m_body->setWorldTransform(poseOf(obstacle, 0));
    own.m_body->setInterpolationWorldTransform(own.m_body->getWorldTransform());
    own.m_body->setFriction(1);
    m_world.addRigidBody(own.m_body.get());
    m_obstacles.push_back(std::move(own));
}

void SceneWorld::moveTo(double time)
{
    for (std::size_t i = 0; i < m_obstacles.size(); ++i)
        m_obstacles[i].m_body->setWorldTransform(poseOf(m_scene.m_obstacles[i], time));
    for (std::size_t i = 0; i < m_cloths.size() && m_scene.m_heldAt && !m_isReleased; ++i)
    {
        const SceneCloth& cloth = m_scene.m_cloths[i];
        for (const int node : cloth.m_held)
        {
            const float* const start = cloth.m_positions.data() + 3 * node;
            m_cloths[i]->m_nodes[node].m_x = vectorOf(m_scene.m_heldAt(i, {start[0], start[1], start[2]}, time));
        }
    }
}

double SceneWorld::step(double dt)
{
    m_time += dt;
    moveTo(m_time);
    const auto start = std::chrono::steady_clock::now();
    m_world.stepSimulation(btScalar(dt), 1, btScalar(dt));
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void SceneWorld::release()
{
    m_isReleased = true;
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
        for (const int node : m_scene.m_cloths[i].m_held)
            m_cloths[i]->setMass(node, btScalar(m_scene.m_cloths[i].m_mass / m_cloths[i]->m_nodes.size()));
    for (const std::unique_ptr<btSoftBody>& cloth : m_cloths)
        updateButLengths(*cloth);
}

TriangleMesh SceneWorld::mesh() const
{
    TriangleMesh all;
    std::int32_t first = 0;
    for (const SceneCloth& cloth : m_scene.m_cloths)
    {
        for (const std::int32_t node : cloth.m_rest.m_mesh.m_triangles)
            all.m_triangles.push_back(first + node);
        all.m_positions.insert(all.m_positions.end(), cloth.m_positions.begin(), cloth.m_positions.end());
        first += std::int32_t(cloth.m_positions.size() / 3);
    }
    return all;
}

const std::vector<float>& SceneWorld::positions()
{
    m_positions.clear();
    for (const std::unique_ptr<btSoftBody>& cloth : m_cloths)
        for (int i = 0; i < cloth->m_nodes.size(); ++i)
            for (int axis = 0; axis < 3; ++axis)
                m_positions.push_back(float(cloth->m_nodes[i].m_x[axis]));
    return m_positions;
}

void SceneWorld::addObstaclePositions(std::vector<float>& positions) const
{
    for (std::size_t i = 0; i < m_obstacles.size(); ++i)
    {
        const std::vector<float>& own = m_scene.m_obstacles[i].m_mesh.m_positions;
        for (std::size_t vertex = 0; vertex < own.size() / 3; ++vertex)
        {
            const btVector3 place = m_obstacles[i].m_body->getWorldTransform() * placeOf(own, vertex);
            positions.insert(positions.end(), place.m_floats, place.m_floats + 3);
        }
    }
}

SceneWorld::Stretch SceneWorld::stretch() const
{
    double sum = 0, most = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        const std::vector<std::int32_t>& springs = m_scene.m_cloths[i].m_rest.m_edgeSprings;
        for (std::size_t k = 0; k < springs.size(); k += 2)
        {
            const btSoftBody& body = *m_cloths[i];
            const btVector3 way = body.m_nodes[springs[k]].m_x - body.m_nodes[springs[k + 1]].m_x;
            const std::vector<float>& rest = m_scene.m_cloths[i].m_rest.m_mesh.m_positions;
            const btVector3 own = placeOf(rest, std::size_t(springs[k])) - placeOf(rest, std::size_t(springs[k + 1]));
            const double stretch = double(way.length() / own.length()) - 1;
            sum += std::abs(stretch);
            most = std::max(most, stretch);
            ++count;
        }
    }
    return {sum / double(std::max<std::size_t>(1, count)), most};
}
}  // namespace drape
