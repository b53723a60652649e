#include "tools/scene_world/scene_world.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>

#include "tools/scene_world/wind.h"

namespace drape
{
namespace
{
constexpr int kNodesPerCluster = 16;  // Bullet's demos have 10 to 30
}  // namespace

std::string nameOf(const ClothScene& scene, const btCollisionObject& body)
{
    const auto nameIn = [&](const auto& parts, const char* kind)
    {
        const std::string& name = parts[std::size_t(body.getUserIndex())].m_name;
        const auto hasName = [&](const auto& part) { return part.m_name == name; };
        std::string text = kind;
        if (!name.empty()) text += " \"" + name + '"';
        if (std::count_if(parts.begin(), parts.end(), hasName) > 1 || name.empty())
            text += ' ' + std::to_string(body.getUserIndex());
        return text;
    };
    return btSoftBody::upcast(&body) ? nameIn(scene.m_cloths, "cloth") : nameIn(scene.m_obstacles, "obstacle");
}

SceneWorld::SceneWorld(const ClothScene& scene, std::unique_ptr<btCollisionConfiguration> configuration,
                       std::unique_ptr<btSoftBodySolver> solver)
    : m_scene(scene),
      m_configuration(std::move(configuration)),
      m_solver(std::move(solver)),
      m_dispatcher(m_configuration.get()),
      m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, m_configuration.get(), m_solver.get())
{
    const btVector3 gravity = vectorOf(scene.m_gravity);
    m_world.setGravity(gravity);
    m_world.getWorldInfo().m_gravity = gravity;
    btGImpactCollisionAlgorithm::registerAlgorithm(&m_dispatcher);
    for (const SceneObstacle& obstacle : scene.m_obstacles)
        addObstacle(obstacle);
}

SceneWorld::SceneWorld(const ClothScene& scene, Plugin& plugin)
    : SceneWorld(scene, std::make_unique<CollisionConfiguration>(plugin), std::make_unique<TimedSolver>(plugin))
{
    m_timedSolver = static_cast<TimedSolver*>(m_solver.get());
    for (const SceneCloth& cloth : scene.m_cloths)
    {
        const btSoftBody& body = addCloth(cloth);
        if (cloth.m_selfCollides) plugin.setSelfCollision(body, true, scene.m_selfThickness);
    }
}

SceneWorld::SceneWorld(const ClothScene& scene, BulletCollision collision)
    : SceneWorld(scene, std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>(),
                 std::make_unique<btDefaultSoftBodySolver>())
{
    using Flags = btSoftBody::fCollision;
    for (const SceneCloth& cloth : scene.m_cloths)
    {
        btSoftBody& body = addCloth(cloth);
        if (!cloth.m_selfCollides) continue;
        body.setSelfCollision(true);
        if (collision == BulletCollision::NodesAndFaces) body.m_cfg.collisions |= Flags::VF_SS;
        if (collision != BulletCollision::Clusters) continue;
        // Not CL_SELF: SVSmask of Bullet 3.24 contains it, and clusters of a body that has it meet nobody.
        body.m_cfg.collisions |= Flags::CL_SS;
        body.generateClusters(std::max(2, body.m_nodes.size() / kNodesPerCluster));
    }
}

SceneWorld::~SceneWorld()
{
    for (const std::unique_ptr<btSoftBody>& cloth : m_cloths)
        m_world.removeSoftBody(cloth.get());
    for (const ObstacleBody& obstacle : m_obstacles)
        m_world.removeRigidBody(obstacle.m_body.get());
}

btSoftBody& SceneWorld::addCloth(const SceneCloth& cloth)
{
    m_cloths.push_back(makeClothBody(m_world.getWorldInfo(), m_scene, cloth));
    btSoftBody& body = *m_cloths.back();
    body.setUserIndex(int(m_cloths.size()) - 1);
    for (const SceneAnchors& anchors : cloth.m_anchors)
        for (const int node : anchors.m_nodes)
            body.appendAnchor(node, m_obstacles[anchors.m_obstacle].m_body.get(), !anchors.m_collides,
                              btScalar(anchors.m_influence));
    m_world.addSoftBody(&body);
    return body;
}

void SceneWorld::addObstacle(const SceneObstacle& obstacle)
{
    m_obstacles.push_back(makeObstacleBody(m_scene, obstacle));
    m_obstacles.back().m_body->setUserIndex(int(m_obstacles.size()) - 1);
    m_world.addRigidBody(m_obstacles.back().m_body.get());
}

void SceneWorld::moveTo(double time)
{
    for (std::size_t i = 0; i < m_obstacles.size(); ++i)
        if (m_scene.m_obstacles[i].m_moves && !(m_scene.m_obstacles[i].m_mass > 0))
            m_obstacles[i].m_body->setWorldTransform(poseOf(m_scene.m_obstacles[i], time));
    for (std::size_t i = 0; i < m_cloths.size() && !m_isReleased; ++i)
    {
        const SceneCloth& cloth = m_scene.m_cloths[i];
        for (const ScenePins& pins : cloth.m_pins)
            for (const int node : pins.m_nodes)
            {
                const float* const start = cloth.m_positions.data() + 3 * node;
                m_cloths[i]->m_nodes[node].m_x = vectorOf(pins.at({start[0], start[1], start[2]}, time));
            }
    }
}

double SceneWorld::step(double dt)
{
    m_time += dt;
    moveTo(m_time);
    for (const std::unique_ptr<btSoftBody>& cloth : m_cloths)
        if (m_scene.m_wind && cloth->isActive()) addWind(*cloth, *m_scene.m_wind, dt);
    const auto start = std::chrono::steady_clock::now();
    m_world.stepSimulation(btScalar(dt), 1, btScalar(dt));
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void SceneWorld::release()
{
    m_isReleased = true;
    for (std::size_t i = 0; i < m_cloths.size(); ++i)
    {
        const SceneCloth& cloth = m_scene.m_cloths[i];
        for (const ScenePins& pins : cloth.m_pins)
            for (const int node : pins.m_nodes)
                m_cloths[i]->setMass(node, btScalar(cloth.massOf(std::size_t(node))));
        updateButLengths(*m_cloths[i]);
    }
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

std::vector<std::int32_t> SceneWorld::lines() const
{
    std::vector<std::int32_t> all;
    std::int32_t first = 0;
    for (const SceneCloth& cloth : m_scene.m_cloths)
    {
        for (const std::int32_t node : cloth.lines())
            all.push_back(first + node);
        first += std::int32_t(cloth.nodeCount());
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
