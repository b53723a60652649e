#include "tests/worlds/world.h"

#include <cstring>
#include <stdexcept>

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>

namespace drape::test
{
namespace
{
constexpr double kGravity = -9.81;  // m/s²
constexpr int kMostUnevenSubsteps = 20;

Settings settingsFor(WorldBackend backend)
{
    Settings settings;
    settings.m_backend = backend == WorldBackend::OpenCl ? Backend::OpenCl : Backend::Host;
    settings.m_solver = backend == WorldBackend::Substeps ? Solver::Drape : Solver::Bullet;
    settings.m_log = nullptr;
    settings.m_threads = 1;  // worlds run side by side; the number of threads changes no bit
    return settings;
}

void addGridCell(btSoftBody& body, int a, int b, int c, int d, bool falling)
{
    // a b is the near row, c d the far one.
    if (falling)
    {
        body.appendFace(a, c, b);
        body.appendFace(b, c, d);
        body.appendLink(b, c);
    }
    else
    {
        body.appendFace(a, c, d);
        body.appendFace(a, d, b);
        body.appendLink(a, d);
    }
}

void connectGrid(btSoftBody& body, int nodesX, int nodesZ)
{
    for (int j = 0; j < nodesZ; ++j)
        for (int i = 0; i < nodesX; ++i)
        {
            const int a = j * nodesX + i;
            const bool right = i + 1 < nodesX, far = j + 1 < nodesZ;
            if (right) body.appendLink(a, a + 1);
            if (far) body.appendLink(a, a + nodesX);
            if (right && far) addGridCell(body, a, a + 1, a + nodesX, a + nodesX + 1, ((i + j) & 1) != 0);
        }
}
}  // namespace

btTransform compoundPose(int level)
{
    return btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(.3 * level)), btVector3(btScalar(.05 * level), 0, 0));
}

btTransform shifted(double x, double y, double z)
{
    return btTransform(btQuaternion::getIdentity(), btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

btTransform turned(const btVector3& axis, double angle, double x, double y, double z)
{
    return btTransform(btQuaternion(axis.normalized(), btScalar(angle)),
                       btVector3(btScalar(x), btScalar(y), btScalar(z)));
}

btCollisionShape& WorldObstacle::shape()
{
    if (m_scaledShape) return *m_scaledShape;
    return *m_meshShape;
}

btVector3 WorldObstacle::scaling() const
{
    return m_scaledShape ? m_scaledShape->getLocalScaling() : btVector3(1, 1, 1);
}

World::World(WorldBackend backend)
{
    if (backend == WorldBackend::Stock)
        m_configuration = std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>();
    else
    {
        m_plugin = std::make_unique<Plugin>(settingsFor(backend));
        if (!m_plugin->ready()) throw std::runtime_error("Drape cannot start: " + m_plugin->error());
        m_configuration = std::make_unique<CollisionConfiguration>(*m_plugin);
        m_solver = std::make_unique<SoftBodySolver>(*m_plugin);
    }
    m_dispatcher = std::make_unique<btCollisionDispatcher>(m_configuration.get());
    m_world = std::make_unique<btSoftRigidDynamicsWorld>(m_dispatcher.get(), &m_broadphase, &m_rigidSolver,
                                                         m_configuration.get(), m_solver.get());
    m_world->setGravity(btVector3(0, btScalar(kGravity), 0));
    m_world->getWorldInfo().m_gravity = m_world->getGravity();
    m_world->setInternalTickCallback(beforeBulletStep, this, true);
}

World::~World()
{
    for (const auto& cloth : m_cloths)
        m_world->removeSoftBody(cloth->m_body.get());
    for (const auto& obstacle : m_obstacles)
        m_world->removeCollisionObject(obstacle->m_object.get());
    for (const auto& body : m_bodies)
        m_world->removeRigidBody(body.get());
    m_cloths.clear();
    m_world.reset();
}

void World::makeShape(WorldObstacle& obstacle, const ObstacleSpec& spec)
{
    TriangleMesh& mesh = obstacle.m_mesh;
    obstacle.m_arrays =
        std::make_unique<btTriangleIndexVertexArray>(static_cast<int>(mesh.triangleCount()), mesh.m_triangles.data(),
                                                     12, static_cast<int>(mesh.vertexCount()), nullptr, 12);
    btIndexedMesh& part = obstacle.m_arrays->getIndexedMeshArray()[0];
    part.m_vertexType = PHY_FLOAT;  // also where btScalar is double
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(mesh.m_positions.data());
    obstacle.m_meshShape = std::make_unique<btBvhTriangleMeshShape>(obstacle.m_arrays.get(), true);
    obstacle.m_meshShape->setMargin(btScalar(m_obstacleMargin));
    if (!spec.m_scaling) return;
    obstacle.m_scaledShape =
        std::make_unique<btScaledBvhTriangleMeshShape>(obstacle.m_meshShape.get(), *spec.m_scaling);
    obstacle.m_scaledShape->setMargin(btScalar(m_obstacleMargin));
}

btCollisionShape* World::wrapInCompounds(WorldObstacle& obstacle, int depth)
{
    btCollisionShape* shape = &obstacle.shape();
    for (int level = 0; level < depth; ++level)
    {
        const btTransform pose = level == 0 ? btTransform::getIdentity() : compoundPose(level);
        obstacle.m_inObject = level == 0 ? pose : pose * obstacle.m_inObject;
        obstacle.m_compounds.push_back(std::make_unique<btCompoundShape>());
        obstacle.m_compounds.back()->addChildShape(pose, shape);
        shape = obstacle.m_compounds.back().get();
    }
    return shape;
}

WorldObstacle& World::addObstacle(const TriangleMesh& mesh, const ObstacleSpec& spec)
{
    auto obstacle = std::make_unique<WorldObstacle>();
    obstacle->m_mesh = mesh;
    makeShape(*obstacle, spec);
    btCollisionShape* shape = wrapInCompounds(*obstacle, spec.m_compoundDepth);
    if (spec.m_kinematic)
    {
        btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape);
        info.m_startWorldTransform = spec.m_pose;
        auto body = std::make_unique<btRigidBody>(info);
        body->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
        body->setActivationState(DISABLE_DEACTIVATION);
        body->setFriction(btScalar(spec.m_friction));
        m_world->addRigidBody(body.get());
        obstacle->m_object = std::move(body);
    }
    else
    {
        auto object = std::make_unique<btCollisionObject>();
        object->setCollisionShape(shape);
        object->setWorldTransform(spec.m_pose);
        object->setFriction(btScalar(spec.m_friction));
        m_world->addCollisionObject(object.get(), btBroadphaseProxy::StaticFilter,
                                    btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
        obstacle->m_object = std::move(object);
    }
    m_obstacles.push_back(std::move(obstacle));
    return *m_obstacles.back();
}

WorldObstacle& World::addLoad(const TriangleMesh& mesh, const LoadSpec& spec)
{
    auto obstacle = std::make_unique<WorldObstacle>();
    obstacle->m_mesh = mesh;
    makeShape(*obstacle, {});
    btVector3 low, high, inertia;
    obstacle->shape().getAabb(btTransform::getIdentity(), low, high);
    const btScalar margin = btScalar(m_obstacleMargin);
    const btVector3 half = (high - low) / 2 - btVector3(margin, margin, margin);
    obstacle->m_box = std::make_unique<btBoxShape>(half);
    obstacle->m_box->calculateLocalInertia(btScalar(spec.m_mass), inertia);
    if (!spec.m_isBox) obstacle->m_box.reset();
    btCollisionShape* const shape =
        spec.m_isBox ? static_cast<btCollisionShape*>(obstacle->m_box.get()) : &obstacle->shape();
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(spec.m_mass), nullptr, shape, inertia);
    info.m_startWorldTransform = spec.m_pose;
    auto body = std::make_unique<btRigidBody>(info);
    body->setLinearVelocity(spec.m_velocity);
    body->setAngularVelocity(spec.m_spin);
    body->setFriction(btScalar(spec.m_friction));
    m_world->addRigidBody(body.get());
    obstacle->m_object = std::move(body);
    m_obstacles.push_back(std::move(obstacle));
    return *m_obstacles.back();
}

WorldCloth& World::addGrid(const GridSpec& spec)
{
    std::vector<btVector3> places;
    for (int j = 0; j < spec.m_nodesZ; ++j)
        for (int i = 0; i < spec.m_nodesX; ++i)
            places.push_back(spec.m_pose *
                             btVector3(btScalar(spec.m_sizeX * (static_cast<double>(i) / (spec.m_nodesX - 1) - .5)), 0,
                                       btScalar(spec.m_sizeZ * (static_cast<double>(j) / (spec.m_nodesZ - 1) - .5))));
    const std::vector<btScalar> masses(places.size(), btScalar(1. / static_cast<double>(places.size())));
    auto body = std::make_unique<btSoftBody>(&m_world->getWorldInfo(), static_cast<int>(places.size()), places.data(),
                                             masses.data());
    body->m_materials[0]->m_kLST = 1;
    connectGrid(*body, spec.m_nodesX, spec.m_nodesZ);
    if (spec.m_bending) body->generateBendingConstraints(2);
    body->getCollisionShape()->setMargin(btScalar(m_clothMargin));
    body->m_cfg.piterations = 4;
    body->m_cfg.kDF = btScalar(.4);
    body->m_cfg.kDP = btScalar(.005);
    return addCloth(std::move(body));
}

WorldCloth& World::addCloth(std::unique_ptr<btSoftBody> body)
{
    m_cloths.push_back(std::make_unique<WorldCloth>());
    m_cloths.back()->m_body = std::move(body);
    return *m_cloths.back();
}

void World::addBody(std::unique_ptr<btRigidBody> body, std::unique_ptr<btCollisionShape> shape)
{
    m_world->addRigidBody(body.get());
    m_bodies.push_back(std::move(body));
    m_shapes.push_back(std::move(shape));
}

void World::start()
{
    for (const auto& cloth : m_cloths)
    {
        m_world->addSoftBody(cloth->m_body.get());
        cloth->m_body->setActivationState(DISABLE_DEACTIVATION);
    }
}

double World::nextDuration()
{
    if (m_stepping == Stepping::UnevenTime) return m_timeRandom.within(.002, .05);
    if (m_stepping == Stepping::UnevenSteps) return m_timeRandom.logWithin(1e-4, .1);
    return m_dt;
}

// The statistics are those of the step before, which belongs to the same call unless this is the first one of it.
void World::beforeBulletStep(btDynamicsWorld* world, btScalar)
{
    World& self = *static_cast<World*>(world->getWorldUserInfo());
    if (self.m_bulletSteps > 0 && self.m_plugin) self.m_status |= self.m_plugin->statistics().m_status;
    if (self.m_bulletSteps > 0 && self.m_betweenSteps) self.m_betweenSteps();
    ++self.m_bulletSteps;
}

int World::stepBullet(double duration)
{
    switch (m_stepping)
    {
        case Stepping::OneStep:
            return m_world->stepSimulation(btScalar(duration), 1, btScalar(duration));
        case Stepping::FixedSteps:
            return m_world->stepSimulation(btScalar(duration), m_mostSubsteps, btScalar(m_fixedDt));
        case Stepping::UnevenTime:
            return m_world->stepSimulation(btScalar(duration), kMostUnevenSubsteps, btScalar(m_fixedDt));
        case Stepping::UnevenSteps:
            break;
    }
    m_world->stepSimulation(btScalar(duration), 0);
    return 1;
}

int World::step()
{
    const double duration = nextDuration();
    m_time += duration;
    for (const auto& obstacle : m_obstacles)
    {
        if (obstacle->m_beforeStep) obstacle->m_beforeStep(m_time);
        if (obstacle->m_motion) obstacle->m_object->setWorldTransform(obstacle->m_motion(m_time));
    }
    for (const auto& cloth : m_cloths)
        if (cloth->m_drive) cloth->m_drive(m_time, *cloth->m_body);
    m_status = 0;
    m_bulletSteps = 0;
    const int steps = stepBullet(duration);
    if (m_bulletSteps > 0 && m_plugin) m_status |= m_plugin->statistics().m_status;
    return steps;
}

std::uint64_t World::hash(std::uint64_t hash) const
{
    for (const auto& cloth : m_cloths)
        for (int i = 0; i < cloth->m_body->m_nodes.size(); ++i)
            for (int axis = 0; axis < 3; ++axis)
            {
                const float value = static_cast<float>(cloth->m_body->m_nodes[i].m_x[axis]);
                std::uint32_t bits;
                std::memcpy(&bits, &value, sizeof bits);
                hash = (hash ^ bits) * 0x100000001b3ull;
            }
    return hash;
}
}  // namespace drape::test
